// A program for fragments in WebGL 2: a metal sphere under one distant light. Compile it as
//     '#version 300 es\nprecision highp float;\n' + the text of student_t_realtime.glsl + this text
// over a triangle that covers the view, with the uniforms below.

uniform highp sampler2D masking; // both with linear filters that clamp
uniform highp sampler3D albedo;
uniform float gamma;
uniform vec2 sigma; // roughness along the parallels and along the meridians
uniform vec3 light; // unit vector towards the light
uniform vec3 metal; // reflectance at normal incidence
uniform vec2 size;  // of the view, in pixels
out vec4 color;

float area_of(StudentTSurface surface, vec3 w) {
    vec2 at = student_t_surface_masking_at(surface, w);
    return student_t_surface_area(surface, w, textureLod(masking, at, 0.0).x);
}

vec4 albedo_of(StudentTSurface surface, float cos_theta) {
    return textureLod(albedo, student_t_surface_albedo_at(surface, cos_theta), 0.0);
}

void main() {
    vec2 p = (2.0 * gl_FragCoord.xy - size) / min(size.x, size.y);
    vec3 n = vec3(p, sqrt(max(1.0 - dot(p, p), 0.0)));
    // The tangent frame: x along the parallels, y along the meridians, z the normal.
    vec3 x = normalize(vec3(n.z, 0.0, -n.x) + vec3(1e-6, 0.0, 0.0)), y = cross(n, x);
    vec3 v = vec3(x.z, y.z, n.z), l = vec3(dot(x, light), dot(y, light), dot(n, light));
    color = vec4(0.0, 0.0, 0.0, 1.0);
    if (dot(p, p) >= 1.0 || l.z <= 0.0) return;

    StudentTSurface surface = student_t_surface(gamma, sigma);
    vec4 view = albedo_of(surface, v.z);
    vec3 m = normalize(v + l);
    float first =
        student_t_surface_eval(surface, v, l, m, area_of(surface, v), area_of(surface, l));
    vec3 average = student_t_schlick_average(metal, 1.0);
    vec3 further = student_t_further_bounces(view, albedo_of(surface, l.z).x, average);
    vec3 both = student_t_schlick(metal, 1.0, dot(v, m)) * first + further * l.z;
    color.rgb = pow(both, vec3(1.0 / 2.2));
}
