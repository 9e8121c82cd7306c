/* Dielectrics of exported shapes over arrays, compiled as C and as C++ under two prefixes. */
#include "prefix.h"
#include "student_t_materials.h"

#include "indices.h"
#include "shapes.h"

/* As `Query` and `Found` in Rust. */
typedef struct query {
    float sigma[2], eta, v[3], l[3], choice, u[2];
    int masking, transport;
} query;

typedef struct found {
    int event, is_delta;
    float l[3], m[3], weight[STUDENT_T_CHANNELS], pdf, eta;
    float f[3][STUDENT_T_CHANNELS], density[3]; /* towards the light of the query, back from it to
                                                 * its view, and towards the sampled light */
} found;

/* Of one bounce with `table` < 0, else by a table. */
EXPORT void NAME(dielectric)(size_t shape, int table, int compensation, size_t count,
                             const query *queries, found *all);
EXPORT void NAME(plastic)(size_t shape, int table, int compensation, const float *base,
                          size_t count, const query *queries, found *all);

static const student_t_shape *const shapes[] = SHAPES;
static const student_t_interface_table *const indices[] = INDICES;
static const enum student_t_compensation_form forms[] = {
    STUDENT_T_SINGLE_BOUNCE, STUDENT_T_TURQUIN, STUDENT_T_KULLA_CONTY};

static void take(found *a, const student_t_sample *s)
{
    a->event = s->event;
    a->is_delta = s->is_delta;
    a->pdf = s->pdf;
    a->eta = s->eta;
    for (int k = 0; k < 3; ++k) {
        a->l[k] = s->l[k];
        a->m[k] = s->m[k];
        a->weight[k] = s->weight[k];
    }
}

EXPORT void NAME(plastic)(size_t shape, int table, int compensation, const float *base,
                          size_t count, const query *queries, found *all)
{
    for (size_t i = 0; i < count; ++i) {
        const query *q = &queries[i];
        found *a = &all[i];
        const student_t_lobe lobe = student_t_lobe_of(shapes[shape], q->sigma[0], q->sigma[1]);
        const student_t_plastic p =
            student_t_plastic_at(&lobe, indices[table], base, forms[compensation]);
        const student_t_sample s = student_t_plastic_sample(&p, q->v, q->choice, q->u);
        take(a, &s);
        a->density[0] = student_t_plastic_eval_pdf(&p, q->v, q->l, a->f[0]);
        a->density[1] = student_t_plastic_eval_pdf(&p, q->l, q->v, a->f[1]);
        a->density[2] = student_t_plastic_eval_pdf(&p, q->v, s.l, a->f[2]);
    }
}

EXPORT void NAME(dielectric)(size_t shape, int table, int compensation, size_t count,
                             const query *queries, found *all)
{
    for (size_t i = 0; i < count; ++i) {
        const query *q = &queries[i];
        found *a = &all[i];
        const student_t_lobe lobe = student_t_lobe_of(shapes[shape], q->sigma[0], q->sigma[1]);
        const enum student_t_transport transport =
            q->transport ? STUDENT_T_IMPORTANCE : STUDENT_T_RADIANCE;
        const enum student_t_masking masking =
            q->masking ? STUDENT_T_HEIGHT_CORRELATED : STUDENT_T_UNCORRELATED;
        const student_t_dielectric d =
            table < 0 ? student_t_dielectric_at(&lobe, q->eta, masking)
                      : student_t_dielectric_compensated(&lobe, indices[table],
                                                         forms[compensation]);
        const student_t_sample s =
            student_t_dielectric_sample(&d, q->v, q->choice, q->u, transport);
        take(a, &s);
        a->density[0] = student_t_dielectric_eval_pdf(&d, q->v, q->l, transport, a->f[0]);
        a->density[1] = student_t_dielectric_eval_pdf(&d, q->l, q->v, transport, a->f[1]);
        a->density[2] = student_t_dielectric_eval_pdf(&d, q->v, s.l, transport, a->f[2]);
    }
}
