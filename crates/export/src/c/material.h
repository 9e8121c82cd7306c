/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * student_t_materials.h: whole materials of the lobes of student_t.h, made at every hit.
 *
 *     #include "student_t_gamma_3.h"
 *     #include "student_t_materials.h"
 *
 *     const student_t_lobe lobe = student_t_gamma_3_lobe(0.3f, 0.3f);
 *     const student_t_conductor gold = student_t_conductor_at(
 *         &lobe, &student_t_gold, STUDENT_T_HEIGHT_CORRELATED, STUDENT_T_KULLA_CONTY);
 *     const student_t_sample s = student_t_conductor_sample(&gold, v, choice, u);
 *     if (s.event == STUDENT_T_ABSORBED) return; // else the path goes on to s.l, times s.weight
 *     pdf = student_t_conductor_eval_pdf(&gold, v, l, f); // towards a lamp: f[CHANNELS]
 *
 * Conventions are those of the Rust crate microfacet-sampler. Directions are unit vectors in the
 * tangent frame, n = +z; view v and light l both point away from the surface. f is without the
 * cosine, per steradian. The weight of a sample is f |cos theta_l|/pdf, computed without dividing,
 * so that it stays finite where f and the density do not. Densities are per steradian of l, of all
 * that is drawn but deltas. A lobe that is effectively smooth (student_t_effectively_smooth) is a
 * mirror, which is a delta: its f and density are 0, and only samples return its light. A direction
 * in the surface, or with NaN among its coordinates, neither sends nor gets light. All results are
 * finite.
 *
 * choice and u[2] are three random numbers in [0, 1], ends included; others are taken at the nearer
 * end, NaN at 0. choice chooses among parts of a material, u the direction, so that a stratified u
 * stays stratified.
 */
#ifndef STUDENT_T_MATERIALS_H
#define STUDENT_T_MATERIALS_H

#include "student_t.h"

#if STUDENT_T_LAYOUT != 4
#error "student_t.h is of another version than student_t_materials.h: export both again"
#endif

/* The channels of weights and reflectances; define it beforehand to have another number. */
#ifndef STUDENT_T_CHANNELS
#define STUDENT_T_CHANNELS 3
#endif

/* How the light that one bounce loses to further ones is returned: not at all, by a factor on the
 * lobe (Turquin 2019; not reciprocal), or by a lobe of its own (Kulla & Conty 2017). */
enum student_t_compensation_form {
    STUDENT_T_SINGLE_BOUNCE = 0,
    STUDENT_T_TURQUIN = 1,
    STUDENT_T_KULLA_CONTY = 2
};

/* What is transported along a path: refraction scales radiance by (n_v/n_l)^2, and importance, or
 * photons, not. */
enum student_t_transport { STUDENT_T_RADIANCE = 0, STUDENT_T_IMPORTANCE = 1 };

/* What a sample is; the path of one that is absorbed ends with the weight 0. */
enum student_t_event {
    STUDENT_T_ABSORBED = 0,
    STUDENT_T_REFLECTED = 1,
    STUDENT_T_TRANSMITTED = 2
};

/* A sampled light. */
typedef struct student_t_sample {
    enum student_t_event event;
    int is_delta; /* evaluation gives 0 for a delta: a mirror's, and what steep facets refract */
    float l[3];   /* the light, of unit length, away from the surface */
    float m[3];   /* the normal of its facet; n for a mirror, and halfway for further bounces */
    float weight[STUDENT_T_CHANNELS]; /* f |cos|/pdf */
    float pdf;    /* per steradian; 0 for a delta */
    float eta;    /* index on the side of l over that on the side of the view; 1 if reflected */
} student_t_sample;

/* No light: a sample that ends its path. */
STUDENT_T_FUNCTION student_t_sample student_t_impl_absorbed(void)
{
    student_t_sample s;
    int i;
    s.event = STUDENT_T_ABSORBED;
    s.is_delta = 0;
    s.l[0] = s.l[1] = s.l[2] = 0.0f;
    s.m[0] = s.m[1] = s.m[2] = 0.0f;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) s.weight[i] = 0.0f;
    s.pdf = 0.0f;
    s.eta = 1.0f;
    return s;
}

STUDENT_T_FUNCTION float student_t_impl_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether all coordinates are finite, and their squares. */
STUDENT_T_FUNCTION int student_t_impl_is_direction(const float w[3])
{
    return student_t_impl_dot(w, w) <= STUDENT_T_LARGEST;
}

