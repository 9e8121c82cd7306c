// In the page: spheres of metal by three.js' standard material, with its own table of albedos or
// with another, and what they return of lights from everywhere.

import * as THREE from 'three';

/// Lights that one rendering adds up; the uniforms of every device hold as many.
const AT_ONCE = 64;

/// The table as a texture of half floats, which every device filters.
function texture(data, width, height, format) {
    const numbers = new Uint16Array(data.map(THREE.DataUtils.toHalfFloat));
    const table = new THREE.DataTexture(numbers, width, height, format, THREE.HalfFloatType);
    table.magFilter = table.minFilter = THREE.LinearFilter;
    table.needsUpdate = true;
    return table;
}

/// A table of `export lut --channels scale-bias` as a texture, and the function that reads it as
/// its description says: scale and bias of Schlick's reflectance.
function inOurs({ axes_slowest_first: [along, across], data }) {
    const glsl = `
        uniform sampler2D albedos;
        vec2 scale_and_bias( float roughness, float mu ) {
            float sigma = roughness * roughness;
            const vec2 texels = vec2( ${across.texels}.0, ${along.texels}.0 );
            float x = mu / ( mu + ${across.kappa.toFixed(6)} * sigma * sqrt( 1.0 - mu * mu ) );
            vec2 c = vec2( sqrt( sqrt( x ) ), sqrt( sigma / ${along.sigma_max.toFixed(6)} ) );
            vec2 e = texture2D( albedos, ( 0.5 + ( texels - 1.0 ) * c ) / texels ).rg;
            float rest = 1.0 - mu, square = rest * rest;
            float bias = e.g + e.r * square * square * rest;
            return vec2( e.r - bias, bias );
        }`;
    return { glsl, albedos: texture(data, across.texels, along.texels, THREE.RGFormat) };
}

/// A square table of E over the coordinates of three.js, but with texels at the ends. Lamps see the
/// sum of scale and bias alone.
function atEnds({ texels: n, data }) {
    const glsl = `
        uniform sampler2D albedos;
        vec2 scale_and_bias( float roughness, float mu ) {
            vec2 at = vec2( roughness, mu ) * ${(n - 1) / n} + ${1 / (2 * n)};
            return vec2( texture2D( albedos, at ).r, 0.0 );
        }`;
    return { glsl, albedos: texture(data, n, n, THREE.RedFormat) };
}

/// Metal whose reflectance along the normal is `color`; without a table as three.js ships it.
export function metal(color, roughness, table = null) {
    const material = new THREE.MeshStandardMaterial({ color, metalness: 1, roughness });
    if (table) {
        const from = 'texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg';
        const chunk = THREE.ShaderChunk.lights_fragment_begin;
        if (!chunk.includes(from)) throw new Error(`three.js no longer has ${from}`);
        const to = 'scale_and_bias( material.roughness, dotNVms )';
        const { glsl, albedos } = table.axes_slowest_first ? inOurs(table) : atEnds(table);
        material.onBeforeCompile = shader => {
            shader.uniforms.albedos = { value: albedos };
            shader.fragmentShader = shader.fragmentShader
                .replace('void main()', `${glsl}\nvoid main()`)
                .replace('#include <lights_fragment_begin>', chunk.replace(from, to));
        };
        // Programs are shared by this key, which does not see what the function closes over.
        material.customProgramCacheKey = () => glsl;
        material.addEventListener('dispose', () => albedos.dispose());
    }
    return material;
}

// One for all pictures: browsers drop the oldest of more than a few contexts.
const renderer = new THREE.WebGLRenderer();
renderer.setClearColor(0, 0);
const sphere = new THREE.SphereGeometry(1, 96, 64);

/// Calls `use` with a function that renders the unit sphere, seen along z within the sides of
/// `view` (left, right, top, bottom), and returns its RGBA as floats, the lowest row first.
function shoot(material, lights, view, [width, height], use) {
    const scene = new THREE.Scene().add(new THREE.Mesh(sphere, material), ...lights);
    const camera = new THREE.OrthographicCamera(...view, 0.1, 10);
    camera.position.z = 3;
    const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
    const values = new Float32Array(4 * width * height);
    const found = use(() => {
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
        return values;
    });
    target.dispose();
    material.dispose();
    lights.forEach(light => light.dispose());
    return found;
}

/// The sphere under one light from a direction, in RGBA.
export function lamp(material, direction, intensity, side) {
    const light = new THREE.DirectionalLight(0xffffff, intensity);
    light.position.set(...direction);
    return shoot(material, [light], [-1, 1, 1, -1], [side, side], render => render());
}

/// What the sphere returns of a white sky of `count` lights, in red.
export function furnace(material, view, [width, height], count = 8192) {
    const lights = Array.from({ length: AT_ONCE }, () => new THREE.DirectionalLight(0xffffff));
    const sum = new Float64Array(width * height);
    return shoot(material, lights, view, [width, height], render => {
        for (let first = 0; first < count; first += AT_ONCE) {
            lights.forEach((light, i) => {
                const z = 1 - (2 * (first + i) + 1) / count, r = Math.sqrt(1 - z * z);
                const turn = (first + i) * Math.PI * (3 - Math.sqrt(5));
                // Their poles, where they are less even, are at the edge.
                light.position.set(r * Math.cos(turn), z, r * Math.sin(turn));
                // Each stands for its share of the sphere, in units of pi: three.js multiplies by
                // that.
                light.intensity = 4 * Math.PI / count;
            });
            const values = render();
            for (let i = 0; i < sum.length; ++i) sum[i] += values[4 * i];
        }
        return sum;
    });
}

/// The same from the middle of the sphere to its edge, with the cosine of each view. The lights lie
/// evenly about the view, so that the picture is this line, turned: far more lights than for all of
/// it take no longer, and smooth metal needs them, whose lobe must hold many. Where the cosine is
/// below 0.2 this is rough: there three.js adds to the roughness what the normal turns by within
/// squares of four pixels, which differ along the edge.
export function line(material, width, count) {
    const half = 0.5 / width;
    const values = furnace(material, [0, 1, half, -half], [width, 1], count);
    return Array.from(values, (value, i) => {
        const r = (i + 0.5) / width;
        return { mu: Math.sqrt(1 - r * r), value };
    });
}

/// The largest distance from 1 of what views of a cosine of 0.1 and more see.
export function off(pixels) {
    const seen = pixels.filter(({ mu }) => mu >= 0.1);
    return Math.max(...seen.map(({ value }) => Math.abs(value - 1)));
}
