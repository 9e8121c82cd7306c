
/* ---- Light that is filtered in advance ---------------------------------------------------------
 * Real-time engines filter an environment for a roughness as it is reflected to a view along the
 * normal, v = l = n = (0, 0, 1). All normals are visible from there, and they have a closed form
 * for every gamma: no table is read. sigma and gamma are taken at the nearer end of [1e-8, 1e6] and
 * [1.501, infinity], NaN at the smallest. */

/* 1/(gamma - 1), and what stands for 0 in Beckmann's limit, to rounding. */
STUDENT_T_FUNCTION float student_t_impl_tail(float gamma)
{
    const float g = student_t_impl_max(gamma, 1.501f);
    return student_t_impl_max(1.0f / (g - 1.0f), 9.094947e-13f); /* 2^-40 */
}

/* D/4 by the square of a slope: the density D v.m of visible normals times that of reflection,
 * 1/(4 v.m). */
STUDENT_T_FUNCTION float student_t_impl_facing_pdf(float slope2, float sigma, float s)
{
    const float x = slope2 / sigma / sigma, power = -(1.0f + 1.0f / s) * log1pf(s * x);
    const float scale = (1.0f + slope2) / sigma;
    return student_t_impl_finite(scale * expf(power) * scale *
                                 (0.25f * STUDENT_T_IMPL_INVERSE_PI));
}

/* Draws a light l by two random numbers, and returns its density per steradian. It may be below
 * the horizon, where it is worth nothing. tan^2 theta_m = (gamma - 1) sigma^2
 * ((1 - u)^(-1/(gamma - 1)) - 1); for gamma = 2 that is GGX. */
STUDENT_T_FUNCTION float
student_t_prefilter_light(const float u[2], float sigma, float gamma, float l[3])
{
    const float s = student_t_impl_tail(gamma), roughness = student_t_impl_sigma(sigma);
    /* At u = 1 the normal would lie on the horizon, where D has a limit of its own. */
    const float number = student_t_impl_min(student_t_impl_unit(u[0]), 0.99999994f);
    const float growth = expm1f(-s * log1pf(-number)); /* with the digits of a small number */
    const float slope = roughness * sqrtf(growth / s), slope2 = slope * slope;
    const float secant2 = 1.0f + slope2;
    float x, y;
    student_t_impl_turn(student_t_impl_unit(u[1]), &y, &x);
    l[0] = 2.0f * slope / secant2 * x;
    l[1] = 2.0f * slope / secant2 * y;
    l[2] = (1.0f - slope2) / secant2;
    return student_t_impl_facing_pdf(slope2, roughness, s);
}

/* The density of a light by its cosine; 0 at and below the horizon. */
STUDENT_T_FUNCTION float student_t_prefilter_pdf(float cos_theta, float sigma, float gamma)
{
    const float z = student_t_impl_unit(cos_theta);
    if (!(cos_theta > 0.0f)) return 0.0f;
    return student_t_impl_facing_pdf((1.0f - z) / (1.0f + z), student_t_impl_sigma(sigma),
                                     student_t_impl_tail(gamma));
}
