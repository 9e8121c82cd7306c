// ---- Visible normals ----------------------------------------------------------------------------

// The sine of 2 pi x for x up to a quarter, to 2e-7: the polynomial through Chebyshev's points.
fn student_t_impl_sine(x: f32) -> f32 {
    let y = x * x;
    let tail = y * (81.602475 + y * (-76.58117 + y * 39.759827));
    return x * (6.2831853 + y * (-41.34168 + tail));
}

// The cosine and the sine of 2 pi u for u in [0, 1].
fn student_t_impl_turn(u: f32) -> vec2f {
    let x = 0.5 - u;
    let quarter = abs(x) - 0.25;
    let rest = 0.25 - abs(quarter);
    return vec2f(student_t_impl_sine(quarter), student_t_impl_sine(select(rest, -rest, x < 0.0)));
}

// A visible normal of GGX by spherical caps (Dupuy & Benyoub 2023, doi:10.1111/cgf.14867).
fn student_t_impl_sample_cap(sigma: vec2f, v: vec3f, u: vec2f) -> vec3f {
    let above = vec3f(v.xy, student_t_impl_max(v.z, 0.0));
    var w = vec3f(sigma * above.xy, above.z);
    var tall = sqrt(student_t_impl_dot(w, w));
    if !(tall >= 1e-6) {
        // The squares of a short view would leave single precision; a null one is upright.
        w = select(vec3f(0.0, 0.0, 1.0), w / max(tall, 1e-37), tall > 0.0);
        tall = 1.0;
    }
    // First the height of the half vector, so that it keeps its digits where the cap ends at -z; at
    // least 2^-24 of the cap's: on the horizon a normal may have no length.
    let height = max(1.0 - student_t_impl_unit(u.x), 5.9604645e-8) * (tall + w.z);
    let up = height - w.z;
    let radius = sqrt(max((tall - up) * (tall + up), 0.0));
    let point = w.xy + radius * student_t_impl_turn(student_t_impl_unit(u.y));
    return student_t_impl_face(above, student_t_impl_raise(vec3f(sigma * point, height), 1.0));
}

// The distance of a random number from the nearer of 0 and 1, to the power of 1/4; 0 outside them.
fn student_t_impl_end(u: f32) -> f32 {
    return sqrt(sqrt(student_t_impl_max(student_t_impl_min(u, 1.0 - u), 0.0)));
}

// Half a slope in the plane of incidence, x : z.
struct StudentTImplHalfSlope {
    x: f32,
    z: f32,
    sign: f32,   // of the half of the slopes
    shrink: f32, // what z still has to be multiplied by
    clear: f32,  // distance from the silhouette
}

// What tables do not hold, for gamma < 1.8: (1 + s x^2)^(-1/2) = number^exponent, at least 2^-100;
// what would make z subnormal is kept apart.
fn student_t_impl_heavy_slope(lobe: StudentTLobe, number: f32) -> StudentTImplHalfSlope {
    let power = max(student_t_impl_log(max(number, 1e-37)) * lobe.heavy_exponent, -69.3);
    let zeta = exp(power);
    let large = max(zeta, 1e-15);
    let x = 0.5 * sqrt(max(-student_t_impl_exp_growth(2.0 * power), 0.0));
    let z = large * lobe.heavy_root_s;
    return StudentTImplHalfSlope(x, z, 1.0, zeta / large, x + z);
}

// By tables, from the number along the plane and the view among their rows.
fn student_t_impl_table_slope(
    lobe: StudentTLobe,
    along: f32,
    at: f32,
    silhouette: f32,
) -> StudentTImplHalfSlope {
    let second = along > 0.5;
    let view = student_t_impl_place(at, lobe.rows);
    let number = student_t_impl_place(student_t_impl_end(along) * lobe.along_scale,
                                      lobe.numbers - 1.0);
    let g = student_t_impl_along_at(lobe, view, u32(second), number);
    let sign = select(1.0, -1.0, second);
    let clear = g - select(silhouette, 0.0, second);
    return StudentTImplHalfSlope(g - 1.0, g * (2.0 - g), sign, 1.0, clear);
}

