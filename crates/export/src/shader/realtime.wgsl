// Texels of both textures along gamma, of that of albedos along sigma and along the view, and of
// that of masking along the view.
const STUDENT_T_GAMMAS = 32.0;
const STUDENT_T_SIGMAS = 32.0;
const STUDENT_T_VIEWS = 48.0;
const STUDENT_T_VIEWS_OF_MASKING = 64.0;

// ---- Surfaces -----------------------------------------------------------------------------------

// A material at a hit, made once and handed to the functions. sigma, in [1e-4, 1e4], is for users.
struct StudentTSurface {
    sigma: vec2f,
    s: f32,       // 1/(gamma - 1)
    power: f32,   // 2 - gamma
    peak: f32,    // 1/(pi sigma_x sigma_y)
    kappa: f32,   // of the coordinate of masking
    stretch: f32, // that of the albedo's, times the roughness of the round stand-in
    rows: vec2f,  // where the textures have sigma and gamma
}

// Where a texture of n texels has a coordinate in [0, 1]: its texels reach the ends.
fn student_t_impl_texel(x: f32, n: f32) -> f32 {
    return 0.5 / n + (1.0 - 1.0 / n) * x;
}

fn student_t_surface(gamma: f32, sigma: vec2f) -> StudentTSurface {
    let heavy = 1.0 / (2.0 * clamp(gamma, 1.6, 1e6) - 3.0);
    let a = clamp(sigma, vec2f(1e-4), vec2f(1e4));
    let kappa = 0.5 + 0.5 * heavy;
    let area = a.x * a.y;
    let stand_in = sqrt(area);
    // Below its limit D is Beckmann's to 1e-3 of its peak.
    let s = max(2.0 * heavy / (1.0 + heavy), 5e-4);
    // 1/log2(1 + 17/(2 * 1.6 - 3)).
    let shape = 0.1556114 * log2(1.0 + 17.0 * heavy);
    return StudentTSurface(
        a,
        s,
        1.0 - 1.0 / s,
        0.31830989 / area,
        kappa,
        (kappa + 2.5) * stand_in,
        vec2f(
            student_t_impl_texel(sqrt(min(stand_in, 1.0)), STUDENT_T_SIGMAS),
            student_t_impl_texel(shape, STUDENT_T_GAMMAS),
        ),
    );
}

// ---- D, masking, one bounce ---------------------------------------------------------------------

// Normal distribution function D(m).
fn student_t_surface_d(surface: StudentTSurface, m: vec3f) -> f32 {
    let x = m.xy / surface.sigma;
    let square = max(m.z * m.z, 1e-24);
    let b = square + surface.s * dot(x, x);
    // (1 + s tan^2 theta/sigma^2)^(2 - gamma).
    let tail = exp2(surface.power * log2(b / square));
    return select(0.0, surface.peak, m.z > 0.0) / (b * b) * tail;
}

// Where the texture of masking has a direction.
fn student_t_surface_masking_at(surface: StudentTSurface, w: vec3f) -> vec2f {
    let c = max(w.z, 0.0);
    let q = c / (c + surface.kappa * length(surface.sigma * w.xy));
    return vec2f(student_t_impl_texel(q, STUDENT_T_VIEWS_OF_MASKING), surface.rows.y);
}

// The projected area of all facets that are turned towards w, of those over a unit of the surface:
// (w.n)(1 + lambda(w)) = (w.n)/G1(w). `texel` is what the texture of masking has there.
fn student_t_surface_area(surface: StudentTSurface, w: vec3f, texel: f32) -> f32 {
    let c = max(w.z, 0.0);
    let simple = c + surface.kappa * length(surface.sigma * w.xy);
    return simple * (0.75 + texel);
}

// f cos theta of one bounce with F = 1, by the areas of v and of l: D G2/(4 v.n), with
// height-correlated masking. No light comes from below the horizon; a view there is one along it.
fn student_t_surface_eval(
    surface: StudentTSurface,
    v: vec3f,
    l: vec3f,
    m: vec3f,
    area_v: f32,
    area_l: f32,
) -> f32 {
    let d = student_t_surface_d(surface, m);
    let cos_v = max(v.z, 0.0);
    let cos_l = max(l.z, 0.0);
    let both = cos_l * area_v + cos_v * (area_l - cos_l);
    return 0.25 * d * cos_l / max(both, 1e-20);
}

