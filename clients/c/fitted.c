/* Reads E of a single shape from a family's fitted volume: one file compiled twice, with
 * -DSTUDENT_T_FITTED_ALBEDO and without, whose albedos are compared at random roughnesses and
 * views. Prints the largest difference of E and of its parts, and the time of one E over that of
 * the exact curve; exit status 1 if a difference is above what docs/export.md allows. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "student_t_family.h"
#include "student_t_gamma_2p7.h"

enum { COUNT = 100000, TURNS = 20 };

/* E and its parts, and then only E. */
void exact(float sigma, float cos_theta, float all[4]);
void fitted(float sigma, float cos_theta, float all[4]);
void exact_albedos(const float *sigma, const float *cos_theta, float *e);
void fitted_albedos(const float *sigma, const float *cos_theta, float *e);

#ifdef STUDENT_T_FITTED_ALBEDO
#define OF(exact, fitted) fitted
#else
#define OF(exact, fitted) exact
#endif

void OF(exact, fitted)(float sigma, float cos_theta, float all[4])
{
    const student_t_lobe lobe = student_t_gamma_2p7_lobe(sigma, sigma);
    const float v[3] = {sqrtf((1.0f - cos_theta) * (1.0f + cos_theta)), 0.0f, cos_theta};
    all[0] = student_t_lobe_albedo(&lobe, v, STUDENT_T_HEIGHT_CORRELATED);
    student_t_lobe_albedo_parts(&lobe, v, STUDENT_T_HEIGHT_CORRELATED, all + 1);
}

void OF(exact_albedos, fitted_albedos)(const float *sigma, const float *cos_theta, float *e)
{
    int i;
    for (i = 0; i < COUNT; ++i) {
        const student_t_lobe lobe = student_t_gamma_2p7_lobe(sigma[i], sigma[i]);
        const float z = cos_theta[i], v[3] = {sqrtf((1.0f - z) * (1.0f + z)), 0.0f, z};
        e[i] = student_t_lobe_albedo(&lobe, v, STUDENT_T_HEIGHT_CORRELATED);
    }
}

#ifndef STUDENT_T_FITTED_ALBEDO
static float sigmas[COUNT], cosines[COUNT], albedos[COUNT];

static float number(void) { return ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f); }

static double seconds(void (*albedos_of)(const float *, const float *, float *))
{
    double best = 1e30;
    int turn;
    for (turn = 0; turn < TURNS; ++turn) {
        struct timespec from, to;
        double taken;
        timespec_get(&from, TIME_UTC);
        albedos_of(sigmas, cosines, albedos);
        timespec_get(&to, TIME_UTC);
        taken = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
        if (taken < best) best = taken;
    }
    return best;
}

int main(void)
{
    double e = 0.0, parts = 0.0;
    int i, k;
    for (i = 0; i < COUNT; ++i) {
        float a[4], b[4];
        sigmas[i] = 1e-3f * powf(3000.0f, number());
        cosines[i] = number();
        exact(sigmas[i], cosines[i], a);
        fitted(sigmas[i], cosines[i], b);
        e = fmax(e, (double)fabsf(a[0] - b[0]));
        for (k = 1; k < 4; ++k) parts = fmax(parts, (double)fabsf(a[k] - b[k]));
    }
    printf("E of gamma 2.7 from the volume: off by %.1e, its parts by %.1e, in %.2f of the time\n",
           e, parts, seconds(fitted_albedos) / seconds(exact_albedos));
    /* What is not a number must not pass. */
    return e > 0.0 && e < 5e-4 && parts < 1e-3 ? 0 : 1;
}
#endif
