/* A highlight with haze and retroreflection, as an engine writes it from two conductors of a hit:
 * with the weights w and r,
 *
 *     f(v, l) = (1 - r) f'(v, l) + r f'(Rv, l),    f' = (1 - w) f_core + w f_haze,
 *
 * where R turns by half a turn about n. This is the mixture of BRDFs of OpenPBR 1.2, and reciprocal
 * since f'(Rv, Rl) = f'(v, l). The program checks that samples go where their density says, with
 * the weights f cos/pdf, that f is reciprocal, that retroreflection sends light back to the view,
 * and that a white pair with compensation returns all light. Exit status 1 if something does not
 * hold. */
#include <math.h>
#include <stdio.h>

#include "student_t_gamma_1p65.h"
#include "student_t_gamma_2.h"
#include "student_t_gamma_3.h"
#include "student_t_materials.h"

/* A pair at a hit: the conductors point to their lobes, which live as long. */
typedef struct pair {
    student_t_conductor core, haze;
    float weight, retroreflection; /* w and r, both in [0, 1] */
} pair;

/* f by channel, without the cosine; returns the density of samples. */
static float pair_eval_pdf(const pair *p, const float v[3], const float l[3], float f[3])
{
    float pdf = 0.0f;
    f[0] = f[1] = f[2] = 0.0f;
    for (int i = 0; i < 4; ++i) {
        const float turn = i / 2 ? -1.0f : 1.0f;
        const float view[3] = {turn * v[0], turn * v[1], v[2]};
        const float share = (i / 2 ? p->retroreflection : 1.0f - p->retroreflection) *
                            (i % 2 ? p->weight : 1.0f - p->weight);
        float part[3];
        if (!(share > 0.0f)) continue;
        pdf += share * student_t_conductor_eval_pdf(i % 2 ? &p->haze : &p->core, view, l, part);
        for (int k = 0; k < 3; ++k) f[k] += share * part[k];
    }
    return pdf;
}

/* Whether the first of two parts is chosen, of probability p, and the choice that is left. */
static int chosen(float *choice, float p)
{
    const int first = *choice < p;
    *choice = first ? *choice / p : (*choice - p) / (1.0f - p);
    return first;
}

/* One of the four parts is drawn, and weighted by all: their densities overlap. A mirror's light is
 * of its part alone. The facet s.m is the drawn part's, of the view turned for retroreflection. */
static student_t_sample pair_sample(const pair *p, const float v[3], float choice, const float u[2])
{
    const float turn = chosen(&choice, p->retroreflection) ? -1.0f : 1.0f;
    const student_t_conductor *part = chosen(&choice, p->weight) ? &p->haze : &p->core;
    const float view[3] = {turn * v[0], turn * v[1], v[2]};
    student_t_sample s = student_t_conductor_sample(part, view, choice, u);
    if (s.event == STUDENT_T_REFLECTED && !s.is_delta) {
        float f[3];
        s.pdf = pair_eval_pdf(p, v, s.l, f);
        for (int k = 0; k < 3; ++k) s.weight[k] = s.pdf > 0.0f ? f[k] * s.l[2] / s.pdf : 0.0f;
    }
    return s;
}

/* The place of a lattice of irrational steps in the unit cube. */
static float place(long i, double step)
{
    const double x = (double)i * step + 0.5;
    return (float)(x - floor(x));
}

enum { PARTS = 4 };

/* Quarters of the hemisphere: towards the view or away, near the normal or near the horizon. */
static int quarter(const float l[3]) { return (l[0] > 0.0f ? 1 : 0) + (l[2] > 0.7f ? 2 : 0); }

/* The largest difference, over quarters, between shares and mean weights of samples and the
 * integrals of the density and of f cos; *all is the mean weight of all samples. */
static double sampling_off(const pair *p, const float v[3], double *all)
{
    const long count = 262144;
    const int rows = 512;
    double drawn[PARTS] = {0.0}, weights[PARTS] = {0.0}, worst = 0.0;
    double densities[PARTS] = {0.0}, values[PARTS] = {0.0};
    *all = 0.0;
    for (long i = 0; i < count; ++i) {
        const float u[2] = {place(i, 0.6710436067037893), place(i, 0.5497004779019703)};
        const student_t_sample s = pair_sample(p, v, place(i, 0.8191725133961645), u);
        *all += (double)s.weight[0] / (double)count;
        if (s.event != STUDENT_T_REFLECTED || s.is_delta) continue;
        drawn[quarter(s.l)] += 1.0 / (double)count;
        weights[quarter(s.l)] += (double)s.weight[0] / (double)count;
    }
    for (int i = 0; i < rows * rows; ++i) {
        const float z = ((float)(i / rows) + 0.5f) / (float)rows;
        const float phi = ((float)(i % rows) + 0.5f) * 6.2831853f / (float)rows;
        const float s = sqrtf(1.0f - z * z), l[3] = {s * cosf(phi), s * sinf(phi), z};
        float f[3];
        const double cell = 6.283185307179586 / rows / rows;
        densities[quarter(l)] += cell * (double)pair_eval_pdf(p, v, l, f);
        values[quarter(l)] += cell * (double)(f[0] * l[2]);
    }
    for (int i = 0; i < PARTS; ++i) {
        worst = fmax(worst, fabs(drawn[i] - densities[i]));
        worst = fmax(worst, fabs(weights[i] - values[i]));
    }
    return worst;
}

