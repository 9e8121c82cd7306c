// In the page: what node materials of three.js with exported functions shade, by WebGPU.

import * as THREE from 'three/webgpu';
import { int, ivec2, screenCoordinate, sqrt, texture, textureLoad, uint, vec4 } from 'three/tsl';
import { closedNodes, lobeNodes } from './nodes.mjs';

/// A texture that is read by texel.
function texels(numbers, width, height, format) {
    const type = numbers instanceof Uint32Array ? THREE.UnsignedIntType : THREE.FloatType;
    const made = new THREE.DataTexture(numbers, width, height, format, type);
    made.needsUpdate = true;
    return made;
}

/// The four results of a node for each query, a pixel each.
async function shaded(queries, node) {
    const renderer = new THREE.WebGPURenderer();
    await renderer.init();
    const count = queries.length;
    const numbers = new Float32Array(16 * count);
    queries.forEach(({ m, v, l, sigma, shape }, i) => {
        const rows = [m, v, l, [...sigma, shape]];
        rows.forEach((row, j) => numbers.set(row, 4 * (j * count + i)));
    });
    const places = texels(numbers, count, 4, THREE.RGBAFormat);
    const at = row => textureLoad(places, ivec2(int(screenCoordinate.x), row));
    const material = new THREE.NodeMaterial();
    material.fragmentNode =
        node({ m: at(0).xyz, v: at(1).xyz, l: at(2).xyz, sigma: at(3).xy, shape: at(3).z });
    const target = new THREE.RenderTarget(count, 1, { type: THREE.FloatType, depthBuffer: false });
    renderer.setRenderTarget(target);
    new THREE.QuadMesh(material).render(renderer);
    const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, count, 1);
    return queries.map((_, i) => [...pixels.slice(4 * i, 4 * i + 4)]);
}

/// D, G1 and E without tables.
window.shadeClosed = (text, queries) => {
    const nodes = closedNodes(text);
    return shaded(queries, ({ m, v, sigma, shape: gamma }) => vec4(
        nodes.d({ gamma, sigma, m }),
        nodes.masking({ gamma, sigma, w: v }),
        nodes.albedo({ gamma, sigma: sqrt(sigma.x.mul(sigma.y)), cos_theta: v.z }),
        0));
};

/// D, G1, E, and f from v to l, by tables in base 64; the shape is γ if they are of a family.
window.shadeLobes = (text, queries, { base64, width, height }, isFamily) => {
    const { buffer } = Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
    const tables = texture(isFamily
        ? texels(new Uint32Array(buffer), width, height, THREE.RedIntegerFormat)
        : texels(new Float32Array(buffer), width, height, THREE.RGFormat));
    const nodes = lobeNodes(text, isFamily);
    return shaded(queries, ({ m, v, l, sigma, shape }) => {
        const of = isFamily ? { gamma: shape } : { shape: uint(shape) };
        const lobe = nodes.lobe({ ...of, sigma, tables }).toVar();
        return vec4(
            nodes.d({ lobe, m }),
            nodes.masking({ lobe, w: v, tables }),
            nodes.albedo({ lobe, cos_theta: v.z, tables }),
            nodes.evalPdf({ lobe, v, l, tables }).x);
    });
};
