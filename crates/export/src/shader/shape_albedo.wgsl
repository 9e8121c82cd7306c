// ---- Albedos of shapes --------------------------------------------------------------------------

// Six of n even nodes about x, with the weights of the polynomial through them.
struct StudentTImplSix {
    start: u32,
    a: vec3f, // of the first three
    b: vec3f, // of the last three
}

fn student_t_impl_six(x: f32, n: f32) -> StudentTImplSix {
    let at = student_t_impl_min(student_t_impl_max(x, 0.0), n - 1.0);
    let start = max(min(floor(at) - 2.0, n - 6.0), 0.0);
    let a = at - start;
    let b = a - 1.0;
    let c = a - 2.0;
    let d = a - 3.0;
    let e = a - 4.0;
    let f = a - 5.0;
    let first = vec3f(b * c * (-1.0 / 120.0), a * c * (1.0 / 24.0), a * b * (-1.0 / 12.0));
    let last = vec3f(e * f * (1.0 / 12.0), d * f * (-1.0 / 24.0), d * e * (1.0 / 120.0));
    return StudentTImplSix(u32(start), d * e * f * first, a * b * c * last);
}

// Three numbers of a table of albedos or averages.
fn student_t_impl_node(at: u32) -> vec3f {
    return vec3f(student_t_impl_pair(at), student_t_impl_pair(at + 1u).x);
}

// The polynomial through six nodes in a row, less a constant, whose digits its weights would round.
fn student_t_impl_row(at: u32, six: StudentTImplSix, less: vec3f) -> vec3f {
    return ((student_t_impl_node(at) - less) * six.a.x
            + (student_t_impl_node(at + 2u) - less) * six.a.y
            + (student_t_impl_node(at + 4u) - less) * six.a.z)
        + ((student_t_impl_node(at + 6u) - less) * six.b.x
            + (student_t_impl_node(at + 8u) - less) * six.b.y
            + (student_t_impl_node(at + 10u) - less) * six.b.z);
}

// One roughness of a table of albedos.
struct StudentTImplAlbedo {
    table: StudentTAlbedoTable,
    sigma: f32,      // 0: a mirror
    coordinate: f32, // in [0, 1]
    lowest: f32,     // cosine of the first view
}

fn student_t_impl_albedo_of(lobe: StudentTLobe, masking: u32) -> StudentTImplAlbedo {
    let t = student_t_impl_albedo_table(lobe.shape, masking);
    let stand_in = sqrt(lobe.sigma.x * lobe.sigma.y);
    let rough = student_t_impl_min(student_t_impl_max(stand_in, t.sigma_min), t.sigma_max);
    let lowest = t.floor * (t.slope * rough) / (t.floor + t.slope * rough);
    let coordinate = student_t_impl_log_growth(rough / t.offset)
        + t.slow * log(rough / t.first) + t.linear * rough;
    // Without albedos nothing is lost.
    let mirror = lobe.is_mirror || t.values == lobe.shape;
    return StudentTImplAlbedo(t, select(rough, 0.0, mirror), (coordinate - t.start) / t.range,
                              lowest);
}

// The coordinate of a view by its cosine mu, before it is stretched to [0, 1].
fn student_t_impl_view(a: StudentTImplAlbedo, mu: f32) -> f32 {
    let sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
    let x = mu / (mu + a.table.kappa * a.sigma * sine);
    let h = mu / (1.0 + sine);
    let nu = a.table.spread * a.sigma;
    let roots = a.table.share * sqrt(sqrt(x)) + (1.0 - a.table.share) * sqrt(sqrt(h));
    return a.table.weight * x + a.table.normal * (nu / (nu + sine))
        + (1.0 - a.table.weight - a.table.normal) * roots;
}

// E - 1, bias and F82 at a cosine mu from the first view up.
fn student_t_impl_moments_at(a: StudentTImplAlbedo, mu: f32) -> vec3f {
    let start = student_t_impl_view(a, a.lowest);
    let at = (student_t_impl_view(a, mu) - start) / (1.0 - start);
    let i = student_t_impl_six(a.coordinate * (a.table.sigmas - 1.0), a.table.sigmas);
    let j = student_t_impl_six(at * (a.table.views - 1.0), a.table.views);
    let row = 2u * u32(a.table.views);
    let first = a.table.values + i.start * row + 2u * j.start;
    let middle = student_t_impl_node(first + 2u * row + 4u);
    let sum = (student_t_impl_row(first, j, middle) * i.a.x
            + student_t_impl_row(first + row, j, middle) * i.a.y
            + student_t_impl_row(first + 2u * row, j, middle) * i.a.z)
        + (student_t_impl_row(first + 3u * row, j, middle) * i.b.x
            + student_t_impl_row(first + 4u * row, j, middle) * i.b.y
            + student_t_impl_row(first + 5u * row, j, middle) * i.b.z);
    let moments = middle + sum;
    let e = student_t_impl_min(student_t_impl_max(moments.x, -1.0), 0.0);
    return vec3f(e, moments.yz) + (1.0 + e) * student_t_impl_mirror(mu);
}

// E - 1, bias and F82 at any cosine, to the limits that they near with a power of it.
fn student_t_impl_moments(a: StudentTImplAlbedo, cos_theta: f32, masking: u32) -> vec3f {
    let mu = student_t_impl_unit(cos_theta);
    if !(a.sigma > 0.0) {
        return student_t_impl_mirror(mu);
    }
    let moments = student_t_impl_moments_at(a, max(mu, a.lowest));
    if !(mu < a.lowest) {
        return moments;
    }
    if !(moments.x < 0.0) { // What loses nothing is a mirror, which nears no limit.
        return student_t_impl_mirror(mu);
    }
    let above = student_t_impl_moments_at(a, 4.0 * a.lowest);
    var power = 1.0;
    if masking != STUDENT_T_UNCORRELATED {
        let ratio = above.x / moments.x;
        power = 0.0;
        if ratio > 1.0 {
            power = min(0.72134752 * student_t_impl_log(ratio), 1.0); // log to the base 4
        }
    }
    var more = 0.0;
    if power > 0.0 {
        var nearer = 1.0;
        if mu > 0.0 {
            nearer = -student_t_impl_exp_growth(power * log(mu / a.lowest));
        }
        more = nearer / student_t_impl_exp_growth(power * 1.3862944); // 4^power - 1
    }
    let limit = moments + more * (moments - above);
    return vec3f(student_t_impl_min(student_t_impl_max(limit.x, -1.0), 0.0), limit.yz);
}

// The share of light lost, 1 - E, with its digits where E is close to 1.
fn student_t_impl_lost(a: StudentTImplAlbedo, cos_theta: f32, masking: u32) -> f32 {
    return -student_t_impl_moments(a, cos_theta, masking).x;
}

// 1 - E_avg, with its digits where E_avg is close to 1, and the averages of bias and F82.
fn student_t_impl_averages(a: StudentTImplAlbedo) -> vec3f {
    if !(a.sigma > 0.0) {
        return student_t_impl_mirror_average();
    }
    let count = a.table.average_sigmas;
    let six = student_t_impl_six(a.coordinate * (count - 1.0), count);
    let averages = student_t_impl_row(a.table.averages + 2u * six.start, six, vec3f(0.0));
    return vec3f(min(exp(averages.x), 1.0), averages.yz);
}
