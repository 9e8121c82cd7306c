/* Every function in a kernel, and one on the host, where the program runs it. */
#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"

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
    student_t_albedo_parts(shape, sigma, v[2], masking, parts);
    student_t_albedo_average_parts(shape, sigma, masking, averages);
    out[i] = student_t_d(shape, sigma, m) + student_t_lambda(shape, sigma, v) +
             student_t_g2(shape, sigma, v, l, masking) +
             student_t_visible_normal_pdf(shape, sigma, v, m) +
             student_t_reflection_pdf(shape, sigma, v, m) +
             student_t_reflection_weight(shape, sigma, v, l, masking) +
             student_t_albedo(shape, sigma, v[2], masking) +
             student_t_albedo_average(shape, sigma, masking) +
             student_t_compensation(shape, sigma, v, l, masking) + parts[1] + averages[2];
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
