// How masking of the view and shadowing of the light are combined: as G1(v) G1(l), or as
// 1/(1 + lambda(v) + lambda(l)), the form of renderers (Heitz 2014, eq. 99,
// https://jcgt.org/published/0003/02/03/).
const STUDENT_T_UNCORRELATED = 0u;
const STUDENT_T_HEIGHT_CORRELATED = 1u;

// ---- Numbers ------------------------------------------------------------------------------------
// No result overflows, since a shader may take what has for anything. Comparisons are written so
// that NaN takes the second value, as far as a compiler cares.

const STUDENT_T_IMPL_LARGEST = 3.402823e38; // or so: compilers warn of the very largest
const STUDENT_T_IMPL_SMALLEST = 1.17549435e-38;

fn student_t_impl_max(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

fn student_t_impl_min(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

// x in [0, 1], and 0 for NaN.
fn student_t_impl_unit(x: f32) -> f32 {
    return student_t_impl_min(student_t_impl_max(x, 0.0), 1.0);
}

// The product of two numbers >= 0, at most the largest finite one.
fn student_t_impl_product(a: f32, b: f32) -> f32 {
    if b > 1.0 && a > STUDENT_T_IMPL_LARGEST / b {
        return STUDENT_T_IMPL_LARGEST;
    }
    return a * b;
}

fn student_t_impl_sigma(sigma: f32) -> f32 {
    return student_t_impl_min(student_t_impl_max(sigma, 1e-8), 1e6);
}

// ln(1 + x) for x > -1 with the digits of a small x, which log(1 + x) loses, and for which shaders
// promise few of log(x) about x = 1: the series of the inverse hyperbolic tangent.
fn student_t_impl_log_growth(x: f32) -> f32 {
    if !(x >= -0.5 && x <= 1.0) {
        return log(1.0 + x);
    }
    let y = x / (2.0 + x);
    let q = y * y;
    let tail = q * (1.0 / 9.0 + q * (1.0 / 11.0 + q * (1.0 / 13.0 + q * (1.0 / 15.0))));
    return 2.0 * y * (1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + tail))));
}

// ln x for x > 0.
fn student_t_impl_log(x: f32) -> f32 {
    if x >= 0.5 && x <= 2.0 {
        return student_t_impl_log_growth(x - 1.0);
    }
    return log(x);
}

// exp(x) - 1 with the digits of a small x.
fn student_t_impl_exp_growth(x: f32) -> f32 {
    if abs(x) > 0.5 {
        return exp(x) - 1.0;
    }
    let tail = 1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0 + x * (1.0 / 40320.0)));
    return x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * tail))));
}

// A place among cells: one of them, and the position in it.
struct StudentTImplPlace {
    cell: u32,
    position: f32,
}

// The place of x in [0, last]; at the end, the cell after the last.
fn student_t_impl_place(x: f32, last: f32) -> StudentTImplPlace {
    let cell = min(u32(x), u32(last));
    return StudentTImplPlace(cell, x - f32(cell));
}

// The cubic through value and slope at both ends of a cell.
fn student_t_impl_hermite(a: vec2f, b: vec2f, w: f32) -> f32 {
    let value_a = 1.0 + w * (w * (w * 2.0 - 3.0));
    let slope_a = w * (1.0 + w * (w - 2.0));
    let value_b = w * (w * (3.0 - w * 2.0));
    let slope_b = w * (w * (w - 1.0));
    return (a.x * value_a + b.x * value_b) + (a.y * slope_a + b.y * slope_b);
}
