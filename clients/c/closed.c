/* Compares the closed forms, which read no tables, with lobes of the family at random hits. Exit
 * status 1 if one is off by more than docs/shaders.md says, "Without tables", and the family's own
 * error. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "student_t_closed.h"
#include "student_t_family.h"

static float number(void) { return ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f); }

/* The largest so far; what is not a number stays the largest. */
static void see(double *worst, float a, float b, float scale)
{
    const double off = fabs((double)(a - b)) / (double)scale;
    if (!(off <= *worst)) *worst = off;
}

int main(void)
{
    double d = 0.0, g1 = 0.0, e = 0.0;
    int i;
    for (i = 0; i < 200000; ++i) {
        const float z = 0.02f + 0.97f * number(), turn = 6.2831853f * number();
        const float r = sqrtf(1.0f - z * z), w[3] = {r * cosf(turn), r * sinf(turn), z};
        const float gamma = i % 16 == 0 ? INFINITY : 1.0f + 1.0f / (0.02f + 1.64f * number());
        const float sigma = 0.01f + 0.98f * number(), both[2] = {sigma, 0.5f * sigma};
        const student_t_lobe lobe = student_t_lobe_at(gamma, both[0], both[1]);
        const student_t_lobe round = student_t_lobe_at(gamma, sigma, sigma);
        const float want = student_t_lobe_d(&lobe, w);
        if (want > 1e-30f)
            see(&d, student_t_closed_d(gamma, both, w), want, want * (1.0f + fabsf(logf(want))));
        see(&g1, student_t_closed_masking(gamma, both, w), student_t_lobe_g1(&lobe, w), 1.0f);
        see(&e, student_t_closed_albedo(gamma, sigma, z),
            student_t_lobe_albedo(&round, w, STUDENT_T_HEIGHT_CORRELATED), 1.0f);
    }
    printf("closed forms: D to %.1e (1 + |ln D|) of itself, of 2e-6 allowed; G1 to %.1e, of "
           "3.2e-4; E to %.1e, of 6.6e-3\n",
           d, g1, e);
    return d <= 2e-6 && g1 <= 3.2e-4 && e <= 6.6e-3 ? 0 : 1;
}
