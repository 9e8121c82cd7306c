/* The functions of a family over arrays, compiled as C and as C++ under two prefixes. */
#include "prefix.h"
#include "student_t_family.h"

/* As `Hit` and `At` in Rust. */
typedef struct hit {
    float gamma, sigma[2], v[3], l[3], m[3], u[2];
} hit;

typedef struct at {
    float gamma, d, g1, lambda, pdf, reflection_pdf, normal[3];
    float g2[2], weight[2], f[2], f_pdf[2], albedo[2], average[2], parts[2][3], average_parts[2][3];
    float compensation[2], is_smooth;
} at;

EXPORT void NAME(family)(const void *bytes, unsigned size, size_t count, const hit *hits, at *all);

/* By the tables in the header, or by those at an address if it is not null. */
EXPORT void NAME(family)(const void *bytes, unsigned size, size_t count, const hit *hits, at *all)
{
    for (size_t i = 0; i < count; ++i) {
        const hit *h = &hits[i];
        at *a = &all[i];
        student_t_lobe lobe = student_t_lobe_at(h->gamma, h->sigma[0], h->sigma[1]);
        if (bytes) {
            const student_t_family *family = student_t_family_in(bytes, size);
            if (!family) return;
            lobe = student_t_family_lobe(family, h->gamma, h->sigma[0], h->sigma[1]);
        }
        a->gamma = lobe.gamma;
        a->d = student_t_lobe_d(&lobe, h->m);
        a->g1 = student_t_lobe_g1(&lobe, h->v);
        a->lambda = student_t_lobe_lambda(&lobe, h->v);
        a->pdf = student_t_lobe_visible_normal_pdf(&lobe, h->v, h->m);
        a->reflection_pdf = student_t_lobe_reflection_pdf(&lobe, h->v, h->m);
        a->is_smooth = student_t_effectively_smooth(&lobe) ? 1.0f : 0.0f;
        student_t_lobe_sample_visible_normal(&lobe, h->v, h->u, a->normal);
        for (int k = 0; k < 2; ++k) {
            const enum student_t_masking masking = (enum student_t_masking)k;
            a->g2[k] = student_t_lobe_g2(&lobe, h->v, h->l, masking);
            a->weight[k] = student_t_lobe_reflection_weight(&lobe, h->v, h->l, masking);
            a->f[k] = student_t_lobe_eval_pdf(&lobe, h->v, h->l, masking, &a->f_pdf[k]);
            a->albedo[k] = student_t_lobe_albedo(&lobe, h->v, masking);
            a->average[k] = student_t_lobe_albedo_average(&lobe, masking);
            student_t_lobe_albedo_parts(&lobe, h->v, masking, a->parts[k]);
            student_t_lobe_albedo_average_parts(&lobe, masking, a->average_parts[k]);
            a->compensation[k] = student_t_lobe_compensation(&lobe, h->v, h->l, masking);
        }
    }
}

/* Lights of a view along the normal; [count] numbers, and as many pairs and triples. */
EXPORT void NAME(prefilter)(size_t count, const float *u, const float *sigma, const float *gamma,
                            float *l, float *pdf);

EXPORT void NAME(prefilter)(size_t count, const float *u, const float *sigma, const float *gamma,
                            float *l, float *pdf)
{
    for (size_t i = 0; i < count; ++i)
        pdf[i] = student_t_prefilter_light(u + 2 * i, sigma[i], gamma[i], l + 3 * i);
}
