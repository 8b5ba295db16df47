/* 03_incline.c - lesson 3: a ball on an inclined plane. You learn: friction is a limit; rolling and sliding.

   Question:  A steel ball with mu = 0.2 lies on a plane that becomes steeper. A block would slide above atan(mu) =
              11.3 degrees. Above which angle does the ball slide? Does it stop rolling then? Guess, then run.
   Theory:    A solid ball rolls without sliding while tan(angle) <= 7/2 mu. Its acceleration is then
                  a = 5/7 g sin(angle).
              On a steeper plane the contact slides, and friction continues to accelerate the rotation:
                  a = g (sin(angle) - mu cos(angle)),   R dw/dt = 5/2 mu g cos(angle)   (w: angular velocity)
   Build:     cc -O2 03_incline.c ../dem.c -lm
   Run:       03_incline or, with a replay at 40 degrees, 03_incline --replay: the curves of v and R w separate
   Output:    both accelerations at 10 to 50 degrees (within 0.2 %). The ball slides above 34.99 degrees
   Exercises: check an answer with 03_incline --check N VALUE
   1  Above which angle, in degrees, does a ball with mu = 0.1 slide?
   2  Above which angle does a cylinder with mu = 0.2 slide? (With desc.planar = 1 the ball is a disc. About which
      axis can it roll then?) */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "03_incline", answer);
    const double g = 9.81, mu = 0.2, radius = 0.01, pi = 3.14159265358979324;   /* m/s2, -, m */
    for (int angle = 10; angle <= 50; angle += 10) {
        /* gravity is tilted instead of the plane: the same physics in simpler coordinates */
        double s = sin(angle*pi/180), c = cos(angle*pi/180);
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.gravity = dem_vec3_make(g*s, 0, -g*c);                 /* m/s2 */
        desc.orientations = 1;                                      /* so that the replay shows the rotation */
        dem_world *world = dem_world_create(&desc);

        dem_material_desc steel_desc = DEM_MATERIAL_DESC;
        steel_desc.density = 7800;                                  /* kg/m3 */
        steel_desc.young = 1e9;                                     /* Pa, softened */
        steel_desc.poisson = 0.3;
        steel_desc.restitution = 0.3;
        steel_desc.friction = mu;
        dem_material steel = dem_material_add(world, &steel_desc);
        dem_wall_plane_add(world, steel, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        dem_body ball = dem_sphere_add(world, steel, radius, dem_vec3_make(0, 0, radius));
        dem_world_check_print(world, stdout);

        /* the ball settles for 0.1 s; then 0.5 s are measured */
        dem_replay_desc replay_desc = DEM_REPLAY_DESC;
        replay_desc.interval = 0.01;                                /* s */
        dem_replay *replay = record && angle == 40 ? dem_replay_open(world, "03_incline.html", &replay_desc) : 0;
        dem_body_state from, to;
        dem_body_get(world, ball, &from);
        double start = 0;
        for (int i = 0; i < 60; i++) {
            if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
            dem_body_get(world, ball, &to);
            dem_replay_value_set(replay, "speed (m/s)", to.velocity.x);
            dem_replay_value_set(replay, "R w (m/s)", radius*to.spin.y);
            if (i == 9) { from = to; start = dem_world_time_get(world); }
        }
        double time = dem_world_time_get(world) - start;
        int rolls = s/c <= 3.5*mu;
        char name[64];
        snprintf(name, sizeof name, "%d degrees, %s: a [m/s2]", angle, rolls ? "rolls" : "slides");
        lesson_row(name, (to.velocity.x - from.velocity.x)/time, 0, rolls ? 5*g*s/7 : g*(s - mu*c), 0.2);
        lesson_row("                    R dw/dt [m/s2]", radius*(to.spin.y - from.spin.y)/time, 0,
                   rolls ? 5*g*s/7 : 2.5*mu*g*c, 0.2);
        dem_replay_close(replay);
        dem_world_destroy(world);
    }
    return lesson_end();
}

/* Marking. Stop here if you want to find the answers yourself. A body with the moment of inertia
   k m R^2 slides above tan(angle) = mu (1 + 1/k), where friction cannot accelerate its rotation fast enough. */
static double answer(int exercise) {
    const double k = exercise == 1 ? 0.4 : 0.5, mu = exercise == 1 ? 0.1 : 0.2;
    return atan(mu*(1 + 1/k))*180/3.14159265358979324;
}
