/* The functions of exported shapes over arrays, compiled as C and as C++ under two prefixes. */
#include "prefix.h"
#include "shapes.h"

/* As `Point` and `Answer` in Rust. */
typedef struct point {
    float sigma[2], v[3], l[3], m[3], u[2];
} point;

typedef struct answer {
    float d, g1, lambda, pdf, reflection_pdf, normal[3], light[3];
    float g2[2], weight[2], compensation[2]; /* by masking, as what follows */
    float albedo[2], average[2], parts[2][3], average_parts[2][3];
} answer;

EXPORT void NAME(answer)(size_t shape, size_t count, const point *points, answer *answers);
EXPORT void NAME(sample)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                         const float (*u)[2], float (*m)[3]);
EXPORT void NAME(g1)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                     float *g1);
EXPORT void NAME(compensation)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                               const float (*l)[3], float *lobe);

static const student_t_shape *const shapes[] = SHAPES;

EXPORT void NAME(answer)(size_t shape, size_t count, const point *points, answer *answers)
{
    const student_t_shape *const s = shapes[shape];
    for (size_t i = 0; i < count; ++i) {
        const point *p = &points[i];
        answer *a = &answers[i];
        a->d = student_t_d(s, p->sigma, p->m);
        a->g1 = student_t_g1(s, p->sigma, p->v);
        a->lambda = student_t_lambda(s, p->sigma, p->v);
        a->pdf = student_t_visible_normal_pdf(s, p->sigma, p->v, p->m);
        a->reflection_pdf = student_t_reflection_pdf(s, p->sigma, p->v, p->m);
        student_t_sample_visible_normal(s, p->sigma, p->v, p->u, a->normal);
        student_t_reflect(p->v, p->m, a->light);
        for (int k = 0; k < 2; ++k) {
            const enum student_t_masking masking = (enum student_t_masking)k;
            a->g2[k] = student_t_g2(s, p->sigma, p->v, p->l, masking);
            a->weight[k] = student_t_reflection_weight(s, p->sigma, p->v, p->l, masking);
            a->compensation[k] = student_t_compensation(s, p->sigma, p->v, p->l, masking);
            a->albedo[k] = student_t_albedo(s, p->sigma, p->v, masking);
            a->average[k] = student_t_albedo_average(s, p->sigma, masking);
            student_t_albedo_parts(s, p->sigma, p->v, masking, a->parts[k]);
            student_t_albedo_average_parts(s, p->sigma, masking, a->average_parts[k]);
        }
    }
}

EXPORT void NAME(sample)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                         const float (*u)[2], float (*m)[3])
{
    for (size_t i = 0; i < count; ++i)
        student_t_sample_visible_normal(shapes[shape], sigma, v[i], u[i], m[i]);
}

EXPORT void NAME(g1)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                     float *g1)
{
    for (size_t i = 0; i < count; ++i) g1[i] = student_t_g1(shapes[shape], sigma, v[i]);
}

EXPORT void NAME(compensation)(size_t shape, const float *sigma, size_t count, const float (*v)[3],
                               const float (*l)[3], float *lobe)
{
    for (size_t i = 0; i < count; ++i)
        lobe[i] = student_t_compensation(shapes[shape], sigma, v[i], l[i],
                                         STUDENT_T_HEIGHT_CORRELATED);
}
