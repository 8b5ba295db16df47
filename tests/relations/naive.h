/* naive.h - a naive reference simulator of spheres and planes, written from docs/theory.md alone.

   Relations between two runs of dem.h cannot show an error that both have. A scene that runs here and in dem.h does:
   the two agree to rounding. naive.c was written from docs/theory.md and the public comments of dem.h, without its
   source. Every step tests every pair. All quantities are in SI units. */
#ifndef NAIVE_H
#define NAIVE_H

enum { NAIVE_BODIES = 64, NAIVE_PLANES = 8, NAIVE_MATERIALS = 8 };      /* largest numbers */
enum { NAIVE_HERTZ, NAIVE_LINEAR, NAIVE_HYSTERETIC };                   /* normal laws */
enum { NAIVE_ALLOWED, NAIVE_CLIPPED, NAIVE_COMPENSATED };               /* may the dashpot attract? */
enum { NAIVE_SMOOTH, NAIVE_SPRING, NAIVE_MINDLIN, NAIVE_RESCALED };     /* friction: none; [CS79]; [DIR05]; [THO13] */
enum { NAIVE_PARALLEL, NAIVE_SLIDER_SPRING, NAIVE_REMAINDER };          /* what the spring gives up in a slide */
enum { NAIVE_REPULSIVE, NAIVE_ELASTIC, NAIVE_MAGNITUDE };               /* the load of Coulomb's limit */
enum { NAIVE_FREE, NAIVE_CONSTANT, NAIVE_EPSD };                        /* rolling: none; [ZHO99]; [AI11] */

typedef struct naive_vec { double x, y, z; } naive_vec;
typedef struct naive_laws {
    int normal, tension, tangent, slider, load, rolling;
    double impact_speed;               /* m/s, for a stiffness derived from Young's modulus; 0: 1 m/s */
    naive_vec gravity;                 /* m/s2 */
    double dt;                         /* s */
    double period[3];                  /* m, along x, y and z; 0: open */
} naive_laws;
typedef struct naive_material {
    double density, young, poisson;    /* kg/m3, Pa */
    double restitution, friction, friction_static, rolling_friction;   /* static 0: equal to friction */
    double stiffness, ratio;           /* N/m, kn of the linear and hysteretic law; kt/kn; 0: derived */
    double adhesion;                   /* N/m, kad of the hysteretic law */
} naive_material;
typedef struct naive_pair {            /* of two materials; mixed from them unless naive_pair_set is called */
    double restitution, friction, friction_static, rolling_friction;
    double stiffness, ratio, adhesion; /* stiffness 0: from E* and the impact speed */
    double normal_damping;             /* N s/m; 0: from the restitution (linear) or none (hysteretic) */
    double tangent_damping;            /* factor on ct */
} naive_pair;
typedef struct naive_state { naive_vec x, v, spin, force, torque; double mass; } naive_state;   /* without gravity */
/* Since the start: contacts that began, and steps of contacts: those that slid, stuck, attracted, had the largest
   moment of rolling resistance, touched across a periodic face, or touched a plane. */
typedef struct naive_count { long began, slid, stuck, attracted, rolled, across, walls; } naive_count;
typedef struct naive naive;

naive *naive_create(const naive_laws *laws);                            /* null: no memory */
int naive_material_add(naive *n, const naive_material *material);       /* these return an index from 0, */
int naive_sphere_add(naive *n, int material, double radius, naive_vec x, naive_vec v, naive_vec spin, int fixed);
int naive_plane_add(naive *n, int material, naive_vec point, naive_vec normal);      /* -1: no room */
naive_pair naive_pair_get(const naive *n, int a, int b);
void naive_pair_set(naive *n, int a, int b, naive_pair pair);           /* in both orders */
void naive_step(naive *n, int steps);
naive_state naive_get(const naive *n, int body);
naive_count naive_counts(const naive *n);
void naive_free(naive *n);
#endif
