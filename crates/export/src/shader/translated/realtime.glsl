#ifndef STUDENT_T_REALTIME
#define STUDENT_T_REALTIME

struct StudentTSurface {
    vec2 sigma;
    float s;
    float power;
    float peak;
    float kappa;
    float stretch;
    vec2 rows;
};

float student_t_impl_texel(float x, float n) {
    return ((0.5 / n) + ((1.0 - (1.0 / n)) * x));
}

StudentTSurface student_t_surface(float gamma, vec2 sigma) {
    float heavy = (1.0 / ((2.0 * clamp(gamma, 1.6, 1000000.0)) - 3.0));
    vec2 a = clamp(sigma, vec2(0.0001), vec2(10000.0));
    float kappa = (0.5 + (0.5 * heavy));
    float area = (a.x * a.y);
    float stand_in = sqrt(area);
    float s = max(((2.0 * heavy) / (1.0 + heavy)), 0.0005);
    float shape = (0.1556114 * log2((1.0 + (17.0 * heavy))));
    float _e51 = student_t_impl_texel(sqrt(min(stand_in, 1.0)), 32.0);
    float _e53 = student_t_impl_texel(shape, 32.0);
    return StudentTSurface(a, s, (1.0 - (1.0 / s)), (0.3183099 / area), kappa, ((kappa + 2.5) * stand_in), vec2(_e51, _e53));
}

float student_t_surface_d(StudentTSurface surface, vec3 m) {
    vec2 x_1 = (m.xy / surface.sigma);
    float square = max((m.z * m.z), 1e-24);
    float b = (square + (surface.s * dot(x_1, x_1)));
    float tail = exp2((surface.power * log2((b / square))));
    return ((((m.z > 0.0) ? surface.peak : 0.0) / (b * b)) * tail);
}

vec2 student_t_surface_masking_at(StudentTSurface surface_1, vec3 w) {
    float c_1 = max(w.z, 0.0);
    float q = (c_1 / (c_1 + (surface_1.kappa * length((surface_1.sigma * w.xy)))));
    float _e14 = student_t_impl_texel(q, 64.0);
    return vec2(_e14, surface_1.rows.y);
}

float student_t_surface_area(StudentTSurface surface_2, vec3 w_1, float texel) {
    float c_2 = max(w_1.z, 0.0);
    float simple = (c_2 + (surface_2.kappa * length((surface_2.sigma * w_1.xy))));
    return (simple * (0.75 + texel));
}

float student_t_surface_eval(StudentTSurface surface_3, vec3 v, vec3 l, vec3 m_1, float area_v, float area_l) {
    float _e6 = student_t_surface_d(surface_3, m_1);
    float cos_v = max(v.z, 0.0);
    float cos_l = max(l.z, 0.0);
    float both = ((cos_l * area_v) + (cos_v * (area_l - cos_l)));
    return (((0.25 * _e6) * cos_l) / max(both, 1e-20));
}

float student_t_surface_pdf(StudentTSurface surface_4, vec3 m_2, float area_v_1) {
    float _e3 = student_t_surface_d(surface_4, m_2);
    return ((0.25 * _e3) / area_v_1);
}

vec2 student_t_impl_weights(float c) {
    float k = (1.0 - c);
    float fourth = ((k * k) * (k * k));
    return vec2((fourth * k), (((17.651384 * c) * fourth) * (k * k)));
}

vec3 student_t_impl_untinted(vec3 f0_, vec3 tint) {
    return ((vec3(1.0) - tint) * (f0_ + ((vec3(1.0) - f0_) * 0.46266437)));
}

vec3 student_t_schlick(vec3 f0_1, float f90_, float cos_theta) {
    vec2 _e5 = student_t_impl_weights(cos_theta);
    return (f0_1 + ((vec3(f90_) - f0_1) * _e5.x));
}

vec3 student_t_schlick_average(vec3 f0_2, float f90_1) {
    return (f0_2 + ((vec3(f90_1) - f0_2) * 0.04761905));
}

vec3 student_t_f82_tint(vec3 f0_3, vec3 tint_1, float cos_theta_1) {
    vec2 _e3 = student_t_impl_weights(cos_theta_1);
    vec3 _e10 = student_t_impl_untinted(f0_3, tint_1);
    vec3 raw = ((f0_3 + ((vec3(1.0) - f0_3) * _e3.x)) - (_e10 * _e3.y));
    return max(raw, vec3(0.0));
}

vec3 student_t_f82_tint_average(vec3 f0_4, vec3 tint_2) {
    vec3 _e3 = student_t_schlick_average(f0_4, 1.0);
    vec3 _e4 = student_t_impl_untinted(f0_4, tint_2);
    return (_e3 - (0.14009036 * _e4));
}

vec3 student_t_surface_albedo_at(StudentTSurface surface_5, float cos_theta_2) {
    float c_3 = clamp(cos_theta_2, 1e-12, 1.0);
    float x_2 = (c_3 / (c_3 + (surface_5.stretch * sqrt((1.0 - (c_3 * c_3))))));
    float _e16 = student_t_impl_texel(sqrt(sqrt(x_2)), 48.0);
    return vec3(_e16, surface_5.rows);
}

vec3 student_t_impl_of_texel(vec4 texel_1, float cos_theta_3) {
    float e = (1.0 - (texel_1.x * texel_1.x));
    vec2 _e10 = student_t_impl_weights(clamp(cos_theta_3, 0.0, 1.0));
    vec2 w_2 = (e * _e10);
    return vec3(e, clamp((texel_1.y + w_2.x), 0.0, e), max((texel_1.z + w_2.y), 0.0));
}

vec3 student_t_schlick_albedo(vec4 texel_2, vec3 f0_5, float f90_2, float cos_theta_4) {
    vec3 _e4 = student_t_impl_of_texel(texel_2, cos_theta_4);
    return ((f0_5 * _e4.x) + ((vec3(f90_2) - f0_5) * _e4.y));
}

vec3 student_t_f82_tint_albedo(vec4 texel_3, vec3 f0_6, vec3 tint_3, float cos_theta_5) {
    vec3 _e4 = student_t_impl_untinted(f0_6, tint_3);
    vec3 _e5 = student_t_impl_of_texel(texel_3, cos_theta_5);
    vec3 dip = (_e4 * _e5.z);
    vec3 _e9 = student_t_schlick_albedo(texel_3, f0_6, 1.0, cos_theta_5);
    return (_e9 - dip);
}

vec3 student_t_further_bounces(vec4 view, float light, vec3 average) {
    float lost = (view.w * view.w);
    vec3 tint_4 = (((average * average) * (1.0 - lost)) / (vec3(1.0) - (average * lost)));
    float both_1 = ((view.x * light) / max(view.w, 0.0001));
    return (tint_4 * ((0.3183099 * both_1) * both_1));
}

vec3 student_t_scaled_bounce(vec4 view_1, vec3 f0_7) {
    float lost_1 = (view_1.x * view_1.x);
    return (vec3(1.0) + (f0_7 * (lost_1 / (1.0 - lost_1))));
}

#endif
