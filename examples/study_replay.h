/* study_replay.h - writes a replay of a study's run, replay.html in the folder of its results. MIT licence. Include it
   after dem.h and study.h.

       study_replay r = study_replay_open(world, frames, seconds, "A tumbling mill");
       while (...) {
           ...                                             // a part of the run
           if (study_replay_due(&r)) {
               study_replay_value(&r, "torque (N m)", torque);
               study_replay_frame(&r);
           }
       }
       study_replay_close(&r);                             // prints which file to open

   With 0 frames there is no replay, and the other functions do nothing. */
#ifndef STUDY_REPLAY_H
#define STUDY_REPLAY_H

typedef struct study_replay {
    dem_world *world;
    dem_replay *replay;          /* null: no replay, or a failure that has been reported */
    double start, interval;      /* s */
    int taken;
} study_replay;

STUDY_FN void study_replay_fail(study_replay *r) {
    study_fail("%s", dem_world_error_get(r->world));
    if (r->replay) dem_replay_close(r->replay);
    r->replay = 0;
}
/* The viewer can colour grains by `number`, which number_fn returns (null: none). */
STUDY_FN study_replay study_replay_open_by(dem_world *world, int frames, double seconds, const char *title,
                                           const char *number, double (*number_fn)(const dem_world *world,
                                                                                   dem_body body, void *user)) {
    dem_replay_desc desc = DEM_REPLAY_DESC;
    study_replay r;
    memset(&r, 0, sizeof r);
    if (study.quiet || frames < 1) return r;
    r.world = world;
    r.start = dem_world_time_get(world);
    r.interval = seconds/frames;
    desc.title = title;
    desc.number = number;
    desc.number_fn = number_fn;
    r.replay = dem_replay_open(world, study_path("replay.html"), &desc);
    if (!r.replay) study_replay_fail(&r);
    return r;
}
STUDY_FN study_replay study_replay_open(dem_world *world, int frames, double seconds, const char *title) {
    return study_replay_open_by(world, frames, seconds, title, 0, 0);
}
STUDY_FN int study_replay_due(const study_replay *r) {
    return r->replay && dem_world_time_get(r->world) >= r->start + (r->taken - 1e-6)*r->interval;
}
STUDY_FN void study_replay_value(study_replay *r, const char *name, double value) {
    if (r->replay && dem_replay_value_set(r->replay, name, value) != DEM_OK) study_replay_fail(r);
}
STUDY_FN void study_replay_frame(study_replay *r) {
    if (r->replay && dem_replay_frame_write(r->replay) != DEM_OK) study_replay_fail(r);
    r->taken++;
}
STUDY_FN void study_replay_close(study_replay *r) {
    dem_replay *replay = r->replay;
    if (!replay) return;
    r->replay = 0;
    if (dem_replay_close(replay) != DEM_OK) { study_replay_fail(r); return; }
    study.files++;
    study_replay_print();                       /* the previous one; study_end prints this one */
    snprintf(study.replay, sizeof study.replay, "%s", study_path("replay.html"));
}
#endif
