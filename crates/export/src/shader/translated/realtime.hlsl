#ifndef STUDENT_T_REALTIME
#define STUDENT_T_REALTIME

struct StudentTSurface {
    float2 sigma;
    float s;
    float power;
    float peak;
    float kappa;
    float stretch;
    int _pad6_0;
    float2 rows;
};

float student_t_impl_texel(float x, float n)
{
    return ((0.5 / n) + ((1.0 - (1.0 / n)) * x));
}

StudentTSurface ConstructStudentTSurface(float2 arg0, float arg1, float arg2, float arg3, float arg4, float arg5, float2 arg6) {
    StudentTSurface ret = (StudentTSurface)0;
    ret.sigma = arg0;
    ret.s = arg1;
    ret.power = arg2;
    ret.peak = arg3;
    ret.kappa = arg4;
    ret.stretch = arg5;
    ret.rows = arg6;
    return ret;
}

StudentTSurface student_t_surface(float gamma, float2 sigma)
{
    float heavy = (1.0 / ((2.0 * clamp(gamma, 1.6, 1000000.0)) - 3.0));
    float2 a = clamp(sigma, (0.0001).xx, (10000.0).xx);
    float kappa = (0.5 + (0.5 * heavy));
    float area = (a.x * a.y);
    float stand_in = sqrt(area);
    float s = max(((2.0 * heavy) / (1.0 + heavy)), 0.0005);
    float shape = (0.1556114 * log2((1.0 + (17.0 * heavy))));
    const float _e51 = student_t_impl_texel(sqrt(min(stand_in, 1.0)), 32.0);
    const float _e53 = student_t_impl_texel(shape, 32.0);
    const StudentTSurface studenttsurface = ConstructStudentTSurface(a, s, (1.0 - (1.0 / s)), (0.3183099 / area), kappa, ((kappa + 2.5) * stand_in), float2(_e51, _e53));
    return studenttsurface;
}

float student_t_surface_d(StudentTSurface surface, float3 m)
{
    float2 x_1 = (m.xy / surface.sigma);
    float square = max((m.z * m.z), 1e-24);
    float b = (square + (surface.s * dot(x_1, x_1)));
    float tail = exp2((surface.power * log2((b / square))));
    return ((((m.z > 0.0) ? surface.peak : 0.0) / (b * b)) * tail);
}

float2 student_t_surface_masking_at(StudentTSurface surface_1, float3 w)
{
    float c_1 = max(w.z, 0.0);
    float q = (c_1 / (c_1 + (surface_1.kappa * length((surface_1.sigma * w.xy)))));
    const float _e14 = student_t_impl_texel(q, 64.0);
    return float2(_e14, surface_1.rows.y);
}

float student_t_surface_area(StudentTSurface surface_2, float3 w_1, float texel)
{
    float c_2 = max(w_1.z, 0.0);
    float simple = (c_2 + (surface_2.kappa * length((surface_2.sigma * w_1.xy))));
    return (simple * (0.75 + texel));
}

float student_t_surface_eval(StudentTSurface surface_3, float3 v, float3 l, float3 m_1, float area_v, float area_l)
{
    const float _e6 = student_t_surface_d(surface_3, m_1);
    float cos_v = max(v.z, 0.0);
    float cos_l = max(l.z, 0.0);
    float both = ((cos_l * area_v) + (cos_v * (area_l - cos_l)));
    return (((0.25 * _e6) * cos_l) / max(both, 1e-20));
}

float student_t_surface_pdf(StudentTSurface surface_4, float3 m_2, float area_v_1)
{
    const float _e3 = student_t_surface_d(surface_4, m_2);
    return ((0.25 * _e3) / area_v_1);
}

float2 student_t_impl_weights(float c)
{
    float k = (1.0 - c);
    float fourth = ((k * k) * (k * k));
    return float2((fourth * k), (((17.651384 * c) * fourth) * (k * k)));
}

float3 student_t_impl_untinted(float3 f0_, float3 tint)
{
    return (((1.0).xxx - tint) * (f0_ + (((1.0).xxx - f0_) * 0.46266437)));
}

float3 student_t_schlick(float3 f0_1, float f90_, float cos_theta)
{
    const float2 _e5 = student_t_impl_weights(cos_theta);
    return (f0_1 + (((f90_).xxx - f0_1) * _e5.x));
}

float3 student_t_schlick_average(float3 f0_2, float f90_1)
{
    return (f0_2 + (((f90_1).xxx - f0_2) * 0.04761905));
}

float3 student_t_f82_tint(float3 f0_3, float3 tint_1, float cos_theta_1)
{
    const float2 _e3 = student_t_impl_weights(cos_theta_1);
    const float3 _e10 = student_t_impl_untinted(f0_3, tint_1);
    float3 raw = ((f0_3 + (((1.0).xxx - f0_3) * _e3.x)) - (_e10 * _e3.y));
    return max(raw, (0.0).xxx);
}

float3 student_t_f82_tint_average(float3 f0_4, float3 tint_2)
{
    const float3 _e3 = student_t_schlick_average(f0_4, 1.0);
    const float3 _e4 = student_t_impl_untinted(f0_4, tint_2);
    return (_e3 - (0.14009036 * _e4));
}

float3 student_t_surface_albedo_at(StudentTSurface surface_5, float cos_theta_2)
{
    float c_3 = clamp(cos_theta_2, 1e-12, 1.0);
    float x_2 = (c_3 / (c_3 + (surface_5.stretch * sqrt((1.0 - (c_3 * c_3))))));
    const float _e16 = student_t_impl_texel(sqrt(sqrt(x_2)), 48.0);
    return float3(_e16, surface_5.rows);
}

float3 student_t_impl_of_texel(float4 texel_1, float cos_theta_3)
{
    float e = (1.0 - (texel_1.x * texel_1.x));
    const float2 _e10 = student_t_impl_weights(clamp(cos_theta_3, 0.0, 1.0));
    float2 w_2 = (e * _e10);
    return float3(e, clamp((texel_1.y + w_2.x), 0.0, e), max((texel_1.z + w_2.y), 0.0));
}

float3 student_t_schlick_albedo(float4 texel_2, float3 f0_5, float f90_2, float cos_theta_4)
{
    const float3 _e4 = student_t_impl_of_texel(texel_2, cos_theta_4);
    return ((f0_5 * _e4.x) + (((f90_2).xxx - f0_5) * _e4.y));
}

float3 student_t_f82_tint_albedo(float4 texel_3, float3 f0_6, float3 tint_3, float cos_theta_5)
{
    const float3 _e4 = student_t_impl_untinted(f0_6, tint_3);
    const float3 _e5 = student_t_impl_of_texel(texel_3, cos_theta_5);
    float3 dip = (_e4 * _e5.z);
    const float3 _e9 = student_t_schlick_albedo(texel_3, f0_6, 1.0, cos_theta_5);
    return (_e9 - dip);
}

float3 student_t_further_bounces(float4 view, float light, float3 average)
{
    float lost = (view.w * view.w);
    float3 tint_4 = (((average * average) * (1.0 - lost)) / ((1.0).xxx - (average * lost)));
    float both_1 = ((view.x * light) / max(view.w, 0.0001));
    return (tint_4 * ((0.3183099 * both_1) * both_1));
}

float3 student_t_scaled_bounce(float4 view_1, float3 f0_7)
{
    float lost_1 = (view_1.x * view_1.x);
    return ((1.0).xxx + (f0_7 * (lost_1 / (1.0 - lost_1))));
}

#endif
