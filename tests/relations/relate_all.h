/* relate_all.h - the table of relations. */
#ifndef REL_RELATE_ALL_H
#define REL_RELATE_ALL_H
#include "relate_bits.h"
#include "relate_images.h"
#include "relate_physics.h"
#include "relate_asked.h"

typedef int (*rel_check)(rel_case *c);
typedef struct rel_relation { const char *name, *promise; rel_check check; } rel_relation;
static const rel_relation rel_relations[] = {
    {"threads", "same bits", rel_threads}, {"pieces", "same bits", rel_pieces}, {"restart", "same bits", rel_restart},
    {"restart in a used world", "same bits", rel_restart_used}, 
    {"with a ledger", "same motion, bit by bit", rel_ledger_same},
    {"refused memory", "same bits after the call is repeated", rel_memory_refused},
    {"refused call", "hash and later bits unchanged", rel_refusal},
    {"slabs", "rounding", rel_slabs}, {"search", "rounding", rel_search}, {"skin", "rounding", rel_skin},
    {"rotation by 90 degrees", "rounding", rel_rotated}, {"mirror", "rounding", rel_mirrored},
    {"translation", "rounding", rel_translated}, {"Galilei", "rounding", rel_galilei},
    {"units", "same bits", rel_scaled}, {"order of bodies", "rounding", rel_body_order},
    {"order of walls", "rounding", rel_wall_order}, {"triangles cut", "rounding", rel_cut},
    {"mesh in two walls", "rounding", rel_several}, {"momentum", "rounding", rel_momentum},
    {"counts", "exact", rel_counted}, {"ledger closes", "first order in dt", rel_energy},
    {"angular momentum", "rounding", rel_angular},
    {"energy never grows", "first order in dt", rel_no_gain}, 
    {"halved dt", "half the residual, by the median", rel_halved},
    {"weight on walls", "speeds at rest", rel_weight}, {"rest", "speeds at rest", rel_rest},
    {"strength 0", "same motion, bit by bit", rel_strength_zero}, {"belt or moving wall", "rounding", rel_belt_or_wall},
    REL_SERVICE_RELATIONS,
    {"joints hold", "third order in the first step; no force if fixed", rel_joints},
    {"samples", "one for each interval", rel_samples}, {"outlet", "exact", rel_left},
    {"slabs made of a world", "same hash and later bits", rel_slabs_beside}, {"whole periods", "rounding", rel_periods},
    {"changes in functions", "rounding", rel_meddling}, {"motion not begun", "rounding", rel_not_begun}
};
enum { REL_RELATIONS = (int)(sizeof rel_relations/sizeof *rel_relations) };
/* The rows that program.h writes in a way of their own. */
enum { REL_IS_THREADS, REL_IS_PIECES, REL_IS_RESTART, REL_IS_USED, REL_IS_LEDGER, REL_IS_MEMORY, REL_IS_REFUSED,
       REL_IS_SLABS,
       REL_IS_UNITS = 14, REL_IS_MOMENTUM = 19, REL_IS_COUNTS, REL_IS_CLOSED,
       REL_IS_READERS = 29, REL_IS_RUN, REL_IS_WALL_FILES, REL_IS_GRAIN_FILES };
/* Checks one relation. Its random choices follow from the seed of the scene, whichever were checked before. */
static int rel_judge(rel_case *c, int relation) {
    if (c->s != c->given) {                    /* the relation before had a copy */
        rel_close_case(c);
        rel_open_case(c, c->given);
    }
    c->rng.s = c->s->seed ^ 0x5bd1e995u;
    *c->why = 0;
    c->image = 0;
    memset(&c->how, 0, sizeof c->how);
    c->map = rel_same;
    c->other_ran = c->ran;
    c->repeated = c->reversed = c->bad = 0;
    c->allowed[0] = c->allowed[1] = c->excess = 0;
    {
        const int result = rel_relations[relation].check(c);
        return result == REL_BROKEN && rel_known_break(c, rel_relations[relation].name) ? REL_KNOWN : result;
    }
}

#endif
