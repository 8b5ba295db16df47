/* Programs of public calls, drawn from seeds, played in two worlds: fuzz_api.h says what is demanded. A
   seed that fails is printed with the calls that it takes; `build/test_api WORDS` runs fewer sentences.
   The Makefile makes domains small (DEM_DOMAIN_BODIES), so that few grains make many. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../fuzz_api.h"

enum { GRAINS = FUZZ_GRAINS, SEEDS = 60 };          /* to a sentence: about a second */
static void seeds(int first, int parts) {
    int seed;
    for (seed = first; seed < first + SEEDS; seed++) CHECK_EQ(fuzz_one((uint64_t)seed, parts), 0);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("spheres, walls and motions in any order have the same bits on 1 and 2 threads") {
        seeds(1, GRAINS);
    }
    TEST("a checkpoint after any call gives the same hash, and the same again 20 steps later") {
        seeds(1001, GRAINS | FUZZ_KEPT);
    }
    TEST("ellipsoids and clusters in any order, with checkpoints, have the same bits on 1 and 2 threads") {
        seeds(2001, GRAINS | FUZZ_SHAPES | FUZZ_KEPT);
    }
    TEST("feeds, outlets and fields in any order, with checkpoints, have the same bits on 1 and 2 threads") {
        seeds(3001, GRAINS | FUZZ_FLOW | FUZZ_KEPT);
    }
    TEST("slabs created, stepped and collected between any calls have the same bits on 1 and 2 threads") {
        seeds(4001, GRAINS | FUZZ_SLABS);
    }
    TEST("bad arguments in any order are rejected with an error message and change nothing") {
        seeds(5001, GRAINS | FUZZ_BAD);
    }
    TEST("all kinds of calls in any order have the same bits on 1 and 2 threads") {
        seeds(6001, FUZZ_EVERYTHING);
    }
    return test_end();
}
