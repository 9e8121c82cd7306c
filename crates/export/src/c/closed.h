/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * The Student-t lobe of any shape gamma and roughness sigma without tables: D in closed form, and
 * masking and the albedo by fitted forms. Their errors are in docs/shaders.md, "Without tables";
 * their numbers come from the study `closed_forms`, which checks that they are these. The same as
 * shader/closed.wgsl.
 *
 * gamma >= 1.501 (1.6 of the albedo), infinity for Beckmann; directions are unit vectors in the
 * tangent frame, n = +z. What is outside, and NaN, is taken as an end of the domain.
 */
#ifndef STUDENT_T_CLOSED_H
#define STUDENT_T_CLOSED_H

#include <math.h>

static inline float student_t_closed_between(float x, float low, float high)
{
    const float raised = x > low ? x : low;
    return raised < high ? raised : high;
}

/* Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m. At most 3.4e38, where
 * that of gamma < 2 has no limit, at the horizon. */
static inline float student_t_closed_d(float gamma, const float sigma[2], const float m[3])
{
    /* From 1e12 on the tails are those of infinity in single precision. */
    const float s = 1.0f / (student_t_closed_between(gamma, 1.501f, 1e12f) - 1.0f);
    const float sigma_x = student_t_closed_between(sigma[0], 1e-8f, 1e6f);
    const float sigma_y = student_t_closed_between(sigma[1], 1e-8f, 1e6f);
    const float x = m[0] / sigma_x, y = m[1] / sigma_y;
    const float z = student_t_closed_between(m[2], 1e-18f, 1.0f);
    const float square = z * z, part = s * (x * x + y * y), b = square + part;
    /* ln(1 + s tan^2 theta/sigma^2). */
    const float growth =
        part < 1e3f * square ? log1pf(part / square) : logf(b) - 2.0f * logf(z);
    /* The root, since D itself may overflow; 0.318 is 1/pi. */
    const float root =
        student_t_closed_between(expf(0.5f * (1.0f - 1.0f / s) * growth) / b, 0.0f, 1e30f);
    const float scale = sqrtf(0.31830989f / (sigma_x * sigma_y));
    const float limited = student_t_closed_between(scale * root, 0.0f, 1.8446742e19f);
    return m[2] > 0.0f ? limited * limited : 0.0f;
}

/* Smith's masking G1(w) in [0, 1]. */
static inline float student_t_closed_masking(float gamma, const float sigma[2], const float w[3])
{
    const float s = 1.0f / (student_t_closed_between(gamma, 1.501f, 1e8f) - 1.0f);
    const float x = student_t_closed_between(sigma[0], 1e-8f, 1e6f) * w[0];
    const float y = student_t_closed_between(sigma[1], 1e-8f, 1e6f) * w[1];
    const float t = sqrtf(x * x + y * y);
    const float c = student_t_closed_between(w[2], 0.0f, 1.0f);
    const float kept = c * (t * t * t * (0.900976f + s * (-0.3294384f + s * -0.06063415f)) + c *
        (t * t * (0.73478705f + s * s * (0.19656047f + s * -0.19010077f)) + c * (t * (0.3181425f
        + s * (1.0f + s * (-0.8340435f + s * 0.1272497f))) + c * (0.7100118f + s * (-0.9514865f
        + s * (0.42692533f + s * -0.06434248f))))));
    const float lost = t * t * t * t * 0.25513962f + c * (t * t * t * (-0.2620338f + s *
        (0.30578956f + s * (0.07146245f + s * 0.0050674235f))) + c * (t * t * (0.081733085f + s
        * (-0.14887473f + s * (0.061250158f + s * 0.0416899f))) + c * t * (-0.007247091f + s *
        0.007205088f)));
    const float whole = kept + lost;
    if (!(c > 0.0f && whole > 0.0f)) return 0.0f;
    return student_t_closed_between(kept / whole, 0.0f, 1.0f);
}

/* The directional albedo E under F = 1 and height-correlated masking, of sigma <= 1, gamma >= 1.6
 * and cos_theta >= 0.02. */
static inline float student_t_closed_albedo(float gamma, float sigma, float cos_theta)
{
    const float s = 1.0f / (student_t_closed_between(gamma, 1.6f, 1e8f) - 1.0f);
    const float a = student_t_closed_between(sigma, 0.0f, 1.0f);
    const float mu = student_t_closed_between(cos_theta, 0.02f, 1.0f);
    const float rho = sqrtf(mu * mu + a * a * (1.0f - mu * mu));
    const float kept = 3.3654305e-7f + mu * mu * s * (-0.09420322f + s * 0.07624671f) + rho * mu
        * (0.3136148f + s * -0.21505563f + mu * mu * (0.008847785f + s * -0.0085968515f)) + a *
        (mu * (-0.41565076f + s * (0.6868197f + s * -0.24298689f) + mu * (-0.36321938f + s * s *
        -0.01832113f + mu * 0.19258222f)) + rho * (s * (-0.30483145f + s * 0.15806481f) + mu *
        (s * 0.22335671f + mu * -0.16841589f)) + a * (0.81271976f + s * (-0.6325105f + s *
        0.11692543f) + mu * (-0.08764364f + mu * 0.14287566f) + rho * (s * (0.41321215f + s *
        -0.17670779f) + mu * s * -0.14536925f) + a * (s * -0.08421658f + mu * (-0.07464519f + s
        * 0.1499401f) + rho * (-0.15545358f + s * 0.11274045f) + a * s * -0.028787045f)));
    const float lost = a * (s * (0.00015906361f + s * -9.568802e-5f) + mu * (0.1657434f + s *
        (-0.14260508f + s * 0.027638914f) + mu * (s * (1.0f + s * -0.41001305f) + mu *
        -0.016347516f)) + rho * (-0.21144181f + s * (0.19568871f + s * -0.039693512f) + mu * s *
        (-0.94561666f + s * 0.38031635f)) + a * (0.2156763f + s * (-0.21259208f + s *
        0.0487627f) + mu * (-0.021495936f + s * (0.6353526f + s * -0.107600436f) + mu *
        (-0.050729755f + s * -0.8439411f)) + rho * (s * (-0.7352435f + s * 0.15004599f) + mu *
        (0.16557738f + s * 0.8293655f)) + a * (s * (0.72921944f + s * -0.13085781f) + mu * s *
        -0.24984965f + rho * -0.59916604f + a * 0.59606653f)));
    return student_t_closed_between(kept / (kept + lost), 0.0f, 1.0f);
}

#endif