// A visible normal by inverting the distributions of two slopes, which are independent: x : z in
// the plane of incidence and t : tz across it, in units of sqrt(z z + s x x). Tables hold the
// distance g of a slope's half tangent from the end of its half, so that the slope is 2(1 - g) over
// g(2 - g).
fn student_t_impl_sample_tables(lobe: StudentTLobe, v: vec3f, u: vec2f) -> vec3f {
    // The slope across. The scale is 2^(1/4) times the number of cells.
    let across = student_t_impl_place(student_t_impl_end(u.y) * lobe.across_scale,
                                      0.8408964 * lobe.across_scale + 0.5);
    let far = student_t_impl_across_at(lobe, across);
    let t = select(far - 1.0, 1.0 - far, u.y > 0.5);
    let tz = far * (2.0 - far);

    // The view, among the rows of the table, and the g of its silhouette in the first half.
    let d = student_t_impl_stretch(lobe.sigma, v);
    let tall = sqrt(d.square + d.z * d.z);
    var rest = 1.0 - d.z / (d.rho + tall);
    if lobe.heavy_per_row > 0.0 {
        // Next to normal incidence the other form loses digits, which the narrow cells there need.
        let steep = tall + d.z;
        rest = d.rho * (steep + d.rho) / (steep * (d.rho + tall));
    }
    let silhouette = student_t_impl_unit(rest);
    let at = max(max(lobe.rows_first - lobe.rows_first * silhouette,
                     lobe.rows_second_end - lobe.rows_second * silhouette),
                 lobe.rows - lobe.rows_third * silhouette);

    // The first number chooses between the tables and what is in none, which comes last.
    var along = student_t_impl_unit(u.x);
    var is_heavy = false;
    var number = 1.0;
    if lobe.heavy_per_row > 0.0 {
        let cells = lobe.heavy_per_row;
        let place = student_t_impl_place(at * cells, lobe.rows * cells);
        let shares = student_t_impl_share_at(lobe, place);
        is_heavy = along > shares.y;
        if is_heavy {
            number = min((1.0 - along) / shares.x, 1.0);
        }
        along = along / shares.y;
    }
    var slope: StudentTImplHalfSlope;
    if is_heavy {
        slope = student_t_impl_heavy_slope(lobe, number);
    } else {
        slope = student_t_impl_table_slope(lobe, along, at, silhouette);
    }

    // The normal, turned to the azimuth of the view.
    let norm = sqrt(slope.z * slope.z + (4.0 * lobe.s) * (slope.x * slope.x));
    let ahead = slope.x * (slope.sign * tz);
    let aside = norm * t;
    let turned = vec2f(ahead * d.xy.x - aside * d.xy.y, ahead * d.xy.y + aside * d.xy.x);
    let m = student_t_impl_raise(vec3f(lobe.sigma * turned, slope.z * (0.5 * (d.frame * tz))),
                                 slope.shrink);
    // v.m is at least rho length/|m| times g tz less that of the silhouette, from which the
    // roundings of a shader, of terms of up to rho length (3 + 6 |t|)/|m|, cannot take it below 0.
    if !(slope.clear * tz >= 1e-5 * tz + 2e-5 * abs(t)) {
        return student_t_impl_face(vec3f(v.xy, d.z), m);
    }
    return m;
}

// A normal m visible from v, from two numbers. u.x chooses the slope along the azimuth of the view
// and u.y that across, both rising (for gamma < 1.8 within either of two parts); for GGX they are
// height and azimuth of a point of a spherical cap. m is of unit length and above the horizon.
fn student_t_lobe_sample_visible_normal(lobe: StudentTLobe, v: vec3f, u: vec2f) -> vec3f {
    if lobe.is_ggx > 0.0 {
        return student_t_impl_sample_cap(lobe.sigma, v, u);
    }
    return student_t_impl_sample_tables(lobe, v, u);
}

// Density of visible normals, max(0, v.m) D(m) G1(v)/(v.n).
fn student_t_lobe_visible_normal_pdf(lobe: StudentTLobe, v: vec3f, m: vec3f) -> f32 {
    let facing = student_t_impl_max(student_t_impl_dot(v, m), 0.0);
    let density = facing * student_t_lobe_d(lobe, m);
    let d = student_t_impl_stretch(lobe.sigma, v);
    return student_t_impl_product(density, student_t_impl_inverse_area(lobe, d));
}

// The light l = 2 (v.m) m - v that v is reflected to.
fn student_t_reflect(v: vec3f, m: vec3f) -> vec3f {
    return 2.0 * student_t_impl_dot(v, m) * m - v;
}

// Density of the light that v is reflected to by a visible normal m: that of m over 4 v.m, which is
// D(m) G1(v)/(4 v.n).
fn student_t_lobe_reflection_pdf(lobe: StudentTLobe, v: vec3f, m: vec3f) -> f32 {
    if !(student_t_impl_dot(v, m) > 0.0) {
        return 0.0;
    }
    let density = 0.25 * student_t_lobe_d(lobe, m);
    let d = student_t_impl_stretch(lobe.sigma, v);
    return student_t_impl_product(density, student_t_impl_inverse_area(lobe, d));
}
