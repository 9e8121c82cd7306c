/* A white furnace of whole materials: conductors of reflectance 1 return all light by samples
 * alone, with the compensating lobe of Kulla & Conty and with Turquin's factor. Exit status 1 if
 * they do not. */
#include <math.h>
#include <stdio.h>

#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"
#include "student_t_materials.h"

/* The place of a lattice of irrational steps in the unit cube. */
static float place(long i, double step)
{
    const double x = (double)i * step + 0.5;
    return (float)(x - floor(x));
}

/* The mean weight of samples. */
static double returned(const student_t_conductor *c, const float v[3])
{
    const long count = 262144;
    double sum = 0.0;
    for (long i = 0; i < count; ++i) {
        const float u[2] = {place(i, 0.6710436067037893), place(i, 0.5497004779019703)};
        sum += (double)student_t_conductor_sample(c, v, place(i, 0.8191725133961645), u).weight[0];
    }
    return sum / (double)count;
}

int main(void)
{
    const student_t_shape *const shapes[] = {&student_t_gamma_1p65, &student_t_gamma_2,
                                             &student_t_gamma_3};
    const float sigmas[] = {0.0f, 0.03f, 0.3f, 1.5f};
    const float cosines[] = {0.02f, 0.3f, 0.9f};
    const float white[3] = {1.0f, 1.0f, 1.0f};
    const student_t_reflectance mirror = student_t_schlick(white, white);
    double worst = 0.0;
    for (int i = 0; i < 3 * 4 * 3 * 4; ++i) {
        const enum student_t_masking masking =
            i % 2 ? STUDENT_T_HEIGHT_CORRELATED : STUDENT_T_UNCORRELATED;
        const enum student_t_compensation_form form =
            i / 2 % 2 ? STUDENT_T_KULLA_CONTY : STUDENT_T_TURQUIN;
        const float z = cosines[i / 4 % 3], sigma = sigmas[i / 12 % 4];
        const float v[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        const student_t_lobe lobe = student_t_lobe_of(shapes[i / 48], sigma, sigma);
        const student_t_conductor c = student_t_conductor_at(&lobe, &mirror, masking, form);
        const double off = fabs(returned(&c, v) - 1.0);
        worst = off > worst ? off : worst;
        if (!(off <= 3e-3))
            printf("shape %d, sigma %g, cos theta %g, masking %d, form %d: off by %g\n", i / 48,
                   (double)sigma, (double)z, (int)masking, (int)form, off);
    }
    printf("white conductors: 144 return all light by samples to %.1e, of 3e-3 allowed\n", worst);
    return worst <= 3e-3 ? 0 : 1;
}
