// ---- Albedos ------------------------------------------------------------------------------------

// E - 1, bias and F82 of a mirror: 0, (1 - mu)^5 and 7^7/6^6 mu (1 - mu)^6.
fn student_t_impl_mirror(mu: f32) -> vec3f {
    let k = 1.0 - mu;
    let fourth = (k * k) * (k * k);
    return vec3f(0.0, fourth * k, 17.651384 * mu * (fourth * (k * k)));
}

// The averages of these over the hemisphere, weighted by the cosine.
fn student_t_impl_mirror_average() -> vec3f {
    return vec3f(0.0, 1.0 / 21.0, 0.14009036); // 117649/839808
}

// Scale, bias and F82, each in its range, from E, bias and F82.
fn student_t_impl_limit(moments: vec3f) -> vec3f {
    let bias = student_t_impl_min(student_t_impl_max(moments.y, 0.0), moments.x);
    return vec3f(moments.x - bias, bias, student_t_impl_unit(moments.z));
}

// Directional albedo E of one bounce with F = 1, in [0, 1], for a view or light of this cosine, of
// the round lobe of sqrt(sigma_x sigma_y).
fn student_t_lobe_albedo(lobe: StudentTLobe, cos_theta: f32, masking: u32) -> f32 {
    let a = student_t_impl_albedo_of(lobe, masking);
    return 1.0 - student_t_impl_lost(a, cos_theta, masking);
}

// Its parts scale, bias and F82: Schlick's reflectance F0 + (F90 - F0)(1 - v.m)^5 has the albedo
// F0 scale + F90 bias, with scale + bias = E. F82 is the moment of (v.m)(1 - v.m)^6 over its peak,
// at v.m = 1/7: a metal of OpenPBR, whose tint lowers the reflectance there by b, has b F82 less.
fn student_t_lobe_albedo_parts(lobe: StudentTLobe, cos_theta: f32, masking: u32) -> vec3f {
    let a = student_t_impl_albedo_of(lobe, masking);
    let moments = student_t_impl_moments(a, cos_theta, masking);
    return student_t_impl_limit(vec3f(1.0 + moments.x, moments.yz));
}

// The average of E over the hemisphere of views, weighted by the cosine.
fn student_t_lobe_albedo_average(lobe: StudentTLobe, masking: u32) -> f32 {
    return 1.0 - student_t_impl_averages(student_t_impl_albedo_of(lobe, masking)).x;
}

// The averages of the parts.
fn student_t_lobe_albedo_average_parts(lobe: StudentTLobe, masking: u32) -> vec3f {
    let averages = student_t_impl_averages(student_t_impl_albedo_of(lobe, masking));
    return student_t_impl_limit(vec3f(1.0 - averages.x, averages.yz));
}

// The lobe of further bounces from three losses; what loses nothing gets nothing back.
fn student_t_impl_kulla_conty(lost_v: f32, lost_l: f32, average: f32) -> f32 {
    if !(average > STUDENT_T_IMPL_SMALLEST) {
        return 0.0;
    }
    return 0.318309886 * lost_v * lost_l / average;
}

// The lobe of all bounces after the first with F = 1, a BRDF without the cosine:
// (1 - E(v))(1 - E(l))/(pi (1 - E_avg)) per steradian (Kulla & Conty 2017). For a conductor
// multiply it by F_avg^2 E_avg/(1 - F_avg (1 - E_avg)), with F_avg its average reflectance, which
// is (20 F0 + F90)/21 for Schlick's. Drawing lights by the cosine suits it for sigma >= 0.3; smooth
// surfaces lose their light at grazing, where such samples have weights of the order of 1/sigma.
fn student_t_lobe_compensation(lobe: StudentTLobe, v: vec3f, l: vec3f, masking: u32) -> f32 {
    if !(v.z > 0.0 && l.z > 0.0) {
        return 0.0;
    }
    let a = student_t_impl_albedo_of(lobe, masking);
    let of_view = student_t_impl_lost(a, v.z, masking);
    let of_light = student_t_impl_lost(a, l.z, masking);
    return student_t_impl_kulla_conty(of_view, of_light, student_t_impl_averages(a).x);
}

// The same from albedos E(v), E(l) and E_avg that are at hand: a renderer looks up that of a view
// once for all its lights, and the average once for a material. 0 where E_avg is not below 1.
fn student_t_compensation_from(e_v: f32, e_l: f32, e_average: f32) -> f32 {
    return student_t_impl_kulla_conty(1.0 - e_v, 1.0 - e_l, 1.0 - e_average);
}
