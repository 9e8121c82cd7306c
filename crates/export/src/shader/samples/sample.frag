// A program for fragments in WebGL 2: a metal sphere under one distant light. Compile it as
//     '#version 300 es\nprecision highp float;\nprecision highp int;\n'
//         + the text of student_t.glsl + this text
// over a triangle that covers the view, with the uniforms below.

uniform highp uint shape; // its offset in student_t.json
uniform vec2 sigma;       // roughness along the parallels and along the meridians
uniform vec3 light;       // unit vector towards the light
uniform vec3 metal;       // reflectance at normal incidence
uniform vec2 size;        // of the view, in pixels
out vec4 color;

void main() {
    vec2 p = (2.0 * gl_FragCoord.xy - size) / min(size.x, size.y);
    float square = dot(p, p);
    if (square >= 1.0) discard;
    vec3 n = vec3(p, sqrt(1.0 - square));
    // The tangent frame: x along the parallels, y along the meridians, z the normal.
    vec3 x = normalize(vec3(n.z, 0.0, -n.x)), y = cross(n, x);
    vec3 v = vec3(x.z, y.z, n.z), l = vec3(dot(x, light), dot(y, light), dot(n, light));
    color = vec4(0.0, 0.0, 0.0, 1.0);
    if (l.z <= 0.0) return;

    StudentTLobe lobe = student_t_lobe_of(shape, sigma);
    vec3 m = normalize(v + l);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    float k = 1.0 - dot(v, m);
    vec3 fresnel = metal + (1.0 - metal) * (k * k * k * k * k);
    vec3 f = fresnel * student_t_lobe_d(lobe, m)
        * student_t_lobe_masking_shadowing(lobe, v, l, masking) / (4.0 * v.z * l.z);
    // What further bounces add.
    vec3 average = (20.0 * metal + 1.0) / 21.0;
    float albedo = student_t_lobe_albedo_average(lobe, masking);
    f += average * average * albedo / (1.0 - average * (1.0 - albedo))
        * student_t_lobe_compensation(lobe, v, l, masking);
    color.rgb = pow(f * l.z, vec3(1.0 / 2.2));
}
