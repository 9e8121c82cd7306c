// ---- Albedos of every gamma ---------------------------------------------------------------------
// Splines over sigma, gamma and view: quadratic, quadratic and cubic.

// Coefficients along gamma and along the view.
const STUDENT_T_IMPL_SHAPES = 37u;
const STUDENT_T_IMPL_VIEWS = 29u;

// Three coefficients, from the first on.
struct StudentTImplThree {
    start: u32,
    weights: vec3f,
}

// One lobe's albedos, or those of its round stand-in.
struct StudentTImplAlbedo {
    volume: u32,     // where the head has them
    sigma: f32,      // 0: a mirror
    less: f32,       // 2 gamma - 3
    coordinate: f32, // of averages, among their nodes
    by_shape: StudentTImplThree,
    by_sigma: StudentTImplThree,
}

// Near log2(x), by a polynomial of the mantissa; nodes are where the same polynomial puts them.
fn student_t_impl_octaves(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    // The mantissa as a product of x, which a compiler of derivatives sees.
    let m = x * bitcast<f32>((254u - (bits >> 23u)) << 23u) - 1.0;
    return f32(bits >> 23u) - 127.0 + m * (m * (m - 4.0) + 10.0) * (1.0 / 7.0);
}

// At a place among nodes.
fn student_t_impl_three(x: f32) -> StudentTImplThree {
    let start = floor(student_t_impl_max(x, 0.0) + 0.5);
    let d = x - start;
    let half_d = 0.5 * d;
    let ends = half_d * d + 0.125;
    return StudentTImplThree(u32(start), vec3f(ends - half_d, 1.0 - (ends + ends), ends + half_d));
}

fn student_t_impl_albedo_of(lobe: StudentTLobe, masking: u32) -> StudentTImplAlbedo {
    let form = select(STUDENT_T_IMPL_VOLUME, 0u, masking == STUDENT_T_UNCORRELATED);
    let t = STUDENT_T_IMPL_VOLUMES + form;
    let ends = student_t_impl_four(t); // of 2 gamma - 3 and of sigma
    let places = student_t_impl_four(t + 4u); // of the first nodes, and nodes in a unit
    let averages = vec2f(student_t_impl_float(t + 8u), student_t_impl_float(t + 9u));
    let stand_in = sqrt(lobe.sigma.x * lobe.sigma.y);
    let s = student_t_impl_min(student_t_impl_max(stand_in, ends.z), ends.w);
    let twice = 2.0 * lobe.gamma - 3.0;
    let less = student_t_impl_min(student_t_impl_max(twice, ends.x), ends.y);
    let octaves = student_t_impl_octaves(s);
    let shape = sqrt(sqrt(less / (less + 3.0)));
    let sigma = student_t_impl_octaves(1.0 + 60.0 * s) + 0.2 * octaves + s;
    // Without albedos nothing is lost.
    let mirror = lobe.is_mirror || student_t_impl_word(t + 22u) == 0u;
    return StudentTImplAlbedo(
        t,
        select(s, 0.0, mirror),
        less,
        (octaves + 2.0 * s - averages.x) * averages.y,
        student_t_impl_three((shape - places.x) * places.z),
        student_t_impl_three((sigma - places.y) * places.w),
    );
}

// Four codes in a row, of which the first may be the second of its word.
fn student_t_impl_row(at: u32) -> vec4f {
    let word = at >> 1u;
    let odd = at & 1u;
    let a = student_t_impl_codes(word);
    let b = student_t_impl_codes(word + 1u);
    let c = student_t_impl_codes(word + 1u + odd);
    return select(vec4f(a, b), vec4f(a.y, b, c.x), odd > 0u);
}

// A cell of views, in which four coefficients begin, and their weights.
struct StudentTImplViews {
    cell: u32,
    weights: vec4f,
}

fn student_t_impl_views(a: StudentTImplAlbedo, mu: f32) -> StudentTImplViews {
    let d = a.less;
    let sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
    let x = d * mu / (d * mu + (6.0 * a.sigma * d + a.sigma) * sine);
    let h = mu / (1.0 + sine);
    // Of 26 cells.
    let place = student_t_impl_place(14.3 * sqrt(sqrt(x)) + 11.7 * sqrt(sqrt(h)), 25.0);
    let t = place.position;
    let rest = 1.0 - t;
    return StudentTImplViews(
        place.cell,
        vec4f(
            rest * rest * rest * (1.0 / 6.0),
            2.0 / 3.0 - t * t * (1.0 - 0.5 * t),
            2.0 / 3.0 - rest * rest * (1.0 - 0.5 * rest),
            t * t * t * (1.0 / 6.0),
        ),
    );
}

