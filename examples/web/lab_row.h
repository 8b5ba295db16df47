/* lab_row.h - the line "#define LAW {...}" of a law, as examples/exam.c reads it and the lab lays it out in memory. */
#ifndef LAB_ROW_H
#define LAB_ROW_H
typedef struct lab_row {
    const char *name;
    dem_law_fn law;
    void *user;
    int memory, vectors;
    double stiffness;            /* N/m */
    int coefficients, known;
    double range;                /* m */
    int who;
    dem_contact_fn made;
} lab_row;
#endif
