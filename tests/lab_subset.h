/* lab_subset.h - expressions and statements in the C that the law lab translates, each of which gives a number that C
   defines. tests/lab.mjs compares those of its translation with those of a C compiler. */
#include <math.h>
#include <stdint.h>
#define SQUARE(x) ((x)*(x))
#define CASES 34
typedef struct point { double x, y; int at[3]; } point;
typedef struct list { point p[2]; const char *name; struct list *next; } list;
enum kind { ONE = 1, TWO, SEVEN = 7, EIGHT };
static double third = 1.0/3;
static const int primes[] = {2, 3, 5, 7, 11};
static const point corners[2][2] = {{{1, 2, {3, 4, 5}}, {6, 7, {8}}}, {{.y = 9, .x = 10}, {11}}};
static point point_make(double x, double y) { point p = {x, y, {1, 2, 3}}; p.at[1] += 5; return p; }
static double total(const point *p, int count) { double s = 0; int k; for (k = 0; k < count; k++) s += p[k].x + p[k].y; return s; }
static int fibonacci(int n) { return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2); }
static void swap(double *a, double *b) { const double t = *a; *a = *b; *b = t; }
static double twice(double x) { return 2*x; }
static double changed(point p) { p.x = 100; return p.x + p.y; }
static int counter(void) { static int calls = 5; return ++calls; }
static double later(double x);
static double (*choose(int k))(double) { return k ? twice : later; }
static double later(double x) { return x + 0.5; }
static double subset(int k) {
    double a[4] = {1, 2}, x = 3, y = 4;
    int i = 7, j = -3, m[2][3] = {{1, 2, 3}, {4, 5, 6}};
    unsigned u = 3;
    point p = point_make(2, 3), q, *r = &p, many[3];
    list l = {{{1, 2, {0, 0, 0}}, {3, 4, {0, 0, 0}}}, "abc", 0};
    switch (k) {
    case 0: return i/2 + j/2 + i%3 + j%2;
    case 1: return i/2.0 + (double)j/2;
    case 2: return (u - 4) > 0 ? u - 4 : -1;
    case 3: return (int)(-2.9) + (int)2.9;
    case 4: return 2147483647 - 2147483646 + (1 << 20 >> 3) + (~5 & 0xff) + (6 ^ 3) + (4 | 1);
    case 5: return SQUARE(x + 1) + SQUARE(i);
    case 6: a[2] = a[3] = 5; return a[0] + 10*a[1] + 100*a[2] + 1000*a[3];
    case 7: return m[1][2] + *(m[0] + 1) + (*m)[2] + (int)(sizeof m/sizeof m[0][0]);
    case 8: return p.x + p.at[1] + r->y + (*r).at[2] + sizeof(point);
    case 9: q = p; q.x = 50; return p.x + q.x + q.at[0];
    case 10: swap(&x, &y); return x*10 + y;
    case 11: for (i = 0, x = 0; i < 10; i++) { if (i == 3) continue; if (i == 8) break; x += i; } return x;
    case 12: i = 0; do { i += 2; } while (i < 9); return i;
    case 13: i = 5; x = i++ + ++i; return x*10 + i;
    case 14: a[1] = 7; r->at[0]++; --r->at[2]; a[i - 6] += 3; a[1] *= 2; return a[1] + r->at[0]*100 + r->at[2]*1000;
    case 15: return fibonacci(15);
    case 16: return primes[4] + third*3 + sizeof primes/sizeof *primes;
    case 17: return corners[0][1].at[0] + corners[1][0].x*10 + corners[1][0].y*100 + corners[1][1].x*1000 + corners[0][0].at[2];
    case 18: return l.name[1] + l.p[1].y + (l.next == 0);
    case 19: l.next = &l; return l.next->next->p[0].y + (l.next == &l);
    case 20: many[0] = p; many[1] = point_make(5, 6); many[2] = (point){7, 8, {9}}; return total(many, 3) + many[2].at[1];
    case 21: return changed(p) + p.x;
    case 22: return counter() + 10*counter();
    case 23: return choose(1)(4) + choose(0)(4);
    case 24: return EIGHT*10 + TWO + (ONE == 1 && SEVEN != 7 ? 1000 : 2000);
    case 25: { double k = 5; { double k = 6; x = k; } return x*10 + k; }
    case 26: { float f = 0.1f; f *= 3; return f + (double)(float)0.3; }
    case 27: return (x > 2 && y < 5) + 2*(x > 5 || !(y > 3)) + 4*!0;
    case 28: return -x - -y + +x, x*y;
    case 29: { const double *s = a + 1; s++; return (s - a) + s[-1] + (s > a); }
    case 30: switch (i) { case 6: x = 1; case 7: x = 2; case 8: x += 10; break; default: x = 99; } return x;
    case 31: { signed char c = (signed char)200; unsigned char d = (unsigned char)300; short s = (short)70000; return c + d + s; }
    case 32: return fmod(7.5, 2) + copysign(3, -1) + floor(-2.5) + fmax(1, 2) + fabs(-4) + hypot(3, 4) + round(-2.5);
    case 33: return 0x1F + 'a' + '\n' + 1e3 + .5 + 5.f + 10u + 1e-3*1e3;
    }
    return -1;
}
