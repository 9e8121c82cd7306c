/* A first lookup: reflects a view off a visible normal of the shape gamma = 3. */
#include <stdio.h>

#include "student_t_gamma_3.h"

int main(void)
{
    const student_t_shape *shape = &student_t_gamma_3;
    const enum student_t_masking masking = STUDENT_T_HEIGHT_CORRELATED;
    const float sigma[2] = {0.3f, 0.3f}, v[3] = {0.6f, 0.0f, 0.8f}, u[2] = {0.2f, 0.7f};
    float m[3], l[3];
    double weight, pdf;

    student_t_sample_visible_normal(shape, sigma, v, u, m);
    student_t_reflect(v, m, l);
    weight = (double)student_t_reflection_weight(shape, sigma, v, l, masking);
    pdf = (double)student_t_reflection_pdf(shape, sigma, v, m);
    printf("light %.4f %.4f %.4f, f cos / pdf %.4f, pdf %.4f per steradian\n", (double)l[0],
           (double)l[1], (double)l[2], weight, pdf);
    printf("of all light one bounce returns %.4f\n",
           (double)student_t_albedo(shape, sigma, v, masking));
    return 0;
}
