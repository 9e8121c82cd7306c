// f cos of one bounce with F = 1, in the plane of incidence: lights from -90 to 90 degrees along x,
// of the shape, of GGX and of Beckmann.

uniform highp uint shape;
uniform highp uint ggx;
uniform highp uint beckmann;
uniform vec2 sigma;
// Sines and cosines of the view, which stands on the negative side, and of each light: the device's
// own are off by what is much at the horizon.
uniform vec2 view;
uniform highp sampler2D lights;
out vec4 color;

float lobe(uint one, vec3 v, vec3 l) {
    vec3 m = normalize(v + l);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    return student_t_d(one, sigma, m)
        * student_t_masking_shadowing(one, sigma, v, l, masking) / (4.0 * v.z);
}

void main() {
    vec2 light = texelFetch(lights, ivec2(gl_FragCoord.xy), 0).xy;
    vec3 v = vec3(-view.x, 0.0, view.y), l = vec3(light.x, 0.0, light.y);
    color = vec4(0.0, 0.0, 0.0, 1.0);
    if (l.z > 1e-6) color.rgb = vec3(lobe(shape, v, l), lobe(ggx, v, l), lobe(beckmann, v, l));
}
