/* Bonds (examples/laws/bond.h): beams against their closed forms, strengths, energy. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "../../examples/laws/bond.h"

static const double R = 1e-3, E = 1e7, pi = 3.141592653589793;
/* What acts on the last grain of a beam, and on all: N; N s/m. */
typedef struct pull_on { double x, force[3], drag; } pull_on;
static dem_vec3 pulled(dem_vec3 at_, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    const pull_on *p = (const pull_on *)user;
    const double on = (double)at_.x > p->x ? 1 : 0;
    (void)radius; (void)mass; (void)time;
    return at(on*p->force[0] - p->drag*(double)v.x, on*p->force[1] - p->drag*(double)v.y,
              on*p->force[2] - p->drag*(double)v.z);
}
/* s: t_c/20 is 1.43e-6. */
static double step_of(int bonds) { return bonds > 10 ? 1.4e-6 : 1e-6; }
/* A row of 1 + bonds grains along x, the first held. */
static dem_world *beam(bond *cement, pull_on *load, int bonds, int ledger, dem_body *last) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    dem_material stone;
    dem_body_state s;
    dem_body first = {0, 0};
    int i;
    desc.law = bond_law;
    desc.law_user = cement;
    desc.law_memory = 8;
    desc.law_vectors = 2;
    desc.law_who = 1;
    desc.law_range = (dem_real)(0.5*R);
    desc.law_stiffness = (dem_real)(4*E*pi*R*R/(2*R));
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.force = pulled;
    desc.force_user = load;
    desc.ledger = ledger;
    desc.threads = 1;
    desc.dt = (dem_real)step_of(bonds);
    load->x = (2*bonds - 0.5)*R;
    w = dem_world_create(&desc);
    stone = scene_material(w, 1e6, 0.5, 0.3, 0);
    for (i = 0; i <= bonds; i++) {
        *last = dem_sphere_add(w, stone, (dem_real)R, at(2*R*i, 0, 0));
        if (!i) first = *last;
    }
    s = scene_state(w, first);
    s.fixed = 1;
    dem_body_set(w, first, &s);
    CHECK_EQ(dem_bonds_make(w, (dem_real)(0.1*R), bond_make, w), bonds);
    return w;
}
static bond strong(void) {
    bond b = {DEM_R(1e7), DEM_R(2.5), DEM_R(1e-3), DEM_R(1e30), DEM_R(1e30), 0};
    return b;
}
static const double grain_mass = 2500*4/3.0*3.141592653589793*1e-9;
/* I of the bond's section, m4 */
static double section(void) { return pi*R*R*R*R/4; }
/* Angular frequency of the first note of a beam of n bonds, rad/s: of length (n + 1/2) l [Timoshenko]. */
static double note(int bonds) {
    const double l = 2*R, L = (bonds + 0.5)*l;
    return 1.875104068711961*1.875104068711961*sqrt(E*section()/(grain_mass/l))/(L*L);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a bonded beam bends under an end load as Euler's beam of as many joints does") {
        static const int counts[] = {1, 3, 10, 100};
        int k;
        for (k = 0; k < (getenv("TEST_LONG") ? 4 : 3); k++) {
            const int n = counts[k];
            const double l = 2*R, bend = l*l*l/(E*section())*(n*n*(double)n/3 - n/12.0);
            const double shear = n*l*2.5/(E*pi*R*R), force = 0.005*n*l/(bend + shear);
            bond cement = strong();
            pull_on load = {0, {0, 0, force}, 2*grain_mass*note(n)};
            dem_body last;
            dem_world *w = beam(&cement, &load, n, 0, &last);
            CHECK_EQ(scene_step(w, (int)(12/note(n)/step_of(n))), DEM_OK);
            /* at a slope of some 0.0075 its length along x is 3e-5 shorter; what drag has not taken yet */
            CHECK_REL(scene_state(w, last).position.z, force*(bend + shear), 2e-3);
            dem_world_destroy(w);
        }
    }
    TEST("a bonded beam under tension extends by F n l/(E A)") {
        const int n = 5;
        const double l = 2*R, A = pi*R*R, force = 0.01*E*A, slow = 0.5*sqrt(E*A/l/grain_mass)/n;
        bond cement = strong();
        pull_on load = {0, {force, 0, 0}, 2*grain_mass*slow};
        dem_body last;
        dem_world *w = beam(&cement, &load, n, 0, &last);
        CHECK_EQ(scene_step(w, (int)(20/slow/1e-6)), DEM_OK);
        CHECK_REL((double)scene_state(w, last).position.x - 2*R*n, force*n*l/(E*A), 1e-3);
        dem_world_destroy(w);
    }
    TEST("the first frequency of a beam of 10 grains (100 in the long form) is that of length (n + 1/2) l, within 2 "
         "%") {
        int many;
        for (many = 0; many < (getenv("TEST_LONG") ? 2 : 1); many++) {
            const int n = many ? 100 : 10, most = many ? 2 : 9;
            const double omega = note(n);
            bond cement = strong();
            pull_on load = {0, {0, 0, many ? 2e-6 : 2e-4}, 2*grain_mass*note(n)};
            dem_body last;
            dem_world *w = beam(&cement, &load, n, 0, &last);
            double before = 1, begun = -1, ended = 0;
            int i, crossings = 0;
            CHECK_EQ(scene_step(w, (int)(12/omega/step_of(n))), DEM_OK);
            load.force[2] = load.drag = 0;             /* let go */
            for (i = 0; i < 1000000 && crossings < most; i++) {
                double z;
                if (scene_step(w, 5) != DEM_OK) { CHECK(0); break; }
                z = (double)scene_state(w, last).position.z;
                if (before > 0 && !(z > 0)) {
                    if (begun < 0) begun = dem_world_time_get(w);
                    else crossings++;
                    ended = dem_world_time_get(w);
                }
                before = z;
            }
            CHECK_EQ(crossings, most);
            CHECK_REL(2*pi*most/(ended - begun), omega, 0.02);
            if (getenv("TEST_TABLES")) printf("%d grains: %g rad/s, %g\n", n, 2*pi*most/(ended - begun), omega);
            dem_world_destroy(w);
        }
    }
    TEST("a bond breaks at its strength in tension, bending and shear, and not below") {
        /* single: sums of 8e5 small steps */
        static const double part[] = {DEMI_SINGLE ? 0.85 : 0.97, DEMI_SINGLE ? 1.15 : 1.03};
        const double A = pi*R*R, strength = 2e4;
        int how, k;
        for (how = 0; how < 3; how++)
            for (k = 0; k < 2; k++) {
                /* pulled; bent by a load on 4 bonds, whose first has an arm of 3.5 l; sheared */
                const int n = how == 1 ? 4 : 1;
                const double l = 2*R, force = part[k]*strength*(how == 1 ? section()/R/(3.5*l) : A);
                bond cement = strong();
                pull_on load = {0, {0, 0, 0}, 40*grain_mass*note(4)};
                dem_body last;
                dem_world *w;
                double gone;
                int i;
                if (how == 2) cement.shear = (dem_real)strength;
                else cement.tension = (dem_real)strength;
                w = beam(&cement, &load, n, 0, &last);
                for (i = 1; i <= 200; i++) {       /* slowly: nothing overshoots */
                    load.force[how ? 2 : 0] = force*i/200;
                    CHECK_EQ(scene_step(w, how == 1 ? 4000 : 400), DEM_OK);
                }
                load.drag = 0;                     /* what has come loose flies off */
                CHECK_EQ(scene_step(w, 20000), DEM_OK);
                gone = (double)demi_length(demi_sub(scene_state(w, last).position, at(2*R*n, 0, 0)));
                CHECK_EQ(gone > 0.5*R, k == 1);
                dem_world_destroy(w);
            }
    }
    TEST("the energy of a vibrating beam, and of a breaking one, closes in the ledger") {
        int k;
        for (k = 0; k < 2; k++) {
            bond cement = strong();
            pull_on load = {0, {0, 0, 6e-4}, 0};
            dem_body last;
            dem_world *w;
            dem_ledger l;
            cement.beta = DEM_R(0.05);
            if (k) cement.tension = DEM_R(1e4);
            w = beam(&cement, &load, 6, 1, &last);
            CHECK_EQ(scene_step(w, k ? 5000 : 20000), DEM_OK);
            l = dem_ledger_get(w);
            CHECK(l.elastic > 0.01*l.throughput || k);
            CHECK_NEAR(l.residual/l.throughput, 0, DEMI_SINGLE ? 2e-2 : 1e-3);
            if (k) CHECK(l.normal > 0.05*l.throughput);     /* what the bond held */
            dem_world_destroy(w);
        }
    }
    TEST("a bond that breaks under pressure leaves its grains at the overlap that they have, and creates no energy") {
        bond cement = strong();
        pull_on load = {0, {0, 0, 0}, 0};
        dem_body last;
        dem_world *w;
        dem_body_state s;
        dem_ledger l;
        int bonds[2] = {0, 0};
        cement.E = DEM_R(1e5);
        cement.shear = DEM_R(600);
        w = beam(&cement, &load, 1, 1, &last);
        s = scene_state(w, last);
        s.velocity = at(-0.2, 0, 0.2);                         /* presses first; then shear breaks the bond */
        dem_body_set(w, last, &s);
        CHECK_EQ(scene_step(w, 3000), DEM_OK);
        dem_contacts_each(w, bond_count, bonds);
        CHECK(bonds[0] == 0);
        l = dem_ledger_get(w);
        CHECK_NEAR(l.residual/l.throughput, 0, DEMI_SINGLE ? 2e-2 : 2e-3);
        CHECK(l.kinetic + l.rotational <= l.inserted);
        dem_world_destroy(w);
    }
    return test_end();
}