/* The largest difference of f between a view and a light exchanged, relative to f. */
static double reciprocity_off(const pair *p)
{
    double worst = 0.0;
    for (long i = 0; i < 1000; ++i) {
        float w[2][3], there[3], back[3];
        for (int k = 0; k < 2; ++k) {
            const float z = 0.02f + 0.98f * place(i + 1000 * k, 0.7548776662466927);
            const float phi = 6.2831853f * place(i + 1000 * k, 0.5698402909980532);
            w[k][0] = sqrtf(1.0f - z * z) * cosf(phi);
            w[k][1] = sqrtf(1.0f - z * z) * sinf(phi);
            w[k][2] = z;
        }
        pair_eval_pdf(p, w[0], w[1], there);
        pair_eval_pdf(p, w[1], w[0], back);
        worst = fmax(worst, (double)fabsf(there[0] - back[0]) / fmax((double)there[0], 1e-6));
    }
    return worst;
}

/* Light goes back to the view with retroreflection as it goes on to the mirror image without. */
static int goes_back(pair p)
{
    const float v[3] = {0.36f, 0.48f, 0.8f}, image[3] = {-0.36f, -0.48f, 0.8f};
    float back[3], on[3];
    p.retroreflection = 1.0f;
    pair_eval_pdf(&p, v, v, back);
    p.retroreflection = 0.0f;
    pair_eval_pdf(&p, v, image, on);
    return back[0] == on[0] && back[0] > 0.0f;
}

int main(void)
{
    const float white[3] = {1.0f, 1.0f, 1.0f};
    const student_t_reflectance mirror = student_t_schlick(white, white);
    const float cosines[] = {0.1f, 0.6f, 1.0f}, shares[] = {0.0f, 0.4f, 1.0f};
    double sampling = 0.0, exchanged = 0.0, furnace = 0.0;
    int back = 1;
    for (int i = 0; i < 27; ++i) {
        const float z = cosines[i % 3], v[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        /* Of the second core the roughness differs along x and y; that of the third is a mirror. */
        const student_t_lobe lobes[4] = {student_t_lobe_of(&student_t_gamma_2, 0.1f, 0.1f),
                                         student_t_lobe_of(&student_t_gamma_3, 0.1f, 0.3f),
                                         student_t_lobe_of(&student_t_gamma_3, 0.0f, 0.0f),
                                         student_t_lobe_of(&student_t_gamma_1p65, 0.4f, 0.4f)};
        const int core = i / 9;
        const enum student_t_compensation_form form =
            core == 1 ? STUDENT_T_SINGLE_BOUNCE : STUDENT_T_KULLA_CONTY;
        const pair p = {
            student_t_conductor_at(&lobes[core], &mirror, STUDENT_T_HEIGHT_CORRELATED, form),
            student_t_conductor_at(&lobes[3], &mirror, STUDENT_T_HEIGHT_CORRELATED, form),
            shares[i / 3 % 3], shares[(i + i / 3) % 3]};
        double all;
        sampling = fmax(sampling, sampling_off(&p, v, &all));
        exchanged = fmax(exchanged, reciprocity_off(&p));
        if (p.weight > 0.0f) back = back && goes_back(p);
        if (form == STUDENT_T_KULLA_CONTY) furnace = fmax(furnace, fabs(all - 1.0));
    }
    printf("haze and retroreflection: samples of 27 pairs against their density and f to %.1e, of "
           "2e-3 allowed; v and l exchanged %.1e, of 1e-4; white pairs return all light to %.1e, "
           "of 3e-3\n",
           sampling, exchanged, furnace);
    if (!back) printf("retroreflection does not send light back to the view\n");
    return back && sampling <= 2e-3 && exchanged <= 1e-4 && furnace <= 3e-3 ? 0 : 1;
}
