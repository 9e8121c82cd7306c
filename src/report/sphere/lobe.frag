// f cos of one bounce with F = 1, in the plane of incidence: lights from -90 to 90 degrees along x,
// of the shape, of GGX and of Beckmann.

uniform highp uint shape;
uniform highp uint ggx;
uniform highp uint beckmann;
uniform vec2 sigma;
uniform float view;   // radians; the view stands on the negative side
uniform float count;  // lights
out vec4 color;

float lobe(uint one, vec3 v, vec3 l) {
    vec3 m = normalize(v + l);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    return student_t_d(one, sigma, m)
        * student_t_masking_shadowing(one, sigma, v, l, masking) / (4.0 * v.z);
}

void main() {
    float angle = 3.14159265 * ((gl_FragCoord.x - 0.5) / (count - 1.0) - 0.5);
    vec3 v = vec3(-sin(view), 0.0, cos(view)), l = vec3(sin(angle), 0.0, cos(angle));
    color = vec4(0.0, 0.0, 0.0, 1.0);
    if (l.z > 1e-6) color.rgb = vec3(lobe(shape, v, l), lobe(ggx, v, l), lobe(beckmann, v, l));
}
