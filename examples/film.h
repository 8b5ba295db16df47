/* film.h - a film of a study's run: replay.html in the folder of its results. MIT licence. Include it after dem.h and
   study.h.

       film f = film_open(world, frames, seconds, "A tumbling mill");  // 0 frames: no film, and nothing below does anything
       while (...) {
           ...                                                         // a bit of the run
           if (film_due(&f)) {
               film_value(&f, "torque (N m)", torque);
               film_frame(&f);
           }
       }
       film_close(&f);                                                 // says which file to open */
#ifndef FILM_H
#define FILM_H

typedef struct film {
    dem_world *world;
    dem_replay *replay;          /* null: none, or it went wrong, which has been said */
    double start, interval;      /* s */
    int taken;
} film;

STUDY_FN void film_fail(film *f) {
    study_fail("%s", dem_world_error_get(f->world));
    if (f->replay) dem_replay_close(f->replay);
    f->replay = 0;
}
/* Grains may be coloured by `number`, too, which number_fn answers (null: none). */
STUDY_FN film film_open_by(dem_world *world, int frames, double seconds, const char *title, const char *number,
                           double (*number_fn)(const dem_world *world, dem_body body, void *user)) {
    dem_replay_desc desc = DEM_REPLAY_DESC;
    film f;
    memset(&f, 0, sizeof f);
    if (study.quiet || frames < 1) return f;
    f.world = world;
    f.start = dem_world_time_get(world);
    f.interval = seconds/frames;
    desc.title = title;
    desc.number = number;
    desc.number_fn = number_fn;
    f.replay = dem_replay_open(world, study_path("replay.html"), &desc);
    if (!f.replay) film_fail(&f);
    return f;
}
STUDY_FN film film_open(dem_world *world, int frames, double seconds, const char *title) {
    return film_open_by(world, frames, seconds, title, 0, 0);
}
STUDY_FN int film_due(const film *f) {
    return f->replay && dem_world_time_get(f->world) >= f->start + (f->taken - 1e-6)*f->interval;
}
STUDY_FN void film_value(film *f, const char *name, double value) {
    if (f->replay && dem_replay_value_set(f->replay, name, value) != DEM_OK) film_fail(f);
}
STUDY_FN void film_frame(film *f) {
    if (f->replay && dem_replay_frame_write(f->replay) != DEM_OK) film_fail(f);
    f->taken++;
}
STUDY_FN void film_close(film *f) {
    dem_replay *replay = f->replay;
    if (!replay) return;
    f->replay = 0;
    if (dem_replay_close(replay) != DEM_OK) { film_fail(f); return; }
    study.files++;
    study_film();                               /* the one before; this one at the end of the study */
    snprintf(study.film, sizeof study.film, "%s", study_path("replay.html"));
}
#endif
