/* A white furnace: what one bounce returns, by sampling visible normals, and what the compensating
 * lobe gives back, by quadrature, must sum to 1. Exit status 1 if they do not. */
#include <stdio.h>

#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"

/* The mean weight of normals at the points of a golden lattice: the albedo of one bounce. */
static double one_bounce(const student_t_shape *shape, const float sigma[2], const float v[3],
                         enum student_t_masking masking)
{
    const long count = 28657, step = 17711; /* successive Fibonacci numbers */
    double sum = 0.0;
    for (long i = 0; i < count; ++i) {
        const float u[2] = {((float)i + 0.5f) / (float)count,
                            ((float)(i * step % count) + 0.5f) / (float)count};
        float m[3], l[3];
        student_t_sample_visible_normal(shape, sigma, v, u, m);
        student_t_reflect(v, m, l);
        sum += student_t_reflection_weight(shape, sigma, v, l, masking);
    }
    return sum / (double)count;
}

/* The integral of the compensating lobe times the cosine of the light, l_z = t^3. */
static double further_bounces(const student_t_shape *shape, const float sigma[2], const float v[3],
                              enum student_t_masking masking)
{
    const int steps = 400;
    const float e_v = student_t_albedo(shape, sigma, v, masking);
    const float e_average = student_t_albedo_average(shape, sigma, masking);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const float t = ((float)i + 0.5f) / (float)steps, z = t * t * t;
        const float l[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        const float e_l = student_t_albedo(shape, sigma, l, masking);
        sum += 2.0 * 3.14159265 * student_t_compensation_from(e_v, e_l, e_average) *
               (z * 3.0f * t * t) / steps;
    }
    return sum;
}

int main(void)
{
    const student_t_shape *const shapes[] = {&student_t_gamma_1p65, &student_t_gamma_2,
                                             &student_t_gamma_3};
    const float sigmas[] = {0.01f, 0.1f, 0.3f, 0.7f, 1.5f, 3.0f};
    const float cosines[] = {0.02f, 0.1f, 0.3f, 0.6f, 0.9f, 1.0f};
    double worst = 0.0;
    for (int i = 0; i < 3 * 6 * 6 * 2; ++i) {
        const enum student_t_masking masking =
            i % 2 ? STUDENT_T_HEIGHT_CORRELATED : STUDENT_T_UNCORRELATED;
        const float z = cosines[i / 2 % 6], s = sigmas[i / 12 % 6];
        const float v[3] = {sqrtf(1.0f - z * z), 0.0f, z}, sigma[2] = {s, s};
        const student_t_shape *shape = shapes[i / 72];
        const double one = one_bounce(shape, sigma, v, masking);
        const double all = one + further_bounces(shape, sigma, v, masking);
        worst = fabs(all - 1.0) > worst ? fabs(all - 1.0) : worst;
        if (!(fabs(all - 1.0) <= 2e-3))
            printf("shape %d, sigma %g, cos theta %g, masking %d: %g in one bounce, %g in all\n",
                   i / 72, (double)s, (double)z, (int)masking, one, all);
    }
    printf("white furnace: 216 views return all light to %.1e, of 2e-3 allowed\n", worst);
    return worst <= 2e-3 ? 0 : 1;
}
