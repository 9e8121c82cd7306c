// All functions at many points, appended to the exported module for real time, after
// aliases of `real` and of vectors of it: f32, or f16 where that arithmetic is tried.

struct Query {
    v: vec3f,
    gamma: f32,
    l: vec3f,
    sigma_x: f32,
    sigma_y: f32,
}

struct Answer {
    texel: vec4f,
    areas: vec2f, // of v and of l
    f_cos: f32,
    pdf: f32,
    d: f32,
    schlick: f32,
    tinted: f32,
    further: f32,
    scaled: f32,
}

@group(0) @binding(0) var masking: texture_2d<f32>;
@group(0) @binding(1) var<storage, read> queries: array<Query>;
@group(0) @binding(2) var<storage, read_write> answers: array<Answer>;
@group(0) @binding(4) var linear_clamp: sampler;
@group(0) @binding(5) var albedo: texture_3d<f32>;

fn area_of(surface: StudentTSurface, w: real3) -> real {
    let at = vec2f(student_t_surface_masking_at(surface, w));
    let texel = textureSampleLevel(masking, linear_clamp, at, 0.0).x;
    return student_t_surface_area(surface, w, real(texel));
}

fn albedo_of(surface: StudentTSurface, cos_theta: real) -> real4 {
    let at = vec3f(student_t_surface_albedo_at(surface, cos_theta));
    return real4(textureSampleLevel(albedo, linear_clamp, at, 0.0));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&queries) {
        return;
    }
    let q = queries[id.x];
    let v = real3(q.v);
    let l = real3(q.l);
    let m = real3(normalize(q.v + q.l));
    let surface = student_t_surface(real(q.gamma), real2(real(q.sigma_x), real(q.sigma_y)));
    let texel = albedo_of(surface, v.z);
    let area_v = area_of(surface, v);
    let area_l = area_of(surface, l);
    // A dielectric's reflectance, and that of a tinted metal.
    let tint = real3(0.6);
    let gold = real3(0.8);
    let average = student_t_f82_tint_average(gold, tint);
    let of_l = albedo_of(surface, l.z).x;
    answers[id.x] = Answer(
        vec4f(texel),
        vec2f(f32(area_v), f32(area_l)),
        f32(student_t_surface_eval(surface, v, l, m, area_v, area_l)),
        f32(student_t_surface_pdf(surface, m, area_v)),
        f32(student_t_surface_d(surface, m)),
        f32(student_t_schlick_albedo(texel, real3(0.04), 1.0, v.z).x),
        f32(student_t_f82_tint_albedo(texel, gold, tint, v.z).x),
        f32(student_t_further_bounces(texel, of_l, average).x),
        f32(student_t_scaled_bounce(texel, gold).x),
    );
}
