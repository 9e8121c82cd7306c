/* A white furnace of glass, by sampling a dielectric of one bounce from both sides. With importance
 * every weight is a share of light, so that the mean weight of a view is what its bounce returns:
 * at most 1, less what further bounces would return. With radiance transmitted light has the
 * factor (n_v/n_l)^2. Exit status 1 if a mean or a weight is out of range. */
#include <stdio.h>

#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"
#include "student_t_materials.h"

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
        const float choice = (float)(0.7548776662 * (double)i - floor(0.7548776662 * (double)i));
        const student_t_sample s = student_t_dielectric_sample(glass, v, choice, u, transport);
        mean[s.event == STUDENT_T_TRANSMITTED] += (double)s.weight[0] / (double)count;
        most = s.weight[0] > most ? s.weight[0] : most;
    }
    return most;
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
    return good ? 0 : 1;
}
