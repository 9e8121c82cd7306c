/* Times a lobe of one shape and of a family against GGX by the formulas of pbrt-v4, and E against a
 * bilinear lookup in a texture; in turns, in one thread. Prints ratios; nothing is judged. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "student_t_family.h"
#include "student_t_gamma_2p7.h"

enum { COUNT = 4096, TURNS = 400, TEXELS = 64 };
static const enum student_t_masking MASKING = STUDENT_T_HEIGHT_CORRELATED;

/* The hits, and what is found of them; not static, so that no compiler leaves it out. */
float v[COUNT][3], l[COUNT][3], m[COUNT][3], u[COUNT][2], gammas[COUNT], sigmas[COUNT];
float out[COUNT], pdf[COUNT], texels[TEXELS][TEXELS], roughness = 0.3f;

/* ---- GGX, Walter et al. 2007 and Heitz 2018, in the functions and by the angles of pbrt-v4 -- */

static float square(float x) { return x * x; }

static float tan2(const float w[3])
{
    return student_t_impl_max(0.0f, 1.0f - square(w[2])) / square(w[2]);
}

/* cos^2 and sin^2 of the azimuth, over the squares of the roughness. */
static float over_roughness(const float w[3], float at_pole)
{
    const float sine = sqrtf(student_t_impl_max(0.0f, 1.0f - square(w[2])));
    const float x = sine > 0.0f ? w[0] / sine : 1.0f, y = sine > 0.0f ? w[1] / sine : 0.0f;
    return at_pole * (square(x / roughness) + square(y / roughness));
}

static float ggx_d(const float w[3])
{
    const float tangent = tan2(w), e = over_roughness(w, tangent);
    if (!(tangent < 1e30f)) return 0.0f;
    return 1.0f / (3.14159265f * roughness * roughness * square(square(w[2])) * square(1.0f + e));
}

static float ggx_lambda(const float w[3])
{
    const float tangent = tan2(w);
    if (!(tangent < 1e30f)) return 0.0f;
    return 0.5f * (sqrtf(1.0f + roughness * roughness * tangent) - 1.0f);
}

