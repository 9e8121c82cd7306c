// ---- One shape ----------------------------------------------------------------------------------
// The functions of lobes by a shape and sigma, without a lobe of one's own.

fn student_t_d(shape: u32, sigma: vec2f, m: vec3f) -> f32 {
    return student_t_lobe_d(student_t_lobe_of(shape, sigma), m);
}

fn student_t_masking(shape: u32, sigma: vec2f, w: vec3f) -> f32 {
    return student_t_lobe_masking(student_t_lobe_of(shape, sigma), w);
}

fn student_t_lambda(shape: u32, sigma: vec2f, w: vec3f) -> f32 {
    return student_t_lobe_lambda(student_t_lobe_of(shape, sigma), w);
}

fn student_t_masking_shadowing(shape: u32, sigma: vec2f, v: vec3f, l: vec3f, masking: u32) -> f32 {
    return student_t_lobe_masking_shadowing(student_t_lobe_of(shape, sigma), v, l, masking);
}

fn student_t_reflection_weight(shape: u32, sigma: vec2f, v: vec3f, l: vec3f, masking: u32) -> f32 {
    return student_t_lobe_reflection_weight(student_t_lobe_of(shape, sigma), v, l, masking);
}

fn student_t_sample_visible_normal(shape: u32, sigma: vec2f, v: vec3f, u: vec2f) -> vec3f {
    return student_t_lobe_sample_visible_normal(student_t_lobe_of(shape, sigma), v, u);
}

fn student_t_visible_normal_pdf(shape: u32, sigma: vec2f, v: vec3f, m: vec3f) -> f32 {
    return student_t_lobe_visible_normal_pdf(student_t_lobe_of(shape, sigma), v, m);
}

fn student_t_reflection_pdf(shape: u32, sigma: vec2f, v: vec3f, m: vec3f) -> f32 {
    return student_t_lobe_reflection_pdf(student_t_lobe_of(shape, sigma), v, m);
}

fn student_t_albedo(shape: u32, sigma: vec2f, cos_theta: f32, masking: u32) -> f32 {
    return student_t_lobe_albedo(student_t_lobe_of(shape, sigma), cos_theta, masking);
}

fn student_t_albedo_parts(shape: u32, sigma: vec2f, cos_theta: f32, masking: u32) -> vec3f {
    return student_t_lobe_albedo_parts(student_t_lobe_of(shape, sigma), cos_theta, masking);
}

fn student_t_albedo_average(shape: u32, sigma: vec2f, masking: u32) -> f32 {
    return student_t_lobe_albedo_average(student_t_lobe_of(shape, sigma), masking);
}

fn student_t_albedo_average_parts(shape: u32, sigma: vec2f, masking: u32) -> vec3f {
    return student_t_lobe_albedo_average_parts(student_t_lobe_of(shape, sigma), masking);
}

fn student_t_compensation(shape: u32, sigma: vec2f, v: vec3f, l: vec3f, masking: u32) -> f32 {
    return student_t_lobe_compensation(student_t_lobe_of(shape, sigma), v, l, masking);
}
