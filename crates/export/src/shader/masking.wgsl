// ---- Directions ---------------------------------------------------------------------------------

// A direction with its horizontal part times sigma.
struct StudentTImplDirection {
    xy: vec2f,  // horizontal part, scaled to the length 1 where it is short
    frame: f32, // and its length
    rho: f32,   // length of the horizontal part, and vertical part, >= 0, not both 0
    z: f32,
    square: f32, // the square of rho, before the root
}

fn student_t_impl_stretch(sigma: vec2f, w: vec3f) -> StudentTImplDirection {
    let z = student_t_impl_unit(w.z);
    let xy = sigma * w.xy;
    let square = xy.x * xy.x + xy.y * xy.y;
    let rho = sqrt(square);
    // Below the one, squares of normals would leave single precision, below the other that of rho.
    if rho >= 1e-6 {
        return StudentTImplDirection(xy, rho, rho, z, square);
    } else if rho >= 1e-18 {
        return StudentTImplDirection(xy / rho, 1.0, rho, z, square);
    }
    // Upright; straight down, null or NaN: at the horizon, else the square of z would vanish.
    let up = select(0.0, 1.0, z > 0.0);
    return StudentTImplDirection(vec2f(1.0, 0.0), 1.0, 1.0 - up, up, 1.0 - up);
}

// 1/(area of the microsurface seen from a direction) = G1/z, finite at grazing.
fn student_t_impl_inverse_area(lobe: StudentTLobe, d: StudentTImplDirection) -> f32 {
    if lobe.is_ggx > 0.0 {
        let tall = d.z + sqrt(d.square + d.z * d.z);
        return 2.0 / student_t_impl_max(tall, STUDENT_T_IMPL_SMALLEST);
    }
    let across = lobe.kappa * d.rho;
    let area = student_t_impl_max(d.z + across, 1e-30); // less than any has
    let r = lobe.masking_cells / area;
    var at = d.z * r;
    if lobe.masking_crowded > 0.0 {
        at = (1.0 - sqrt(student_t_impl_unit(across / area))) * lobe.masking_cells;
    }
    return student_t_impl_masking_at(lobe, student_t_impl_place(at, lobe.masking_cells)) * r;
}

fn student_t_impl_dot(a: vec3f, b: vec3f) -> f32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// A normal, normalised and raised to the least cosine, which keeps D finite; z times shrink.
fn student_t_impl_raise(m: vec3f, shrink: f32) -> vec3f {
    let r = 1.0 / sqrt(m.x * m.x + m.z * m.z + m.y * m.y);
    return vec3f(m.x * r, m.y * r, student_t_impl_max(m.z * r * shrink, 1e-18));
}

// Turns a normal that rounding has put behind the silhouette back onto it.
fn student_t_impl_face(v: vec3f, m: vec3f) -> vec3f {
    let facing = student_t_impl_dot(v, m);
    if facing < 0.0 {
        let square = student_t_impl_max(student_t_impl_dot(v, v), STUDENT_T_IMPL_SMALLEST);
        return student_t_impl_raise(m - (facing / square) * v, 1.0);
    }
    return m;
}

// ---- Normals and masking ------------------------------------------------------------------------

// D of a normal of any length, whose square is given.
fn student_t_impl_d(lobe: StudentTLobe, m: vec3f, length_square: f32) -> f32 {
    let slope = m.xy / lobe.sigma;
    let square = m.z * m.z;
    let part = lobe.d_s * (slope.x * slope.x + slope.y * slope.y);
    if !(m.z > 0.0 && part >= 0.0) {
        return 0.0;
    }
    // The root of pi sigma_x sigma_y D = b^-gamma z^(2 gamma - 4), for a normal of length 1.
    let b = student_t_impl_max(square + part, STUDENT_T_IMPL_SMALLEST);
    var root = length_square / b;
    if !(lobe.is_ggx > 0.0) {
        // ln(b/z^2), where z^2 may underflow.
        var growth = log(b) - 2.0 * log(m.z);
        if part < 1e3 * square {
            growth = student_t_impl_log_growth(part / square);
        }
        root = root * exp(lobe.d_power * growth);
    }
    // The root of D, at most that of the largest number. Roots above 1e30 give that for every
    // scale, which is at least 5e-7.
    let scale = sqrt(1.0 / (3.14159265 * lobe.sigma.x * lobe.sigma.y));
    let limited = min(scale * min(root, 1e30), 1.8446742e19);
    return limited * limited;
}

// Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m.
fn student_t_lobe_d(lobe: StudentTLobe, m: vec3f) -> f32 {
    return student_t_impl_d(lobe, m, 1.0);
}

