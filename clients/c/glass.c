/* A white furnace of glass, by sampling a dielectric of one bounce from both sides. With importance
 * every weight is a share of light, so that the mean weight of a view is what its bounce returns:
 * at most 1, less what further bounces would return. With radiance transmitted light has the
 * factor (n_v/n_l)^2. With compensation, from a small set of tables, the mean is 1, and so it is of
 * plastics over a white base. Exit status 1 if a mean or a weight is out of range. */
#include <stdio.h>

#include "student_t_eta_0p6666667.h"
#include "student_t_eta_1p5.h"
#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"

/* One of a sequence of numbers that fill [0, 1] evenly. */
static float choice_of(long i)
{
    const double x = 0.7548776662 * (double)i;
    return (float)(x - floor(x));
}

/* The mean weights of a view at the points of a lattice, reflected and transmitted; the largest
 * single weight is returned. */
static float means(const student_t_dielectric *glass, const float v[3],
                   enum student_t_transport transport, double mean[2])
{
    const long count = 28657, step = 17711; /* successive Fibonacci numbers */
    float most = 0.0f;
    mean[0] = mean[1] = 0.0;
    for (long i = 0; i < count; ++i) {
        const float u[2] = {((float)i + 0.5f) / (float)count,
                            ((float)(i * step % count) + 0.5f) / (float)count};
        const student_t_sample s =
            student_t_dielectric_sample(glass, v, choice_of(i), u, transport);
        mean[s.event == STUDENT_T_TRANSMITTED] += (double)s.weight[0] / (double)count;
        most = s.weight[0] > most ? s.weight[0] : most;
    }
    return most;
}

/* The mean weight of a plastic. */
static double plastic_mean(const student_t_plastic *plastic, const float v[3])
{
    const long count = 28657, step = 17711;
    double mean = 0.0;
    for (long i = 0; i < count; ++i) {
        const float u[2] = {((float)i + 0.5f) / (float)count,
                            ((float)(i * step % count) + 0.5f) / (float)count};
        const student_t_sample s = student_t_plastic_sample(plastic, v, choice_of(i), u);
        mean += (double)s.weight[0] / (double)count;
    }
    return mean;
}

/* Compensated glass and white plastics by the tables of two indices; returns how far the worst view
 * is from 1. */
static double compensated(void)
{
    const student_t_interface_table *const tables[] = {&student_t_eta_1p5,
                                                       &student_t_eta_0p6666667};
    const student_t_shape *const shapes[] = {&student_t_gamma_2, &student_t_gamma_3};
    const enum student_t_compensation_form forms[] = {STUDENT_T_TURQUIN, STUDENT_T_KULLA_CONTY};
    const float sigmas[] = {1e-4f, 0.2f, 0.35f, 0.5f}, cosines[] = {1.0f, 0.6f, 0.2f};
    const float white[3] = {1.0f, 1.0f, 1.0f};
    double worst = 0.0;
    for (int i = 0; i < 2 * 2 * 2 * 4 * 3; ++i) {
        const enum student_t_compensation_form form = forms[i % 2];
        const student_t_interface_table *table = tables[i / 2 % 2];
        const float s = sigmas[i / 8 % 4], z = cosines[i / 32];
        const student_t_lobe lobe = student_t_lobe_of(shapes[i / 4 % 2], s, s);
        const student_t_dielectric glass = student_t_dielectric_compensated(&lobe, table, form);
        const student_t_plastic plastic = student_t_plastic_at(&lobe, table, white, form);
        const float above[3] = {sqrtf(1.0f - z * z), 0.0f, z}, below[3] = {above[0], 0.0f, -z};
        double shares[2], all[3];
        means(&glass, above, STUDENT_T_IMPORTANCE, shares);
        all[0] = shares[0] + shares[1];
        means(&glass, below, STUDENT_T_IMPORTANCE, shares);
        all[1] = shares[0] + shares[1];
        all[2] = plastic_mean(&plastic, above);
        for (int k = 0; k < 3; ++k) {
            const double off = fabs(all[k] - 1.0);
            worst = off > worst ? off : worst;
            if (off > 2e-3)
                printf("%s, eta %g, form %d, gamma %g, sigma %g, cos theta %g: %g\n",
                       k < 2 ? "glass" : "plastic", (double)table->eta, (int)form,
                       (double)lobe.gamma, (double)s, k == 1 ? (double)-z : (double)z, all[k]);
        }
    }
    return worst;
}

int main(void)
{
    const student_t_shape *const shapes[] = {&student_t_gamma_1p65, &student_t_gamma_2,
                                             &student_t_gamma_3};
    const float sigmas[] = {1e-4f, 0.03f, 0.1f, 0.3f, 0.7f, 1.5f};
    const float cosines[] = {1.0f, 0.6f, 0.1f, -0.1f, -0.6f, -1.0f};
    const float eta = 1.5f;
    double most = 0.0, least = 1.0;
    int good = 1;
    for (int i = 0; i < 3 * 6 * 6 * 2; ++i) {
        const enum student_t_masking masking =
            i % 2 ? STUDENT_T_HEIGHT_CORRELATED : STUDENT_T_UNCORRELATED;
        const float z = cosines[i / 2 % 6], s = sigmas[i / 12 % 6];
        const float v[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        const student_t_lobe lobe = student_t_lobe_of(shapes[i / 72], s, s);
        const student_t_dielectric glass = student_t_dielectric_at(&lobe, eta, masking);
        const double scale = z > 0.0f ? 1.0 / (1.5 * 1.5) : 1.5 * 1.5;
        double shares[2], radiance[2], all, apart;
        const float weight = means(&glass, v, STUDENT_T_IMPORTANCE, shares);
        means(&glass, v, STUDENT_T_RADIANCE, radiance);
        all = shares[0] + shares[1];
        apart = fabs(radiance[0] - shares[0]) + fabs(radiance[1] / scale - shares[1]);
        most = all > most ? all : most;
        least = all < least ? all : least;
        /* A smooth lobe loses nothing. */
        if (!(weight <= 1.000001f && all > 0.0 && apart < 1e-5) ||
            (glass.is_smooth && fabs(all - 1.0) > 1e-5)) {
            printf("shape %d, sigma %g, cos theta %g: %g, largest weight %g, radiance off by %g\n",
                   i / 72, (double)s, (double)z, all, (double)weight, apart);
            good = 0;
        }
    }
    printf("glass: one bounce returns from %.3f to %.6f of the light, no weight exceeds 1\n", least,
           most);
    {
        const double worst = compensated();
        printf("compensated glass and white plastics return all light to %.1e, of 2e-3 allowed\n",
               worst);
        good = good && worst <= 2e-3;
    }
    return good ? 0 : 1;
}
