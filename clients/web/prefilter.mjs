// In the page: an environment that three.js filters in advance, with its own lines and with those
// of another gamma, which docs/ibl.md shows; and what both have at directions and levels.

import * as THREE from 'three';

const SUN = new THREE.Vector3(0.48, 0.6, 0.64);

/// The radiance of the sky.
export function sky(w) {
    return 0.3 + 0.2 * w.y + 20 * Math.exp(60 * (SUN.dot(w) - 1));
}

/// The sky as an image of latitude and longitude.
function image(width, height) {
    const texels = new Float32Array(4 * width * height);
    for (let y = 0; y < height; ++y) {
        const latitude = ((y + 0.5) / height - 0.5) * Math.PI;
        for (let x = 0; x < width; ++x) {
            const longitude = ((x + 0.5) / width - 0.5) * 2 * Math.PI;
            const r = Math.cos(latitude);
            const w = new THREE.Vector3(
                r * Math.cos(longitude), Math.sin(latitude), r * Math.sin(longitude));
            texels.fill(sky(w), 4 * (y * width + x), 4 * (y * width + x + 1));
        }
    }
    const texture = new THREE.DataTexture(
        texels, width, height, THREE.RGBAFormat, THREE.FloatType,
        THREE.EquirectangularReflectionMapping);
    texture.magFilter = texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

/// What replaces a shader's lines; an error if they are not there.
function replaced(shader, changes) {
    for (const [from, to] of changes) {
        if (!from.test(shader)) throw new Error(`three.js no longer has ${from}`);
        shader = shader.replace(from, to);
    }
    return shader;
}

/// Gives the materials of a generator another gamma; `functions` is the exported module.
function changeLobe(generator, functions, gamma) {
    const samples = generator._ggxMaterial, texels = generator._integrationMaterial;
    const head = `uniform float gamma;\n${functions}\n`;
    samples.fragmentShader = replaced(samples.fragmentShader, [
        [/void main\(\)/, `${head}void main()`],
        [/float invQ = [^;]*;\s*float NdotL = [^;]*;/, `
            vec4 light = student_t_prefilter_light( Xi, alpha, gamma );
            float NdotL = light.z;`],
        [/float phi = [^;]*;\s*float sinTheta = [^;]*;\s*vec3 L = [^;]*;/, `
            vec3 L = N * NdotL + tangent * light.x + bitangent * light.y;`],
        [/float d = [^;]*;\s*float lod = [^;]*;/, `
            float lod = max( lodBias + 0.5 * log2( alpha2 / ( 4.0 * PI * light.w ) ), 0.0 );`],
    ]);
    texels.fragmentShader = replaced(texels.fragmentShader, [
        [/void main\(\)/, `${head}void main()`],
        [/float d = [^;]*;\s*float weight = [^;]*;/, `
            float weight = NdotL * invDistance * invDistance * invDistance
                * student_t_prefilter_pdf( NdotL, alpha, gamma );`],
    ]);
    for (const material of [samples, texels]) {
        material.uniforms.gamma = { value: gamma };
        material.needsUpdate = true;
    }
}

const renderer = new THREE.WebGLRenderer();
const texture = image(512, 256);

/// The filtered sky, by three.js alone if `gamma` is null.
function filtered(functions, gamma) {
    const generator = new THREE.PMREMGenerator(renderer);
    const own = generator.fromEquirectangular(texture);
    if (gamma === null) return own.texture;
    changeLobe(generator, functions, gamma);
    return generator.fromEquirectangular(texture).texture;
}

/// Red at the directions, at a level, as floats.
function read(cube, directions, level) {
    const places = new THREE.DataTexture(
        new Float32Array(directions.flatMap(w => [w.x, w.y, w.z, 0])), directions.length, 1,
        THREE.RGBAFormat, THREE.FloatType);
    places.needsUpdate = true;
    const target = new THREE.WebGLRenderTarget(
        directions.length, 1, { type: THREE.FloatType, depthBuffer: false });
    const material = new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3,
        uniforms: {
            cube: { value: cube }, places: { value: places }, level: { value: level },
        },
        vertexShader: 'in vec3 position; void main() { gl_Position = vec4(position, 1.0); }',
        fragmentShader: `
            precision highp float;
            uniform samplerCube cube;
            uniform sampler2D places;
            uniform float level;
            out vec4 color;
            void main() {
                vec3 w = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xyz;
                color = textureLod(cube, w, level);
            }`,
    });
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    mesh.frustumCulled = false;
    renderer.setRenderTarget(target);
    renderer.render(new THREE.Scene().add(mesh), new THREE.Camera());
    const values = new Float32Array(4 * directions.length);
    renderer.readRenderTargetPixels(target, 0, 0, directions.length, 1, values);
    renderer.setRenderTarget(null);
    return [...values].filter((_, i) => i % 4 === 0);
}

/// The same integral in double precision, by D as the paper prints it: over half vectors that are
/// spread as those of GGX.
function integral(n, sigma, gamma) {
    const up = Math.abs(n.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
    const t = up.cross(n).normalize(), b = n.clone().cross(t);
    let sum = 0, weights = 0;
    for (let i = 0, count = 400; i < count; ++i) {
        const u = (i + 0.5) / count, slope2 = sigma * sigma * u / (1 - u);
        const cosine = (1 - slope2) / (1 + slope2), sine = 2 * Math.sqrt(slope2) / (1 + slope2);
        if (cosine <= 0) break;
        const d = g => (1 + slope2 / (sigma * sigma * (g - 1))) ** -g;
        const weight = cosine * d(gamma) / d(2);
        for (let k = 0, turns = 96; k < turns; ++k) {
            const turn = 2 * Math.PI * (k + 0.5) / turns;
            const l = n.clone().multiplyScalar(cosine)
                .addScaledVector(t, sine * Math.cos(turn))
                .addScaledVector(b, sine * Math.sin(turn));
            sum += weight * sky(l);
            weights += weight;
        }
    }
    return sum / weights;
}

/// At directions about the sun and away from it, by level: what three.js has, what it has with the
/// lines of `gamma`, and the integral.
window.compare = (functions, gamma) => {
    const directions = Array.from({ length: 40 }, (_, i) => {
        const angle = i * 0.04, aside = new THREE.Vector3(0.8, 0, -0.6);
        return SUN.clone().multiplyScalar(Math.cos(angle))
            .addScaledVector(aside, Math.sin(angle)).normalize();
    });
    const own = filtered(functions, null), changed = filtered(functions, gamma);
    const last = own.mipmaps.length - 1;
    const levels = Array.from({ length: last + 1 }, (_, level) => level);
    return levels.map(level => {
        const roughness = THREE.PMREMGenerator.lodToRoughness(level, last);
        const alpha = roughness * roughness;
        const truth = directions.map(n => (alpha > 1e-4 ? integral(n, alpha, gamma) : sky(n)));
        return {
            alpha,
            truth,
            own: read(own, directions, level),
            changed: read(changed, directions, level),
        };
    });
};
