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

fn student_t_impl_stretched(sigma: vec2f, w: vec3f) -> StudentTImplDirection {
    let rough = vec2f(student_t_impl_sigma(sigma.x), student_t_impl_sigma(sigma.y));
    return student_t_impl_stretch(rough, w);
}

// 1/(area of the microsurface seen from a direction) = G1/z, finite at grazing.
fn student_t_impl_inverse_area(shape: StudentTShape, d: StudentTImplDirection) -> f32 {
    if shape.is_ggx > 0.0 {
        let tall = d.z + sqrt(d.square + d.z * d.z);
        return 2.0 / student_t_impl_max(tall, STUDENT_T_IMPL_SMALLEST);
    }
    let across = shape.kappa * d.rho;
    let area = student_t_impl_max(d.z + across, 1e-30); // less than any has
    let r = shape.masking_cells / area;
    var at = d.z * r;
    if shape.masking_crowded > 0.0 {
        at = (1.0 - sqrt(student_t_impl_unit(across / area))) * shape.masking_cells;
    }
    let place = student_t_impl_place(at, shape.masking_cells);
    return student_t_impl_cubic(shape.masking, place) * r;
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

fn student_t_impl_d(shape: StudentTShape, sigma: vec2f, m: vec3f) -> f32 {
    let rough = vec2f(student_t_impl_sigma(sigma.x), student_t_impl_sigma(sigma.y));
    let slope = m.xy / rough;
    let square = m.z * m.z;
    let part = shape.d_s * (slope.x * slope.x + slope.y * slope.y);
    if !(m.z > 0.0 && part >= 0.0) {
        return 0.0;
    }
    // The root of pi sigma_x sigma_y D = b^-gamma z^(2 gamma - 4).
    let b = student_t_impl_max(square + part, STUDENT_T_IMPL_SMALLEST);
    var root = 1.0 / b;
    if !(shape.is_ggx > 0.0) {
        // ln(b/z^2), where z^2 may underflow.
        var growth = log(b) - 2.0 * log(m.z);
        if part < 1e3 * square {
            growth = student_t_impl_log_growth(part / square);
        }
        root = root * exp(shape.d_power * growth);
    }
    // The root of D, at most that of the largest number. Roots above 1e30 give that for every
    // scale, which is at least 5e-7.
    let scale = sqrt(1.0 / (3.14159265 * rough.x * rough.y));
    let limited = min(scale * min(root, 1e30), 1.8446742e19);
    return limited * limited;
}

// Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m.
fn student_t_d(shape: u32, sigma: vec2f, m: vec3f) -> f32 {
    return student_t_impl_d(student_t_impl_shape(shape), sigma, m);
}

fn student_t_impl_masking(shape: StudentTShape, sigma: vec2f, w: vec3f) -> f32 {
    let d = student_t_impl_stretched(sigma, w);
    return student_t_impl_min(d.z * student_t_impl_inverse_area(shape, d), 1.0);
}

// Smith's masking G1(w) in [0, 1].
fn student_t_masking(shape: u32, sigma: vec2f, w: vec3f) -> f32 {
    return student_t_impl_masking(student_t_impl_shape(shape), sigma, w);
}

// Smith's lambda(w) = 1/G1 - 1; at and below the horizon, where that is infinite, 8.5e37. Its
// absolute error is that of G1.
fn student_t_lambda(shape: u32, sigma: vec2f, w: vec3f) -> f32 {
    let masking = student_t_impl_masking(student_t_impl_shape(shape), sigma, w);
    return 1.0 / student_t_impl_max(masking, STUDENT_T_IMPL_SMALLEST) - 1.0;
}

// Masking and shadowing G2 of view and light.
fn student_t_masking_shadowing(
    shape: u32,
    sigma: vec2f,
    v: vec3f,
    l: vec3f,
    masking: u32,
) -> f32 {
    let lobe = student_t_impl_shape(shape);
    let a = student_t_impl_masking(lobe, sigma, v);
    let b = student_t_impl_masking(lobe, sigma, l);
    let both = a * b;
    let sum = a + b - both;
    if masking == STUDENT_T_UNCORRELATED || !(sum > 0.0) {
        return both;
    }
    return both / sum;
}

// The weight f cos/pdf of a light reflected off a sampled visible normal, without Fresnel:
// G2(v, l)/G1(v) in [0, 1].
fn student_t_reflection_weight(
    shape: u32,
    sigma: vec2f,
    v: vec3f,
    l: vec3f,
    masking: u32,
) -> f32 {
    let lobe = student_t_impl_shape(shape);
    let b = student_t_impl_masking(lobe, sigma, l);
    if !(v.z > 0.0 && b > 0.0) {
        return 0.0;
    }
    let both = b + student_t_impl_masking(lobe, sigma, v) * (1.0 - b);
    return b / select(both, 1.0, masking == STUDENT_T_UNCORRELATED);
}
