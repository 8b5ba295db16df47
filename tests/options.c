/* The rows of the descs of dem.h, as a table for tests/options.awk, which makes docs/options.md of it: make options.
   Columns, separated by tabs: desc, field, unit, range, the range without its upper limit, values of an enum, 1 if the
   value must be set, 1 if the field is part of the scene that a checkpoint is compared with. */
#define DEM_IMPLEMENTATION
#include "../dem.h"

/* of the wall's rows these belong to a desc: the names that begin with `prefix` */
typedef struct option_table { const char *desc, *prefix; const demi_field_row *rows; } option_table;
static const option_table tables[] = {
    {"dem_world_desc", "", demi_world_desc_rows}, {"dem_material_desc", "", demi_material_rows},
    {"dem_pair", "", demi_pair_rows}, {"dem_motion", "motion.", demi_motion_rows}, {"dem_sieve_desc", "sieve.", demi_wall_rows},
    {"dem_joint_desc", "", demi_joint_fields}, {"dem_feed_desc", "", demi_feed_rows}, {"dem_outlet_desc", "", demi_outlet_rows},
    {"dem_cell_desc", "", demi_cell_rows}, {"dem_field_desc", "", demi_field_rows}, {"dem_trials_desc", "", demi_trials_rows}, {"dem_replay_desc", "", demi_replay_rows}};

/* The range of a field, with its upper limit or without. */
static void range_print(const demi_field_row *r, int upper) {
    const double most = demi_row_most(r);
    const int whole = r->type == 'i', limited = upper && most < (whole ? INT_MAX : DBL_MAX);
    if (r->type == 'e' || !(r->how & DEMI_LIMITS)) return;
    if (r->how & DEMI_ANY) {
        if (limited) printf("at most %g in size", most);
    } else if (r->other > 0) printf("0 or %s %s", r->how & DEMI_OVER ? ">" : ">=", strrchr(r[-r->other].name, '.') ?
                                    strrchr(r[-r->other].name, '.') + 1 : r[-r->other].name);
    else if (limited && (whole || !(r->how & (DEMI_OVER | DEMI_UNDER))))
        printf(whole ? "%d to %.10g" : "%d to %g", whole && r->how & DEMI_OVER ? 1 : 0, most);
    else {
        printf(whole && r->how & DEMI_OVER ? ">= 1" : r->how & DEMI_OVER ? "> 0" : ">= 0");
        if (limited) printf(" and %s %g", r->how & DEMI_UNDER ? "<" : "<=", most);
    }
}
/* 1 if checkpoints compare this field of a desc: rows of a scene, of motions those that the rows of walls have. */
static int in_scene(const option_table *t, const demi_field_row *r) {
    char name[64];
    int k;
    snprintf(name, sizeof name, "%s%s", t->prefix, r->name);
    if (t->rows == demi_motion_rows) {
        for (r = demi_wall_rows; r->name; r++) if (!strcmp(r->name, name)) return 1;
        return 0;
    }
    for (k = 0; k < DEMI_PARTS; k++) if (demi_scene_parts[k].rows == t->rows) return !(r->how & DEMI_FREE);
    return 0;
}
int main(void) {
    size_t k;
    for (k = 0; k < sizeof tables/sizeof *tables; k++) {
        const option_table *t = &tables[k];
        const demi_field_row *r;
        for (r = t->rows; r->name; r++) {
            const char *name = r->name;
            if (t->rows == demi_wall_rows && strncmp(name, t->prefix, strlen(t->prefix))) continue;
            if (strchr(name, '.')) name = strchr(name, '.') + 1;
            printf("%s\t%s\t%s\t", t->desc, name, r->unit);
            range_print(r, 1);
            printf("\t");
            range_print(r, 0);
            printf("\t%s\t%d\t%d\n", r->type == 'e' ? r->words : "", r->how & DEMI_OVER && r->other <= 0 && !r->zero, in_scene(t, r));
        }
    }
    return 0;
}
