/* 03_incline.c - lesson 3: a ball on an inclined plane. You learn: friction is a limit; rolling and sliding.

   Build:     cc -O2 -o 03_incline 03_incline.c ../dem.c -lm      (in the folder examples)
   Run:       ./03_incline or, with a replay at 40 degrees, ./03_incline --replay: the curves of the speed v
              and of R w (radius times angular velocity) separate
   Question:  A steel ball with mu = 0.2 lies on a plane that becomes steeper. A block would slide above atan(mu) =
              11.3 degrees. Above which angle does the ball slide? Does it stop rolling then? Guess, then run. */
#include "../dem.h"
#include "lesson.h"

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "03_incline");
    const double g = 9.81, mu = 0.2, radius = 0.01, pi = 3.14159265358979324;   /* m/s2, -, m */
    const int planar = 0;                                           /* 0: a ball; 1: a cylinder */
    const double k = planar ? 1/2.0 : 2/5.0;                        /* moment of inertia over m R^2 */
    /* the normal of the plane: y in a planar world, otherwise z */
    const dem_vec3 origin = dem_vec3_make(0, 0, 0), normal = dem_vec3_make(0, planar, !planar);
    for (int angle = 10; angle <= 50; angle += 10) {
        /* gravity is tilted instead of the plane: the same physics in simpler coordinates */
        double s = sin(angle*pi/180), c = cos(angle*pi/180);
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.planar = planar;
        desc.thickness = planar ? 0.01 : 0;                         /* m, length of the cylinder */
        desc.gravity = dem_vec3_make(g*s, -g*c*normal.y, -g*c*normal.z);    /* m/s2 */
        desc.orientations = 1;                                      /* only so that the replay shows the rotation */
        dem_world *world = dem_world_create(&desc);

        dem_material_desc steel_desc = DEM_MATERIAL_DESC;
        steel_desc.density = 7800;                                  /* kg/m3 */
        steel_desc.young = 1e9;                                     /* Pa, softened */
        steel_desc.poisson = 0.3;
        steel_desc.restitution = 0.3;
        steel_desc.friction = mu;
        dem_material steel = dem_material_add(world, &steel_desc);
        dem_wall_plane_add(world, steel, origin, normal);
        dem_body ball = dem_sphere_add(world, steel, radius, dem_vec3_make(0, radius*normal.y, radius*normal.z));
        dem_world_check_print(world, stdout);

        /* the ball settles for 0.1 s; then 0.5 s are measured */
        dem_replay_desc replay_desc = DEM_REPLAY_DESC;
        replay_desc.interval = 0.01;                                /* s */
        dem_replay *replay = record && angle == 40 ? dem_replay_open(world, "03_incline.html", &replay_desc) : 0;
        dem_body_state state;
        double speed = 0, turning = 0, first_speed = 0, first_turning = 0, start = 0;   /* m/s, turning: R w; s */
        for (int i = 0; i < 60; i++) {
            if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
            dem_body_get(world, ball, &state);
            speed = state.velocity.x;
            turning = radius*(planar ? -state.spin.z : state.spin.y);
            dem_replay_value_set(replay, "speed (m/s)", speed);
            dem_replay_value_set(replay, "R w (m/s)", turning);
            if (i == 9) { first_speed = speed; first_turning = turning; start = dem_world_time_get(world); }
        }
        double time = dem_world_time_get(world) - start;
        int rolls = s/c <= (1 + 1/k)*mu;
        char name[64];
        snprintf(name, sizeof name, "%d degrees, %s: a [m/s2]", angle, rolls ? "rolls" : "slides");
        lesson_row(name, (speed - first_speed)/time, 0, rolls ? g*s/(1 + k) : g*(s - mu*c), 0.2);
        lesson_row("                    R dw/dt [m/s2]", (turning - first_turning)/time, 0,
                   rolls ? g*s/(1 + k) : mu*g*c/k, 0.2);
        dem_replay_close(replay);
        dem_world_destroy(world);
    }
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    Rolling without sliding means a = R dw/dt (w: angular velocity). Friction T brakes the body of inertia
              I = k m R^2 and rotates it: m a = m g sin(angle) - T and I dw/dt = R T. Hence
                  a = g sin(angle)/(1 + k),   T = m g sin(angle) k/(1 + k)
              As T is at most mu m g cos(angle), the body rolls while tan(angle) <= (1 + 1/k) mu. A solid ball has
              k = 2/5: a = 5/7 g sin(angle) while tan(angle) <= 3.5 mu, here up to 34.99 degrees.
              On a steeper plane the contact slides, and friction continues to accelerate the rotation:
                  a = g (sin(angle) - mu cos(angle)),   R dw/dt = mu g cos(angle)/k
   Output:    both accelerations at 10 to 50 degrees (within 0.2 %) */
/* Exercises for ./03_incline --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "Above which angle, in degrees, does a ball with mu = {0.1: 0.05 to 0.3 by 0.01} slide?",
    "Above which angle, in degrees, does a cylinder with mu = {0.2: 0.05 to 0.3 by 0.01} slide? To confirm it, set "
    "`mu` and `planar` at the top of main, `planar` to 1: a planar world contains discs in the x-y plane, which rotate "
    "about z. Which rows are the same for ball and cylinder, and why?"};
/* Marking. Stop here if you want to find the answers yourself.
   Exercise 2: a is the same where both slide, because a does not depend on k while the body slides. All other rows
   depend on k. */
double answer(int exercise, const double *x) {
    const double k = exercise == 1 ? 0.4 : 0.5;
    return atan(x[0]*(1 + 1/k))*180/3.14159265358979324;
}