// The density of l where visible normals are sampled: D G1(v)/(4 v.n).
fn student_t_surface_pdf(surface: StudentTSurface, m: vec3f, area_v: f32) -> f32 {
    return 0.25 * student_t_surface_d(surface, m) / area_v;
}

// ---- Reflectance --------------------------------------------------------------------------------

// (1 - c)^5 of Schlick's reflectance, and c (1 - c)^6 over its peak, at 1/7.
fn student_t_impl_weights(c: f32) -> vec2f {
    let k = 1.0 - c;
    let fourth = (k * k) * (k * k);
    return vec2f(fourth * k, 17.651384 * c * fourth * (k * k));
}

// What OpenPBR's tint of a metal, its reflectance at 82 degrees over that of Schlick's with F90 of
// 1, takes away from it at that peak.
fn student_t_impl_untinted(f0: vec3f, tint: vec3f) -> vec3f {
    return (1.0 - tint) * (f0 + (1.0 - f0) * 0.46266437);
}

// Schlick's reflectance.
fn student_t_schlick(f0: vec3f, f90: f32, cos_theta: f32) -> vec3f {
    return f0 + (f90 - f0) * student_t_impl_weights(cos_theta).x;
}

fn student_t_schlick_average(f0: vec3f, f90: f32) -> vec3f {
    return f0 + (f90 - f0) * (1.0 / 21.0);
}

// The reflectance of a metal by F0 and by that tint.
fn student_t_f82_tint(f0: vec3f, tint: vec3f, cos_theta: f32) -> vec3f {
    let w = student_t_impl_weights(cos_theta);
    let raw = f0 + (1.0 - f0) * w.x - student_t_impl_untinted(f0, tint) * w.y;
    return max(raw, vec3f(0.0));
}

fn student_t_f82_tint_average(f0: vec3f, tint: vec3f) -> vec3f {
    return student_t_schlick_average(f0, 1.0) - 0.14009036 * student_t_impl_untinted(f0, tint);
}

// ---- Albedos and further bounces ----------------------------------------------------------------

// Where the texture of albedos has a direction. Of what it has there the square of the first is
// 1 - E, and that of the last 1 - E_avg.
fn student_t_surface_albedo_at(surface: StudentTSurface, cos_theta: f32) -> vec3f {
    let c = clamp(cos_theta, 1e-12, 1.0);
    let x = c / (c + surface.stretch * sqrt(1.0 - c * c));
    return vec3f(student_t_impl_texel(sqrt(sqrt(x)), STUDENT_T_VIEWS), surface.rows);
}

// E, bias and F82 of a texel: beside what is stored, E has the share of a mirror.
fn student_t_impl_of_texel(texel: vec4f, cos_theta: f32) -> vec3f {
    let e = 1.0 - texel.x * texel.x;
    let w = e * student_t_impl_weights(clamp(cos_theta, 0.0, 1.0));
    return vec3f(e, clamp(texel.y + w.x, 0.0, e), max(texel.z + w.y, 0.0));
}

// The directional albedo of one bounce under Schlick's reflectance.
fn student_t_schlick_albedo(texel: vec4f, f0: vec3f, f90: f32, cos_theta: f32) -> vec3f {
    let moments = student_t_impl_of_texel(texel, cos_theta);
    return f0 * moments.x + (f90 - f0) * moments.y;
}

// The same of a metal with a tint.
fn student_t_f82_tint_albedo(texel: vec4f, f0: vec3f, tint: vec3f, cos_theta: f32) -> vec3f {
    let dip = student_t_impl_untinted(f0, tint) * student_t_impl_of_texel(texel, cos_theta).z;
    return student_t_schlick_albedo(texel, f0, 1.0, cos_theta) - dip;
}

// f of all bounces after the first, without the cosine (Kulla & Conty 2017): `view` is what the
// texture of albedos has for v, `light` its first number for l, and `average` that of the
// reflectance.
fn student_t_further_bounces(view: vec4f, light: f32, average: vec3f) -> vec3f {
    let lost = view.w * view.w;
    let tint = average * average * (1.0 - lost) / (1.0 - average * lost);
    let both = view.x * light / max(view.w, 1e-4);
    return tint * (0.31830989 * both * both);
}

// The factor of one bounce in place of it, for the price of no fetch at all (Turquin 2019): exact
// for the light that a white metal returns, of which f then is not reciprocal.
fn student_t_scaled_bounce(view: vec4f, f0: vec3f) -> vec3f {
    let lost = view.x * view.x;
    return 1.0 + f0 * (lost / (1.0 - lost));
}
