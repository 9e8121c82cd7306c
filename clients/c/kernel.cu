/* Every function and material in kernels, of shapes and of a family whose address a kernel takes;
 * and one on the host, where the program runs it. */
#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"
#include "student_t_materials.h"

extern "C" __global__ void kernel(const float *v, const float *u, float *m, float *out, int count)
{
    const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);
    if (i >= count) return;
    const student_t_shape *shape = i % 3 == 0   ? &student_t_gamma_3
                                   : i % 3 == 1 ? &student_t_gamma_1p65
                                                : &student_t_gamma_2;
    const enum student_t_masking masking = STUDENT_T_HEIGHT_CORRELATED;
    const float sigma[2] = {0.3f, 0.5f};
    float l[3], parts[3], averages[3];
    v += 3 * i;
    m += 3 * i;
    student_t_sample_visible_normal(shape, sigma, v, u + 2 * i, m);
    student_t_reflect(v, m, l);
    student_t_albedo_parts(shape, sigma, v, masking, parts);
    student_t_albedo_average_parts(shape, sigma, masking, averages);
    out[i] = student_t_d(shape, sigma, m) + student_t_lambda(shape, sigma, v) +
             student_t_g2(shape, sigma, v, l, masking) +
             student_t_visible_normal_pdf(shape, sigma, v, m) +
             student_t_reflection_pdf(shape, sigma, v, m) +
             student_t_reflection_weight(shape, sigma, v, l, masking) +
             student_t_albedo(shape, sigma, v, masking) +
             student_t_albedo_average(shape, sigma, masking) +
             student_t_compensation(shape, sigma, v, l, masking) + parts[1] + averages[2];
}

/* A copy of a family in managed or device memory, of student_t_family_bytes bytes; gamma and sigma
 * of each hit; tables of a dielectric in device memory, if there are any. */
extern "C" __global__ void materials(const student_t_family *family,
                                     const student_t_interface_table *glass, const float *hits,
                                     const float *v, const float *u, student_t_sample *samples,
                                     float *densities, int count)
{
    const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);
    if (i >= count) return;
    const float *hit = hits + 3 * i, *at = v + 3 * i, *number = u + 3 * i;
    const float base[3] = {0.5f, 0.4f, 0.3f};
    float f[3];
    student_t_lobe lobe;
    student_t_family_set_lobe(family, hit[0], hit[1], hit[2], &lobe);
    if (i % 3 == 0) {
        const student_t_conductor c = student_t_conductor_at(
            &lobe, &student_t_gold, STUDENT_T_HEIGHT_CORRELATED, STUDENT_T_KULLA_CONTY);
        samples[i] = student_t_conductor_sample(&c, at, number[0], number + 1);
        densities[i] = student_t_conductor_eval_pdf(&c, at, samples[i].l, f);
    } else if (i % 3 == 1) {
        const student_t_dielectric d =
            glass ? student_t_dielectric_compensated(&lobe, glass, STUDENT_T_KULLA_CONTY)
                  : student_t_dielectric_at(&lobe, 1.5f, STUDENT_T_HEIGHT_CORRELATED);
        samples[i] = student_t_dielectric_sample(&d, at, number[0], number + 1, STUDENT_T_RADIANCE);
        densities[i] =
            student_t_dielectric_eval_pdf(&d, at, samples[i].l, STUDENT_T_RADIANCE, f);
    } else if (glass) {
        const student_t_plastic p = student_t_plastic_at(&lobe, glass, base, STUDENT_T_TURQUIN);
        samples[i] = student_t_plastic_sample(&p, at, number[0], number + 1);
        densities[i] = student_t_plastic_eval_pdf(&p, at, samples[i].l, f);
    }
}

#ifndef __CUDACC_RTC__
#include <cstdio>

int main()
{
    const float sigma[2] = {0.3f, 0.3f}, v[3] = {0.6f, 0.0f, 0.8f}, u[2] = {0.2f, 0.7f};
    float m[3];
    student_t_sample_visible_normal(&student_t_gamma_3, sigma, v, u, m);
    std::printf("compiled by nvcc; a normal on the host: %.4f %.4f %.4f\n", m[0], m[1], m[2]);
    return 0;
}
#endif