// A channel at a view.
fn student_t_impl_channel(a: StudentTImplAlbedo, channel: u32, views: StudentTImplViews) -> f32 {
    let first = (student_t_impl_word(a.volume + 22u + channel) >> 1u)
        + (a.by_sigma.start * STUDENT_T_IMPL_SHAPES + a.by_shape.start) * STUDENT_T_IMPL_VIEWS
        + views.cell;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 3u; i++) {
        let row = first + i * (STUDENT_T_IMPL_SHAPES * STUDENT_T_IMPL_VIEWS);
        let w = a.by_shape.weights;
        let codes = (w.x * student_t_impl_row(row)
            + w.y * student_t_impl_row(row + STUDENT_T_IMPL_VIEWS))
            + w.z * student_t_impl_row(row + 2u * STUDENT_T_IMPL_VIEWS);
        sum += a.by_sigma.weights[i] * codes;
    }
    return student_t_impl_decoded(a, channel, dot(sum, views.weights));
}

// The number of a sum of codes.
fn student_t_impl_decoded(a: StudentTImplAlbedo, channel: u32, sum: f32) -> f32 {
    return student_t_impl_float(a.volume + 10u + channel)
        + student_t_impl_float(a.volume + 16u + channel) * sum;
}

// The share lost at a view.
fn student_t_impl_lost_at(a: StudentTImplAlbedo, views: StudentTImplViews) -> f32 {
    let root = student_t_impl_channel(a, 0u, views);
    return min(root * root, 1.0);
}

// The share of light lost, 1 - E, with its digits where E is close to 1.
fn student_t_impl_lost(a: StudentTImplAlbedo, cos_theta: f32, masking: u32) -> f32 {
    if !(a.sigma > 0.0) {
        return 0.0;
    }
    return student_t_impl_lost_at(a, student_t_impl_views(a, student_t_impl_unit(cos_theta)));
}

// E - 1, bias and F82 at any cosine.
fn student_t_impl_moments(a: StudentTImplAlbedo, cos_theta: f32, masking: u32) -> vec3f {
    let mu = student_t_impl_unit(cos_theta);
    let mirror = student_t_impl_mirror(mu);
    if !(a.sigma > 0.0) {
        return mirror;
    }
    let views = student_t_impl_views(a, mu);
    let lost = student_t_impl_lost_at(a, views);
    let bias = student_t_impl_channel(a, 1u, views);
    let more = student_t_impl_channel(a, 2u, views);
    return vec3f(-lost, bias, more) + (1.0 - lost) * mirror;
}

// A channel of averages.
fn student_t_impl_average(a: StudentTImplAlbedo, channel: u32, by_sigma: StudentTImplThree) -> f32 {
    let first = (student_t_impl_word(a.volume + 22u + channel) >> 1u)
        + by_sigma.start * STUDENT_T_IMPL_SHAPES + a.by_shape.start;
    var sum = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let codes = student_t_impl_row(first + i * STUDENT_T_IMPL_SHAPES).xyz * a.by_shape.weights;
        sum += by_sigma.weights[i] * (codes.x + codes.y + codes.z);
    }
    return student_t_impl_decoded(a, channel, sum);
}

// 1 - E_avg, with its digits where E_avg is close to 1, and the averages of bias and F82.
fn student_t_impl_averages(a: StudentTImplAlbedo) -> vec3f {
    let mirror = student_t_impl_mirror_average();
    if !(a.sigma > 0.0) {
        return mirror;
    }
    let by_sigma = student_t_impl_three(a.coordinate);
    let octaves = student_t_impl_average(a, 3u, by_sigma);
    if octaves < -120.0 { // next to nothing is lost
        return mirror;
    }
    let lost = min(exp2(octaves), 1.0);
    let bias = student_t_impl_average(a, 4u, by_sigma);
    let more = student_t_impl_average(a, 5u, by_sigma);
    return vec3f(lost, bias, more) + (1.0 - lost) * mirror;
}
