/* What relaxed arithmetic costs, as of --use_fast_math: one file compiled twice, with -DFAST and
 * -ffast-math, and without, whose answers are compared at random hits of sigma from 1e-3 to 1.5.
 * Prints the largest relative differences; exit status 1 if one is above 1e-5, or if something is
 * lost or not finite. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "student_t_family.h"

enum { COUNT = 100000, ANSWERS = 4 };
typedef struct hit {
    float gamma, sigma, v[3], l[3], m[3], u[2];
} hit;

/* D, a density, the weight, and f of a hit. */
void answers(const hit *h, float *a);
void relaxed_answers(const hit *h, float *a);

#ifdef FAST
void relaxed_answers(const hit *h, float *a)
#else
void answers(const hit *h, float *a)
#endif
{
    student_t_lobe lobe;
    student_t_set_lobe(h->gamma, h->sigma, h->sigma, &lobe);
    a[0] = student_t_lobe_d(&lobe, h->m);
    a[1] = student_t_lobe_visible_normal_pdf(&lobe, h->v, h->m);
    a[2] = student_t_lobe_reflection_weight(&lobe, h->v, h->l, STUDENT_T_HEIGHT_CORRELATED);
    a[3] = student_t_lobe_eval_pdf(&lobe, h->v, h->l, STUDENT_T_HEIGHT_CORRELATED, a + 3);
}

#ifndef FAST
static float number(void) { return ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f); }

static void direction(float w[3])
{
    const float z = 0.999f * number() + 1e-4f, turn = 6.2831853f * number();
    w[0] = sqrtf(1.0f - z * z) * cosf(turn);
    w[1] = sqrtf(1.0f - z * z) * sinf(turn);
    w[2] = z;
}

int main(void)
{
    const float gammas[] = {1.55f, 1.8f, 2.0f, 2.7f, 6.0f, INFINITY};
    const char *const names[ANSWERS] = {"D", "density", "weight", "f"};
    int bad = 0, g, i, k;
    for (g = 0; g < 6; ++g) {
        double worst[ANSWERS] = {0.0};
        for (i = 0; i < COUNT; ++i) {
            hit h;
            float exact[ANSWERS], relaxed[ANSWERS];
            student_t_lobe lobe;
            h.gamma = gammas[g];
            h.sigma = 1e-3f * powf(1500.0f, number());
            direction(h.v);
            h.u[0] = number();
            h.u[1] = number();
            student_t_set_lobe(h.gamma, h.sigma, h.sigma, &lobe);
            student_t_lobe_sample_visible_normal(&lobe, h.v, h.u, h.m);
            student_t_reflect(h.v, h.m, h.l);
            if (!(h.l[2] > 0.0f)) continue;
            answers(&h, exact);
            relaxed_answers(&h, relaxed);
            for (k = 0; k < ANSWERS; ++k) {
                const double a = (double)exact[k], b = (double)relaxed[k];
                /* What is nearly subnormal has few digits on either side. */
                if (!(a > 1e-30 && a < 1e37)) continue;
                bad += !(b > 0.0 && b <= 3.4e38);
                worst[k] = fmax(worst[k], fabs(b / a - 1.0));
            }
        }
        printf("relaxed arithmetic, gamma %g:", (double)gammas[g]);
        for (k = 0; k < ANSWERS; ++k) bad += worst[k] > 1e-5;
        for (k = 0; k < ANSWERS; ++k) printf(" %s %.1e%s", names[k], worst[k], k < 3 ? "," : "\n");
    }
    if (bad) printf("relaxed arithmetic: %d faults\n", bad);
    return bad != 0;
}
#endif
