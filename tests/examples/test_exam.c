/* The exam for contact laws (examples/exam.h): built-in laws pass it, and for every line there is a wrong law that is
   caught there, and nowhere that it is right. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "../../examples/exam.h"
#include "../../examples/laws/bond.h"

/* ---- right laws ---- */

static void hertz_rescaled_epsd(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_mindlin_rescaled(c, memory + 3, f);  /* a vector and a number: vectors come first */
    dem_law_roll_epsd(c, memory, f);
}
static void linear_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
    dem_law_spring(c, memory, f);
}
static void hertz_viscous(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_viscous(c, memory, f);
}
static void hertz_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
}
/* Walton and Braun's, memory 0: the largest overlap. */
static void dent(const dem_contact *c, dem_real *memory, dem_contact_force *f, dem_real k) {
    const dem_real deepest = memory[0] > c->overlap ? memory[0] : c->overlap;
    const dem_real out = 4*k*(c->overlap - DEM_R(0.75)*deepest);
    f->normal = out < k*c->overlap ? out : k*c->overlap;
    if (f->normal < 0) f->normal = 0;
    if (c->dt > 0) memory[0] = deepest;
}
static void dented(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dent(c, memory, f, 1000); }
static void dented_hard(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dent(c, memory, f, 10000); }

/* ---- wrong ones, each in one way ---- */

static dem_real always(dem_real x) { return x; }
static void divides(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->normal *= 1 + DEM_R(1e-3)*(c->closing_speed - c->closing_speed)/always(c->overlap - c->overlap*c->overlap/c->overlap);
}
static void remembers(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    static dem_real last;
    linear_spring(c, memory, f);
    f->normal += DEM_R(0.01)*c->kn*(c->overlap < last ? c->overlap : last)*DEM_R(0.1);
    last = c->overlap;
}
static void writes(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    memory[3] += 1;
}
static void overflows(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    memory[4] = c->overlap;
}
static void takes_sides(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->tangent = demi_add(f->tangent, demi_scale(demi_cross(c->normal, c->slip), DEM_R(-0.1)*c->ct));
}
static void knows_axes(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->tangent.x *= DEM_R(0.99);
}
static void jumps(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->normal += DEM_R(0.1)*c->kn*DEM_R(2e-5);
}
static void pushes_out(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    if (c->closing_speed < 0) f->normal *= DEM_R(1.05);
}
static void kicks_when_fast(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    if (c->closing_speed < DEM_R(-0.3)) f->normal *= DEM_R(1.3);
}
static void drives(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->tangent = demi_add(f->tangent, demi_scale(c->slip, DEM_R(3.0)*c->ct));
}
static void rolls_on(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->moment = demi_scale(c->spin, DEM_R(1e-9));
}
static void depends_on_dt(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    linear_spring(c, memory, f);
    f->normal += c->cn*c->closing_speed*DEMI_SQRT(DEMI_SQRT(c->dt*DEM_R(1e6)));
}
static void dawdles(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    volatile double sum = 0;
    int k;
    for (k = 0; k < 5000; k++) sum += sqrt((double)k);
    if (sum > 0) linear_spring(c, memory, f);
}

/* A spring with friction of its own. */
static void own_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f, int rotates, int by_slip, int limited) {
    const dem_vec3 slip = by_slip ? c->slip : c->slip_step, old = demi_at(memory);
    dem_vec3 s = demi_add(rotates ? dem_memory_rotate(c, old) : old, demi_scale(slip, c->dt));
    const dem_real kt = DEM_R(0.5)*c->kn, size = kt*demi_length(s);
    dem_real most;
    dem_law_linear(c, memory, f);
    most = DEM_R(0.4)*(f->normal > 0 ? f->normal : 0);
    if (limited && size > most) s = demi_scale(s, most/size);
    f->tangent = demi_scale(s, -kt);
    if (c->dt > 0) { memory[0] = s.x; memory[1] = s.y; memory[2] = s.z; }
}
static void springs(const dem_contact *c, dem_real *memory, dem_contact_force *f) { own_spring(c, memory, f, 1, 0, 1); }
static void stays(const dem_contact *c, dem_real *memory, dem_contact_force *f) { own_spring(c, memory, f, 0, 0, 1); }
static void slips(const dem_contact *c, dem_real *memory, dem_contact_force *f) { own_spring(c, memory, f, 1, 1, 1); }
static void never_slides(const dem_contact *c, dem_real *memory, dem_contact_force *f) { own_spring(c, memory, f, 1, 0, 0); }

static void bond_pushes(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    bond_law(c, memory, f);
    f->tangent = demi_add(f->tangent, demi_scale(c->slip, DEM_R(300.0)*c->ct));
}
static void bond_hides(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    bond_law(c, memory, f);                      /* with one vector told of two */
}

/* Laws that act before touch, from a gap of FAR on: a viscous film (6 pi eta R*^2 v/h above a roughness), a soft
   cushion on which slow grains turn round; and each with what makes energy only while grains are apart. */
