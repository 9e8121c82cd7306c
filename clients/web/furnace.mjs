// In the page: a white metal sphere under lights from everywhere, by three.js' standard material,
// with its own table of albedos and with one in our coordinates.

import * as THREE from 'three';

const SIDE = 48, LIGHTS = 8192, AT_ONCE = 32;

/// The function that reads a table of `export lut --channels scale-bias`, as its description says:
/// scale and bias of Schlick's reflectance.
function lookup({ axes_slowest_first: [along, across] }) {
    return `
        uniform sampler2D albedos;
        vec2 scale_and_bias( float sigma, float mu ) {
            const vec2 texels = vec2( ${across.texels}.0, ${along.texels}.0 );
            float x = mu / ( mu + ${across.kappa.toFixed(6)} * sigma * sqrt( 1.0 - mu * mu ) );
            vec2 c = vec2( sqrt( sqrt( x ) ), sqrt( sigma / ${along.sigma_max.toFixed(6)} ) );
            vec2 e = texture2D( albedos, ( 0.5 + ( texels - 1.0 ) * c ) / texels ).rg;
            float rest = 1.0 - mu, square = rest * rest;
            float bias = e.g + e.r * square * square * rest;
            return vec2( e.r - bias, bias );
        }`;
}

/// The table as a texture of half floats, which every device filters.
function texture({ axes_slowest_first: [along, across], data }) {
    const numbers = new Uint16Array(data.map(THREE.DataUtils.toHalfFloat));
    const table = new THREE.DataTexture(
        numbers, across.texels, along.texels, THREE.RGFormat, THREE.HalfFloatType);
    table.magFilter = table.minFilter = THREE.LinearFilter;
    table.needsUpdate = true;
    return table;
}

/// What a sphere returns of a sky of lights, and the cosine of the view, by pixel.
window.furnace = (roughness, description) => {
    const renderer = new THREE.WebGLRenderer();
    const material = new THREE.MeshStandardMaterial({ color: 0xffffff, metalness: 1, roughness });
    if (description) {
        const from = 'texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg';
        const chunk = THREE.ShaderChunk.lights_fragment_begin;
        if (!chunk.includes(from)) throw new Error(`three.js no longer has ${from}`);
        const to = 'scale_and_bias( material.roughness * material.roughness, dotNVms )';
        material.onBeforeCompile = shader => {
            shader.uniforms.albedos = { value: texture(description) };
            shader.fragmentShader = shader.fragmentShader
                .replace('void main()', `${lookup(description)}\nvoid main()`)
                .replace('#include <lights_fragment_begin>', chunk.replace(from, to));
        };
    }
    const scene = new THREE.Scene();
    scene.add(new THREE.Mesh(new THREE.SphereGeometry(1, 96, 64), material));
    const lights = Array.from({ length: AT_ONCE }, () => new THREE.DirectionalLight(0xffffff));
    lights.forEach(light => scene.add(light));
    const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
    camera.position.z = 3;
    const target = new THREE.WebGLRenderTarget(SIDE, SIDE, { type: THREE.FloatType });
    const sum = new Float64Array(SIDE * SIDE), values = new Float32Array(4 * SIDE * SIDE);
    for (let first = 0; first < LIGHTS; first += AT_ONCE) {
        lights.forEach((light, i) => {
            const z = 1 - (2 * (first + i) + 1) / LIGHTS, r = Math.sqrt(1 - z * z);
            const turn = (first + i) * Math.PI * (3 - Math.sqrt(5));
            light.position.set(r * Math.cos(turn), r * Math.sin(turn), z).multiplyScalar(5);
            // Each stands for its share of the sphere, in units of pi: three.js multiplies by that.
            light.intensity = 4 * Math.PI / LIGHTS;
        });
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        renderer.readRenderTargetPixels(target, 0, 0, SIDE, SIDE, values);
        for (let i = 0; i < sum.length; ++i) sum[i] += values[4 * i];
    }
    const pixels = [];
    for (let i = 0; i < sum.length; ++i) {
        const [x, y] = [i % SIDE, Math.floor(i / SIDE)].map(at => (2 * at + 1) / SIDE - 1);
        const square = 1 - x * x - y * y;
        if (square > 0) pixels.push({ mu: Math.sqrt(square), value: sum[i] });
    }
    renderer.dispose();
    return pixels;
};
