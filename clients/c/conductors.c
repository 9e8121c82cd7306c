/* A white furnace of whole materials: conductors of reflectance 1 return all light by samples
 * alone, with the compensating lobe of Kulla & Conty and with Turquin's factor. Schlick's
 * reflectances with an F90 below 1, and all others, have the averages that their values integrate
 * to. Exit status 1 if something does not hold. */
#include <math.h>
#include <stdio.h>

#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_2p5.h"
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

/* How far the averages of a reflectance are from the integrals of 2 F mu over mu. */
static double average_off(const student_t_reflectance *r)
{
    const int count = 100000;
    double sum[STUDENT_T_CHANNELS] = {0.0}, worst = 0.0;
    for (int i = 0; i < count; ++i) {
        const float mu = ((float)i + 0.5f) / (float)count;
        float f[STUDENT_T_CHANNELS];
        student_t_reflectance_at(r, mu, f);
        for (int k = 0; k < STUDENT_T_CHANNELS; ++k)
            sum[k] += 2.0 * (double)mu * (double)f[k] / count;
    }
    for (int k = 0; k < STUDENT_T_CHANNELS; ++k) {
        const double off = fabs(sum[k] - (double)r->average[k]);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* Values of Schlick's reflectance at both ends and halfway, for F90 unlike 1, and averages. */
static int reflectances(void)
{
    const float f0[3] = {0.9f, 0.2f, 0.0f}, f90[3] = {0.3f, 0.6f, 0.0f};
    const float eta[3] = {0.2f, 1.5f, 2.9f}, k[3] = {3.0f, 0.0f, 3.1f};
    const student_t_reflectance all[3] = {student_t_schlick(f0, f90), student_t_f82(f0, f90),
                                          student_t_eta_k(eta, k)};
    double worst = 0.0, at_ends = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double off = average_off(&all[i]);
        worst = off > worst ? off : worst;
    }
    for (int i = 0; i < 3; ++i) {
        const float mu = 0.5f * (float)i, power = powf(1.0f - mu, 5.0f);
        float f[3];
        student_t_reflectance_at(&all[0], mu, f);
        for (int channel = 0; channel < 3; ++channel) {
            const float want = f0[channel] + (f90[channel] - f0[channel]) * power;
            const double off = fabs((double)(f[channel] - want));
            at_ends = off > at_ends ? off : at_ends;
        }
    }
    printf("reflectances: averages to %.1e, of 1e-5 allowed; Schlick's, F90 unlike 1, to %.1e, of "
           "1e-6\n",
           worst, at_ends);
    return worst <= 1e-5 && at_ends <= 1e-6;
}

/* How far conductors of reflectance 1 are from returning all light, for views of several azimuths
 * and a lobe that is not round, with Kulla and Conty's compensation. */
static double lost_of(float sigma_x, float sigma_y)
{
    const float white[3] = {1.0f, 1.0f, 1.0f};
    const student_t_reflectance mirror = student_t_schlick(white, white);
    const student_t_lobe lobe = student_t_gamma_2p5_lobe(sigma_x, sigma_y);
    const student_t_conductor c = student_t_conductor_at(
        &lobe, &mirror, STUDENT_T_HEIGHT_CORRELATED, STUDENT_T_KULLA_CONTY);
    double worst = 0.0;
    for (int i = 0; i < 5 * 3; ++i) {
        const float cosines[] = {0.05f, 0.3f, 0.9f};
        const float z = cosines[i % 3], r = sqrtf(1.0f - z * z), phi = 0.4f * (float)(i / 3);
        const float v[3] = {r * cosf(phi), r * sinf(phi), z};
        const double off = fabs(returned(&c, v) - 1.0);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* Albedos that were baked for a lobe, beside those of the round one that stands in for lobes next
 * to it. */
static int turning(void)
{
    const double own = lost_of(0.2f, 0.05f), stand_in = lost_of(0.2f, 0.0501f);
    printf("white conductors of sigma 0.2 and 0.05: all light to %.1e with albedos of their own, "
           "of 3e-3 allowed; to %.1e with those of a round lobe\n",
           own, stand_in);
    return own <= 3e-3 && stand_in > 1e-2;
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
    return turning() && reflectances() && worst <= 3e-3 ? 0 : 1;
}