/* w to length 1, or null where its square is not a positive number of single precision. */
STUDENT_T_FUNCTION void student_t_impl_normalize(float w[3])
{
    const float length2 = student_t_impl_dot(w, w);
    const float r =
        length2 > 0.0f && length2 <= STUDENT_T_LARGEST ? 1.0f / sqrtf(length2) : 0.0f;
    w[0] *= r;
    w[1] *= r;
    w[2] *= r;
}

/* A direction above the horizon by the square of its cosine and a turn. */
STUDENT_T_FUNCTION void student_t_impl_upward(float square, float turn, float l[3])
{
    const float r = sqrtf(1.0f - square);
    float sine, cosine;
    student_t_impl_turn(student_t_impl_unit(turn), &sine, &cosine);
    l[0] = r * cosine;
    l[1] = r * sine;
    l[2] = sqrtf(square);
}

/* A choice in [0, 1), NaN as 0: 1 would choose a part of probability 0. */
STUDENT_T_FUNCTION float student_t_impl_choice(float choice)
{
    return student_t_impl_min(student_t_impl_max(choice, 0.0f), 0.99999994f);
}

/* What facets of reflectance 1 send from a view to a light. */
typedef struct student_t_impl_white {
    float cosine; /* v.m, at which facets have their reflectance */
    float weight; /* G2(v, l)/G1(v) */
    float pdf;    /* per steradian of l */
} student_t_impl_white;

/* Towards a given light, both above the horizon; m is v + l. Directions that are NaN or infinite
 * get nothing. */
STUDENT_T_FUNCTION student_t_impl_white
student_t_impl_halfway(const student_t_lobe *lobe, enum student_t_masking masking, const float v[3],
                       const float l[3], float m[3])
{
    student_t_impl_white white = {0.0f, 0.0f, 0.0f};
    student_t_impl_facet facet;
    float length2;
    m[0] = v[0] + l[0];
    m[1] = v[1] + l[1];
    m[2] = v[2] + l[2];
    length2 = student_t_impl_dot(m, m);
    if (!(length2 > 0.0f && length2 <= STUDENT_T_LARGEST)) return white;
    facet = student_t_impl_facet_of(lobe, v, m, length2, l, masking);
    white.cosine = 0.5f * sqrtf(length2); /* v.m = 1 + v.l = |m|^2/2 */
    white.weight = facet.weight;
    white.pdf = 0.25f * facet.density;
    return white;
}

/* Off a facet drawn for a view from above; returns 0 where the light is not above. */
STUDENT_T_FUNCTION int student_t_impl_draw(const student_t_lobe *lobe,
                                           enum student_t_masking masking, const float v[3],
                                           const float u[2], float m[3], float l[3],
                                           student_t_impl_white *white)
{
    student_t_impl_facet facet;
    student_t_lobe_sample_visible_normal(lobe, v, u, m);
    white->cosine = student_t_impl_dot(v, m);
    student_t_reflect(v, m, l);
    if (!(white->cosine > 0.0f && l[2] > 0.0f)) return 0;
    facet = student_t_impl_facet_of(lobe, v, m, 1.0f, l, masking);
    white->weight = facet.weight;
    white->pdf = 0.25f * facet.density;
    return 1;
}

/* f of a part of a material from its weight and its density, both alone, and 1/|cos theta_l|, which
 * is finite. */
STUDENT_T_FUNCTION float student_t_impl_f(float weight, float pdf, float inverse)
{
    return student_t_impl_finite(weight * pdf * inverse);
}

STUDENT_T_FUNCTION float student_t_impl_inverse_cosine(float cosine)
{
    return student_t_impl_finite(1.0f / fabsf(cosine));
}

/* What the weights f |cos|/pdf of two parts are multiplied by in that of a light drawn from both,
 * of which the first is drawn with probability p. Densities are divided by their sum first, so that
 * nothing overflows. Where p is 1 there is no second part. */
STUDENT_T_FUNCTION void student_t_impl_mixing(float p, const float pdf[2], float shares[2])
{
    const float sum = pdf[0] + pdf[1], a = pdf[0] / sum, b = pdf[1] / sum;
    const float whole = p * a + (1.0f - p) * b;
    shares[0] = p < 1.0f ? 0.0f : 1.0f;
    shares[1] = 0.0f;
    if (p < 1.0f && sum > 0.0f) {
        shares[0] = a / whole;
        shares[1] = b / whole;
    }
}