#define FAR DEM_R(1e-4)
static void film(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real h = -c->overlap > DEM_R(1e-6) ? -c->overlap : DEM_R(1e-6);
    if (c->overlap > 0) hertz_viscous(c, memory, f);
    else f->normal = DEM_R(0.0188)*c->r_eff*c->r_eff*c->closing_speed/h;
}
static void cushion(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    if (c->overlap > 0) linear_spring(c, memory, f);
    f->normal += DEM_R(0.05)*(c->overlap + FAR)/FAR;
}
static void film_drives(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    film(c, memory, f);
    if (!(c->overlap > 0) && c->closing_speed < 0) f->normal *= DEM_R(-1.5);
}
static void cushion_kicks_when_fast(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    cushion(c, memory, f);
    if (!(c->overlap > 0) && c->closing_speed < DEM_R(-0.3)) f->normal *= 3;
}

/* Takes the exam; 1 + the first line that is not passed, 0: all are. */
static int take(dem_law_fn law, int memory, int vectors, double stiffness, dem_normal_law coefficients, double restitution,
                exam_sheet *sheet) {
    exam e = exam_of("law", law, 0, memory, vectors, stiffness);
    int k;
    e.coefficients = coefficients;
    e.material.restitution = (dem_real)restitution;
    CHECK_EQ(exam_take(&e, sheet), DEM_OK);
    for (k = 0; k < EXAM_LINES; k++) {
        CHECK(sheet->line[k].found[0] && strlen(sheet->line[k].found) < 279);
        if (!sheet->line[k].passed && k != EXAM_COST) return k + 1;
    }
    return 0;
}
static void right(const char *name, dem_law_fn law, int memory, int vectors, double stiffness, dem_normal_law coefficients) {
    exam_sheet sheet;
    const int line = take(law, memory, vectors, stiffness, coefficients, 0.7, &sheet);
    CHECK_EQ(line, 0);
    if (line) printf("%s: %s: %s\n", name, sheet.line[line - 1].asks, sheet.line[line - 1].found);
}
/* A law that is linear_spring but for one thing, which that line finds and says with these words. */
static void wrong(dem_law_fn law, int line, const char *says, double stiffness, int vectors) {
    exam_sheet sheet;
    int first;
    if (law == dawdles) {
        exam e = exam_of("law", law, 0, 3, 1, 0);
        memset(&sheet, 0, sizeof sheet);
        CHECK(exam_contact(&e));
        first = exam_is_quick(&e, sheet.line[EXAM_COST].found) ? 0 : EXAM_COST + 1;
    } else first = take(law, law == writes ? 4 : 3, vectors, stiffness, DEM_NORMAL_LINEAR, 0.9, &sheet);
    CHECK_EQ(first - 1, line);
    CHECK_STR(sheet.line[line].found, says);
    if (first - 1 != line && first) printf("line %d instead of %d: %s\n", first - 1, line, sheet.line[first - 1].found);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("the built-in laws and one with a dent pass every line of the exam") {
        right("rescaled Mindlin, EPSD", hertz_rescaled_epsd, 7, 2, 0, DEM_NORMAL_HERTZ);
        right("linear, spring", linear_spring, 3, 1, 0, DEM_NORMAL_LINEAR);
        right("own spring", springs, 3, 1, 0, DEM_NORMAL_LINEAR);
        right("Hertz, viscous", hertz_viscous, 0, 0, 0, DEM_NORMAL_HERTZ);
        right("dent", dented, 1, 0, 4000, DEM_NORMAL_LINEAR);
        right("dent, ten times as hard", dented_hard, 1, 0, 40000, DEM_NORMAL_LINEAR);     /* no shear: round-off is no gain */
    }
    TEST("a Hertzian spring of constant length creates energy when pressed while sheared, and the exam says so") {
        exam_sheet sheet;
        CHECK_EQ(take(hertz_spring, 3, 1, 0, DEM_NORMAL_HERTZ, 0.7, &sheet), EXAM_MIXED + 1);
        CHECK_STR(sheet.line[EXAM_MIXED].found, "rescale the tangential force");
    }
    TEST("each line of the exam catches a law with only that defect, and says where to look") {
        wrong(divides, EXAM_FINITE, "no number at an overlap of", 0, 1);
        wrong(remembers, EXAM_PURE, "the law remembers beside its memory", 0, 1);
        wrong(writes, EXAM_ASKED, "real 3 of the memory goes from", 0, 1);
        wrong(overflows, EXAM_ASKED, "real 4 is written, but law_memory is 3", 0, 1);
        wrong(takes_sides, EXAM_SWAP, "a and b exchanged, forces differ by", 0, 1);
        wrong(linear_spring, EXAM_SWAP, "law_vectors how many they are (0 now)", 0, 0);
        wrong(knows_axes, EXAM_FRAME, "seen from a frame that is turned", 0, 1);
        wrong(stays, EXAM_TURN, "rotate vectors in the memory with dem_memory_rotate", 0, 1);
        wrong(slips, EXAM_WAY, "memory must grow by slip_step", 0, 1);
        wrong(never_slides, EXAM_BOUND, "times the normal force: limit it", 0, 1);
        wrong(jumps, EXAM_ENDS, "the force jumps by", 0, 1);
        wrong(pushes_out, EXAM_PRESS, "the way out must not lie above that on the way in", 0, 1);
        wrong(drives, EXAM_SHEAR, "friction must act against slip", 0, 1);
        wrong(rolls_on, EXAM_ROLL, "the moment must act against the spin", 0, 1);
        wrong(kicks_when_fast, EXAM_IMPACT, "times the energy it began with", 0, 1);
        wrong(linear_spring, EXAM_STEP, "must be the stiffest the law gets", 1, 1);
        wrong(depends_on_dt, EXAM_ORDER, "does a force contain dt", 0, 1);
        wrong(dawdles, EXAM_COST, "times Hertz with a spring", 0, 1);
    }
    TEST("a bond law passes the exam bonded; a force along the shear or an undeclared vector fails it") {
        static bond cement = {DEM_R(1e8), DEM_R(2.5), DEM_R(5e-4), DEM_R(1e9), DEM_R(1e9), DEM_R(0.1)};
        static const dem_law_fn law[4] = {bond_law, bond_pushes, bond_hides, bond_law};
        static const char *const says[4] = {"", "friction must act against slip", "a and b exchanged in mid-contact", ""};
        static const int line[4] = {0, EXAM_SHEAR + 1, EXAM_SWAP + 1, 0};
        int k, j, first;
        for (k = 0; k < 4; k++) {
            exam e = exam_of("bond", law[k], &cement, 8, k == 2 ? 1 : 2, 1.6e5);
            exam_sheet sheet;
            e.coefficients = DEM_NORMAL_LINEAR;
            e.range = 2e-4;
            e.who = 1;
            e.made = bond_make;
            if (k == 3) e.range = 0;             /* nothing to make a bond in */
            CHECK_EQ(exam_take(&e, &sheet), k == 3 ? DEM_ERROR_ARGUMENT : DEM_OK);
            if (k == 3) { CHECK_STR(sheet.line[0].found, "to a law of bonds a range"); continue; }
            for (first = j = 0; j < EXAM_LINES && !first; j++)
                if (!sheet.line[j].passed && j != EXAM_COST) first = j + 1;
            CHECK_EQ(first, line[k]);
            if (first) CHECK_STR(sheet.line[first - 1].found, says[k]);
        }
    }
    TEST("a law that repels before contact passes the exam; one that creates energy there fails") {
        static const dem_law_fn law[4] = {film, cushion, film_drives, cushion_kicks_when_fast};
        static const int line[4] = {0, 0, EXAM_IMPACT + 1, EXAM_IMPACT + 1};
        static const char *const says[4] = {"", "", "times the energy it began with", "times the energy it began with"};
        int k, j, first;
        for (k = 0; k < 4; k++) {
            const int linear = k%2;
            exam e = exam_of("law", law[k], 0, linear ? 3 : 0, linear, 0);
            exam_sheet sheet;
            e.coefficients = linear ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
            e.range = (double)FAR;
            CHECK_EQ(exam_take(&e, &sheet), DEM_OK);
            for (first = j = 0; j < EXAM_LINES && !first; j++)
                if (!sheet.line[j].passed && j != EXAM_COST) first = j + 1;
            CHECK_EQ(first, line[k]);
            if (first) CHECK_STR(sheet.line[first - 1].found, says[k]);
            if (first != line[k] && first) printf("%d: %s: %s\n", k, sheet.line[first - 1].asks, sheet.line[first - 1].found);
        }
    }
    TEST("the exam rejects a missing law, too much memory and too many vectors with a message") {
        exam e = exam_of("law", 0, 0, 3, 1, 0);
        exam_sheet sheet;
        CHECK_EQ(exam_take(&e, &sheet), DEM_ERROR_ARGUMENT);
        CHECK_STR(sheet.line[0].found, "with law null");
        e = exam_of("law", linear_spring, 0, 16, 1, 0);
        CHECK_EQ(exam_take(&e, &sheet), DEM_OK);
        e = exam_of("law", linear_spring, 0, 17, 1, 0);
        CHECK_EQ(exam_take(&e, &sheet), DEM_ERROR_ARGUMENT);
        CHECK_STR(sheet.line[0].found, "memory 17");
        e = exam_of("law", linear_spring, 0, 3, 2, 0);
        CHECK_EQ(exam_take(&e, &sheet), DEM_ERROR_ARGUMENT);
        CHECK_STR(sheet.line[0].found, "vectors 2");
        CHECK_EQ(sheet.passed, 0);
    }
    return test_end();
}