// Smith's masking G1(w) in [0, 1].
fn student_t_lobe_masking(lobe: StudentTLobe, w: vec3f) -> f32 {
    let d = student_t_impl_stretch(lobe.sigma, w);
    return student_t_impl_min(d.z * student_t_impl_inverse_area(lobe, d), 1.0);
}

// Smith's lambda(w) = 1/G1 - 1; at and below the horizon, where that is infinite, 8.5e37. Its
// absolute error is that of G1.
fn student_t_lobe_lambda(lobe: StudentTLobe, w: vec3f) -> f32 {
    let masking = student_t_lobe_masking(lobe, w);
    return 1.0 / student_t_impl_max(masking, STUDENT_T_IMPL_SMALLEST) - 1.0;
}

// Masking and shadowing G2 of view and light.
fn student_t_lobe_masking_shadowing(
    lobe: StudentTLobe,
    v: vec3f,
    l: vec3f,
    masking: u32,
) -> f32 {
    let a = student_t_lobe_masking(lobe, v);
    let b = student_t_lobe_masking(lobe, l);
    let both = a * b;
    let sum = a + b - both;
    if masking == STUDENT_T_UNCORRELATED || !(sum > 0.0) {
        return both;
    }
    return both / sum;
}

// G2/G1(v) of the G1 of a view above the horizon and that of a light.
fn student_t_impl_weight(a: f32, b: f32, masking: u32) -> f32 {
    if !(b > 0.0) {
        return 0.0;
    }
    if masking == STUDENT_T_UNCORRELATED {
        return b;
    }
    return b / (b + a * (1.0 - b));
}

// The weight f cos/pdf of a light reflected off a sampled visible normal, without Fresnel:
// G2(v, l)/G1(v) in [0, 1].
fn student_t_lobe_reflection_weight(
    lobe: StudentTLobe,
    v: vec3f,
    l: vec3f,
    masking: u32,
) -> f32 {
    if !(v.z > 0.0) {
        return 0.0;
    }
    let a = student_t_lobe_masking(lobe, v);
    return student_t_impl_weight(a, student_t_lobe_masking(lobe, l), masking);
}

// f without the cosine, D G2/(4 (v.n) (l.n)), for facets that reflect all light, and the density
// with which visible normals reflect v to l, with one D for both. Both are 0 where v or l is not
// above the horizon.
fn student_t_lobe_eval_pdf(lobe: StudentTLobe, v: vec3f, l: vec3f, masking: u32) -> vec2f {
    if !(v.z > 0.0 && l.z > 0.0) {
        return vec2f(0.0);
    }
    let both = v + l;
    let m = vec3f(both.xy, max(both.z, 7.666467e-20)); // 2^-63.5, to which squares are told apart
    let d = student_t_impl_stretch(lobe.sigma, v);
    let inverse = student_t_impl_inverse_area(lobe, d);
    let a = student_t_impl_min(d.z * inverse, 1.0);
    let weight = student_t_impl_weight(a, student_t_lobe_masking(lobe, l), masking);
    let density = 0.25 * student_t_impl_d(lobe, m, student_t_impl_dot(m, m));
    let pdf = student_t_impl_product(density, inverse);
    return vec2f(student_t_impl_product(weight * pdf, 1.0 / max(l.z, 1e-37)), pdf);
}

// Whether a lobe is so narrow that its surface is better rendered as a mirror: whether the mean
// absolute slope along the rougher direction is below 1e-3, and at most 2.5e-3 are masked at the
// cosine 0.01. That is sigma below 1e-3 for gamma >= 2, 4e-4 for 1.8, 6e-5 for 1.6, 2e-5 for 1.55,
// and 2e-7 for 1.501.
fn student_t_effectively_smooth(lobe: StudentTLobe) -> bool {
    let sigma = max(lobe.sigma.x, lobe.sigma.y);
    if !(0.56 * sigma < 1e-3) { // no gamma has a smaller mean than 0.56 sigma
        return false;
    }
    let level = StudentTImplDirection(vec2f(0.0), 1.0, 1.0, 0.0, 1.0);
    let mean = 2.0 / student_t_impl_inverse_area(lobe, level);
    let rho = 0.99995 * sigma;
    let grazing = StudentTImplDirection(vec2f(0.0), 1.0, rho, 0.01, rho * rho);
    return sigma * mean < 1e-3
        && 1.0 - 0.01 * student_t_impl_inverse_area(lobe, grazing) <= 2.5e-3;
}
