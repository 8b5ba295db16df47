#include "print.h"
#include "relate.h"
int main(int n, char **v) {
    static rel_scene s; static rel_case c;
    uint64_t seed = strtoull(v[1], 0, 10), last = n > 2 ? strtoull(v[2], 0, 10) : seed;
    int only = n > 3 ? atoi(v[3]) : -1, count[REL_RELATIONS][3] = {{0}}, i, k, refused = 0, still = 0;
    for (; seed <= last; seed++) {
        if (!rel_draw_scene(&s, seed)) continue;
        if (!rel_open_case(&c, &s)) { refused++; rel_close_case(&c); continue; }
        if (!c.ran) { if (only == -2) printf("seed %llu fails: %s\n", (unsigned long long)seed, c.base.message); rel_close_case(&c); refused++; continue; }
        if (!(c.base.contacts + c.base.wall_contacts)) { still++; rel_close_case(&c); continue; }
        for (i = 0; i < REL_RELATIONS; i++) if (only < 0 || only == i) {
            const int result = rel_relations[i].check(&c);
            count[i][result]++;
            if (result == REL_BROKEN) {
                printf("seed %llu %s: %s  [", (unsigned long long)seed, rel_relations[i].name, c.why);
                for (k = 0; k < REL_ROWS; k++) if (s.has[k]) printf(" %s,", rel_features[k].name);
                printf("]\n"); fflush(stdout);
            }
        }
        rel_close_case(&c);
    }
    printf("refused %d, still %d\n", refused, still);
    for (i = 0; i < REL_RELATIONS; i++) printf("%2d %-26s holds %d broken %d skipped %d\n", i, rel_relations[i].name, count[i][0], count[i][1], count[i][2]);
    return 0;
}
