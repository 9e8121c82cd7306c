/* Conductors of exported shapes over arrays, compiled as C and as C++ under two prefixes. */
#include "prefix.h"
#include "shapes.h"
#include "student_t_materials.h"

/* As `Point` and `Answer` in conductors.rs. */
typedef struct conductor_point {
    float sigma[2], v[3], l[3], choice, u[2], a[3], b[3];
    int form, masking, compensation;
} conductor_point;

typedef struct conductor_answer {
    int event, is_delta;
    float light[3], normal[3], weight[3], pdf, eta;
    float f[3], density;                 /* towards l */
    float sampled_f[3], sampled_density; /* towards the light of the sample */
    float average[3];
} conductor_answer;

EXPORT void NAME(conductors)(size_t shape, size_t count, const conductor_point *points,
                             conductor_answer *answers);

static const student_t_shape *const shapes[] = SHAPES;

EXPORT void NAME(conductors)(size_t shape, size_t count, const conductor_point *points,
                             conductor_answer *answers)
{
    for (size_t i = 0; i < count; ++i) {
        const conductor_point *p = &points[i];
        conductor_answer *a = &answers[i];
        const student_t_lobe lobe = student_t_lobe_of(shapes[shape], p->sigma[0], p->sigma[1]);
        const float one[3] = {1.0f, 1.0f, 1.0f};
        const student_t_reflectance r = p->form == 0   ? student_t_schlick(p->a, one)
                                        : p->form == 1 ? student_t_f82(p->a, p->b)
                                                       : student_t_eta_k(p->a, p->b);
        const student_t_conductor c =
            student_t_conductor_at(&lobe, &r, (enum student_t_masking)p->masking,
                                   (enum student_t_compensation_form)p->compensation);
        const student_t_sample s = student_t_conductor_sample(&c, p->v, p->choice, p->u);
        a->event = (int)s.event;
        a->is_delta = s.is_delta;
        for (int k = 0; k < 3; ++k) {
            a->light[k] = s.l[k];
            a->normal[k] = s.m[k];
            a->weight[k] = s.weight[k];
            a->average[k] = r.average[k];
        }
        a->pdf = s.pdf;
        a->eta = s.eta;
        a->density = student_t_conductor_eval_pdf(&c, p->v, p->l, a->f);
        a->sampled_density = student_t_conductor_eval_pdf(&c, p->v, s.l, a->sampled_f);
    }
}
