// WebGL 2: programs, textures, and the page's packed tables.

const text = (id) => document.getElementById(id).textContent;
const data = JSON.parse(text('sphere-data'));

// Bytes of packed numbers; see data.rs.
async function unpacked(base64, bytes) {
    const deflated = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const stream = new Blob([deflated]).stream().pipeThrough(
        new DecompressionStream('deflate-raw'));
    const planes = new Uint8Array(await new Response(stream).arrayBuffer());
    const all = new Uint8Array(planes.length), count = planes.length / bytes;
    for (let i = 0; i < planes.length; i++) {
        all[(i % count) * bytes + Math.floor(i / count)] = planes[i];
    }
    return all.buffer;
}

class Program {
    constructor(gl, fragment) {
        this.gl = gl;
        // A triangle that covers the view.
        const vertex = `#version 300 es
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;
        const shader = (type, source) => {
            const it = gl.createShader(type);
            gl.shaderSource(it, source);
            gl.compileShader(it);
            return it;
        };
        this.program = gl.createProgram();
        const shaders = [shader(gl.VERTEX_SHADER, vertex), shader(gl.FRAGMENT_SHADER, fragment)];
        for (const it of shaders) gl.attachShader(this.program, it);
        gl.linkProgram(this.program);
        if (!gl.getProgramParameter(this.program, gl.LINK_STATUS) && !gl.isContextLost()) {
            const logs = shaders.map((it) => gl.getShaderInfoLog(it));
            throw new Error([gl.getProgramInfoLog(this.program), ...logs].join('\n'));
        }
        this.places = new Map();
    }

    // Sets a uniform by the name of the function that does, such as '2f'.
    set(name, kind, ...values) {
        const { gl, places } = this;
        if (!places.has(name)) places.set(name, gl.getUniformLocation(this.program, name));
        gl[`uniform${kind}`](places.get(name), ...values);
    }

    // Draws with textures by name, in the order of their units: [target, texture].
    draw(textures) {
        const { gl } = this;
        Object.entries(textures).forEach(([name, [target, texture]], unit) => {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(target, texture);
            this.set(name, '1i', unit);
        });
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
}

// A texture without mipmaps that is read by texel, or by a linear filter that clamps.
function texture(gl, target, filter, allocate) {
    const it = gl.createTexture();
    gl.bindTexture(target, it);
    allocate();
    const parameters = [[gl.TEXTURE_MIN_FILTER, filter], [gl.TEXTURE_MAG_FILTER, filter]];
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
        parameters.push([wrap, gl.CLAMP_TO_EDGE]);
    }
    for (const [name, value] of parameters) gl.texParameteri(target, name, value);
    return it;
}

// A texture of single precision that can be drawn to.
function target(gl, width, height) {
    const it = texture(gl, gl.TEXTURE_2D, gl.NEAREST,
        () => gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height));
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, it, 0);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    return { texture: it, frame };
}

// Sines and cosines of so many angles from -90 to 90 degrees, as a texture of a row.
function directions(gl, count) {
    const angle = (i) => Math.PI * (i / (count - 1) - 0.5);
    const pairs = Array.from({ length: count }, (_, i) => [Math.sin(angle(i)), Math.cos(angle(i))]);
    return texture(gl, gl.TEXTURE_2D, gl.NEAREST, () => gl.texImage2D(
        gl.TEXTURE_2D, 0, gl.RG32F, count, 1, 0, gl.RG, gl.FLOAT, new Float32Array(pairs.flat())));
}

// What is drawn in the present frame, without waiting for it; null if the context is lost.
async function read(gl, [width, height], type, array) {
    if (gl.isContextLost()) return null;
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, array.byteLength, gl.STREAM_READ);
    gl.readPixels(0, 0, width, height, gl.RGBA, type, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    for (;;) {
        if (gl.isContextLost()) return null;
        if (gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED) break;
        await new Promise((done) => setTimeout(done, 4));
    }
    gl.deleteSync(fence);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, array);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.deleteBuffer(buffer);
    return array;
}

// Tables and albedos, with what makes textures of them.
async function loadTables() {
    const [pairs, lost, averages] = await Promise.all(
        [[data.tables, 4], [data.lost, 2], [data.averages, 4]].map((it) => unpacked(...it)));
    const numbers = new Float32Array(pairs), { width, texels } = data;
    const height = numbers.length / 2 / width;
    const upload = (gl) => ({
        tables: texture(gl, gl.TEXTURE_2D, gl.NEAREST, () => gl.texImage2D(
            gl.TEXTURE_2D, 0, gl.RG32F, width, height, 0, gl.RG, gl.FLOAT, numbers)),
        lost: texture(gl, gl.TEXTURE_3D, gl.LINEAR, () => gl.texImage3D(
            gl.TEXTURE_3D, 0, gl.R16F, texels[1], texels[0], data.stops.length, 0, gl.RED,
            gl.HALF_FLOAT, new Uint16Array(lost))),
    });
    return { upload, averages: new Float32Array(averages) };
}
