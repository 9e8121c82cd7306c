/* Gold whose gamma and sigma are those of a hit, compiled as C and as C++ under two prefixes. */
#include "prefix.h"
#include "student_t_family.h"
#include "student_t_materials.h"

/* As `Light` in picture.rs. */
typedef struct light {
    float l[3], weight[3], pdf;
    int event, is_delta;
} light;

EXPORT void NAME(gold_sample)(float gamma, float sigma, const float v[3], float choice,
                              const float u[2], light *sampled);
EXPORT void NAME(gold_eval)(float gamma, float sigma, const float v[3], const float l[3],
                            float f[3], float *pdf);

static void gold_at(float gamma, float sigma, student_t_lobe *lobe, student_t_conductor *gold)
{
    student_t_set_lobe(gamma, sigma, sigma, lobe);
    *gold = student_t_conductor_at(lobe, &student_t_gold, STUDENT_T_HEIGHT_CORRELATED,
                                   STUDENT_T_KULLA_CONTY);
}

EXPORT void NAME(gold_sample)(float gamma, float sigma, const float v[3], float choice,
                              const float u[2], light *sampled)
{
    student_t_lobe lobe;
    student_t_conductor gold;
    student_t_sample s;
    gold_at(gamma, sigma, &lobe, &gold);
    s = student_t_conductor_sample(&gold, v, choice, u);
    for (int k = 0; k < 3; ++k) {
        sampled->l[k] = s.l[k];
        sampled->weight[k] = s.weight[k];
    }
    sampled->pdf = s.pdf;
    sampled->event = (int)s.event;
    sampled->is_delta = s.is_delta;
}

EXPORT void NAME(gold_eval)(float gamma, float sigma, const float v[3], const float l[3],
                            float f[3], float *pdf)
{
    student_t_lobe lobe;
    student_t_conductor gold;
    gold_at(gamma, sigma, &lobe, &gold);
    *pdf = student_t_conductor_eval_pdf(&gold, v, l, f);
}