static int half_vector(const float a[3], const float b[3], float w[3])
{
    float length;
    int i;
    for (i = 0; i < 3; ++i) w[i] = a[i] + b[i];
    length = sqrtf(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (i = 0; i < 3; ++i) w[i] /= length;
    return a[2] > 0.0f && b[2] > 0.0f;
}

static float ggx_f(const float a[3], const float b[3])
{
    float w[3];
    if (!half_vector(a, b, w)) return 0.0f;
    return ggx_d(w) / (1.0f + ggx_lambda(a) + ggx_lambda(b)) / (4.0f * a[2] * b[2]);
}

static float ggx_pdf(const float a[3], const float b[3])
{
    float w[3], facing;
    if (!half_vector(a, b, w)) return 0.0f;
    facing = fabsf(a[0] * w[0] + a[1] * w[1] + a[2] * w[2]);
    return 1.0f / (1.0f + ggx_lambda(a)) / a[2] * ggx_d(w) * facing / (4.0f * facing);
}

/* Both with one D. */
static float ggx_eval_pdf(const float a[3], const float b[3], float *density)
{
    float w[3], d, lambda;
    *density = 0.0f;
    if (!half_vector(a, b, w)) return 0.0f;
    d = ggx_d(w);
    lambda = ggx_lambda(a);
    *density = d / (1.0f + lambda) / (4.0f * a[2]);
    return d / (1.0f + lambda + ggx_lambda(b)) / (4.0f * a[2] * b[2]);
}

static void ggx_sample(const float w[3], const float number[2], float normal[3])
{
    float h[3] = {roughness * w[0], roughness * w[1], w[2]}, t[3] = {1.0f, 0.0f, 0.0f}, b[3];
    float x, y, z, r;
    int i;
    r = 1.0f / sqrtf(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (i = 0; i < 3; ++i) h[i] *= r;
    if (h[2] < 0.99999f) {
        r = 1.0f / sqrtf(h[0] * h[0] + h[1] * h[1]);
        t[0] = -h[1] * r;
        t[1] = h[0] * r;
    }
    b[0] = h[1] * t[2] - h[2] * t[1];
    b[1] = h[2] * t[0] - h[0] * t[2];
    b[2] = h[0] * t[1] - h[1] * t[0];
    r = sqrtf(number[0]);
    x = r * cosf(6.2831853f * number[1]);
    y = r * sinf(6.2831853f * number[1]);
    z = 0.5f * (1.0f + h[2]);
    y = (1.0f - z) * sqrtf(1.0f - x * x) + z * y;
    z = sqrtf(student_t_impl_max(0.0f, 1.0f - x * x - y * y));
    for (i = 0; i < 3; ++i) normal[i] = x * t[i] + y * b[i] + z * h[i];
    normal[0] *= roughness;
    normal[1] *= roughness;
    normal[2] = student_t_impl_max(1e-6f, normal[2]);
    r = 1.0f / sqrtf(square(normal[0]) + square(normal[1]) + square(normal[2]));
    for (i = 0; i < 3; ++i) normal[i] *= r;
}

/* ---- What is timed, over all hits ------------------------------------------------------------ */

static student_t_lobe one; /* of gamma = 2.7 */

static void rival_two(int i)
{
    out[i] = ggx_f(v[i], l[i]);
    pdf[i] = ggx_pdf(v[i], l[i]);
}
static void rival_one(int i) { out[i] = ggx_eval_pdf(v[i], l[i], &pdf[i]); }
static void shape_eval(int i)
{
    out[i] = student_t_lobe_eval_pdf(&one, v[i], l[i], MASKING, &pdf[i]);
}
static void family_eval(int i)
{
    student_t_lobe lobe;
    student_t_set_lobe(gammas[i], roughness, roughness, &lobe);
    out[i] = student_t_lobe_eval_pdf(&lobe, v[i], l[i], MASKING, &pdf[i]);
}
static void rival_sample(int i) { ggx_sample(v[i], u[i], m[i]); }
static void shape_sample(int i) { student_t_lobe_sample_visible_normal(&one, v[i], u[i], m[i]); }
static void family_sample(int i)
{
    student_t_lobe lobe;
    student_t_set_lobe(gammas[i], roughness, roughness, &lobe);
    student_t_lobe_sample_visible_normal(&lobe, v[i], u[i], m[i]);
}
static void bilinear(int i)
{
    const float x = v[i][2] * (TEXELS - 1.001f), y = sigmas[i] * (TEXELS - 1.001f);
    const int a = (int)x, b = (int)y;
    const float s = x - (float)a, t = y - (float)b;
    const float p = texels[b][a] + s * (texels[b][a + 1] - texels[b][a]);
    const float q = texels[b + 1][a] + s * (texels[b + 1][a + 1] - texels[b + 1][a]);
    out[i] = p + t * (q - p);
}
static void shape_albedo(int i)
{
    const student_t_lobe lobe = student_t_gamma_2p7_lobe(sigmas[i], sigmas[i]);
    out[i] = student_t_lobe_albedo(&lobe, v[i], MASKING);
}
static void family_albedo(int i)
{
    student_t_lobe lobe;
    student_t_set_lobe(gammas[i], sigmas[i], sigmas[i], &lobe);
    out[i] = student_t_lobe_albedo(&lobe, v[i], MASKING);
}

/* The loop is inlined for each, as a renderer's would be. */
#define TIMED(function)                                                                           \
    do {                                                                                          \
        struct timespec from, to;                                                                 \
        double ns;                                                                                \
        int hit;                                                                                  \
        timespec_get(&from, TIME_UTC);                                                            \
        for (hit = 0; hit < COUNT; ++hit) function(hit);                                          \
        timespec_get(&to, TIME_UTC);                                                              \
        ns = ((double)(to.tv_sec - from.tv_sec) * 1e9 + (double)(to.tv_nsec - from.tv_nsec)) /    \
             COUNT;                                                                               \
        if (turn == 0 || ns < best[k]) best[k] = ns;                                              \
        ++k;                                                                                      \
    } while (0)

static float number(void) { return ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f); }

static void direction(float w[3])
{
    const float z = 0.001f + 0.998f * number(), turn = 6.2831853f * number();
    w[0] = sqrtf(1.0f - z * z) * cosf(turn);
    w[1] = sqrtf(1.0f - z * z) * sinf(turn);
    w[2] = z;
}

int main(void)
{
    double best[10] = {0.0};
    int i, turn;
    one = student_t_gamma_2p7_lobe(roughness, roughness);
    for (i = 0; i < COUNT; ++i) {
        direction(v[i]);
        direction(l[i]);
        u[i][0] = number();
        u[i][1] = number();
        gammas[i] = 1.8f + 6.0f * number();
        sigmas[i] = 0.999f * number();
    }
    for (i = 0; i < TEXELS * TEXELS; ++i) texels[i / TEXELS][i % TEXELS] = number();
    for (turn = 0; turn < TURNS; ++turn) {
        int k = 0;
        TIMED(rival_two);
        TIMED(rival_one);
        TIMED(shape_eval);
        TIMED(family_eval);
        TIMED(rival_sample);
        TIMED(shape_sample);
        TIMED(family_sample);
        TIMED(bilinear);
        TIMED(shape_albedo);
        TIMED(family_albedo);
    }
    printf("f and density: GGX %.1f ns in two functions, %.1f with one D; gamma 2.7 %.1f (%.2f and "
           "%.2f of it), family %.1f (%.2f, %.2f)\n",
           best[0], best[1], best[2], best[2] / best[0], best[2] / best[1], best[3],
           best[3] / best[0], best[3] / best[1]);
    printf("a visible normal: GGX %.1f ns; gamma 2.7 %.1f (%.2f), family %.1f (%.2f)\n", best[4],
           best[5], best[5] / best[4], best[6], best[6] / best[4]);
    printf("E: bilinear lookup %.1f ns; gamma 2.7, exact %.1f (%.1f), family %.1f (%.1f)\n",
           best[7], best[8], best[8] / best[7], best[9], best[9] / best[7]);
    return 0;
}
