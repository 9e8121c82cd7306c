// ---- Light that is filtered in advance ----------------------------------------------------------
// Engines filter an environment for a roughness as it is reflected to a view along the normal,
// v = l = n = (0, 0, 1). All normals are visible from there, and they have a closed form for every
// gamma: no table is read. sigma and gamma are taken at the nearer end of [1e-8, 1e6] and
// [1.501, 1e12], which is Beckmann to rounding.

// 1/(gamma - 1).
fn student_t_impl_tail(gamma: f32) -> f32 {
    return 1.0 / (student_t_impl_min(student_t_impl_max(gamma, 1.501), 1e12) - 1.0);
}

// D/4 by the square of a slope: the density D v.m of visible normals times that of reflection,
// 1/(4 v.m).
fn student_t_impl_facing_pdf(slope2: f32, sigma: f32, s: f32) -> f32 {
    let x = slope2 / sigma / sigma;
    let power = exp(-(1.0 + 1.0 / s) * student_t_impl_log_growth(s * x));
    let scale = (1.0 + slope2) / sigma;
    let root = student_t_impl_product(power * scale, scale);
    return student_t_impl_product(root, 0.07957747);
}

// Draws a light by two random numbers; w is its density per steradian. It may be below the
// horizon, where it is worth nothing. tan^2 theta_m = (gamma - 1) sigma^2
// ((1 - u)^(-1/(gamma - 1)) - 1); for gamma = 2 that is GGX.
fn student_t_prefilter_light(u: vec2f, sigma: f32, gamma: f32) -> vec4f {
    let s = student_t_impl_tail(gamma);
    let roughness = student_t_impl_sigma(sigma);
    // At u = 1 the normal would lie on the horizon, where D has a limit of its own.
    let number = student_t_impl_min(student_t_impl_unit(u.x), 0.99999994);
    let growth = student_t_impl_exp_growth(-s * student_t_impl_log_growth(-number));
    let slope = roughness * sqrt(growth / s);
    let slope_2 = slope * slope;
    let secant_2 = 1.0 + slope_2;
    let sine = 2.0 * slope / secant_2;
    let turn = student_t_impl_turn(student_t_impl_unit(u.y));
    let pdf = student_t_impl_facing_pdf(slope_2, roughness, s);
    return vec4f(sine * turn, (1.0 - slope_2) / secant_2, pdf);
}

// The density of a light by its cosine; 0 at and below the horizon.
fn student_t_prefilter_pdf(cos_theta: f32, sigma: f32, gamma: f32) -> f32 {
    let z = student_t_impl_unit(cos_theta);
    if !(cos_theta > 0.0) {
        return 0.0;
    }
    let s = student_t_impl_tail(gamma);
    return student_t_impl_facing_pdf((1.0 - z) / (1.0 + z), student_t_impl_sigma(sigma), s);
}
