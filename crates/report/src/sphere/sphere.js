// The sphere: samples are added until there are enough.

const ENOUGH = 512;
const SMOOTH = 22;      // milliseconds of a frame that leave room for more samples
const PREVIEW = 45;     // most milliseconds of a sample while something is changed
const SIZES = [640, 512, 400, 320, 240, 160, 112];

class Sphere {
    constructor(canvas, tables, averages) {
        this.canvas = canvas;
        this.averages = averages;
        this.uploads = tables;
        this.cost = 1e-4;       // milliseconds of a sample of a pixel, as measured
        this.batch = 1;         // samples of a frame
        this.waiting = [];
        this.visible = true;
        this.onprogress = () => {};
    }

    // False where the browser cannot.
    start() {
        const gl = this.gl ?? this.canvas.getContext('webgl2', {
            alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true,
        });
        if (!gl || !gl.getExtension('EXT_color_buffer_float')) return false;
        this.gl = gl;
        const head = '#version 300 es\nprecision highp float;\nprecision highp int;\n';
        const module = `${head}${text('sphere-module')}`;
        this.program = new Program(gl, module + text('sphere-scene'));
        this.lobes = new Program(gl, module + text('sphere-lobe'));
        this.present = new Program(gl, text('sphere-present'));
        this.textures = this.uploads(gl);
        this.size = 0;
        this.drawing = null;
        return true;
    }

    // The uniforms of a material, see state() in controls.js.
    uniforms({ stop, sigma, reflectance, compensation }) {
        const { eta, k, average } = data.reflectances[reflectance];
        const lost = this.lostAverage(stop, Math.sqrt(sigma[0] * sigma[1]));
        // Kulla & Conty 2017, with the square that counts the first bounce; over pi.
        const returned = average.map((f) => f * f * (1 - lost) / (1 - f * lost) / lost / Math.PI);
        const { shape, gamma, drawn } = data.stops[stop];
        return [
            ['shape', '1ui', shape],
            ['drawn', '1ui', data.stops[drawn].shape],
            ['sigma', '2f', ...sigma],
            ['metal_eta', '3f', ...eta],
            ['metal_k', '3f', ...k],
            ['compensated', '1f', compensation ? 1 : 0],
            ['returned', '3f', ...returned],
            ['gamma', '1f', gamma ?? 1e30],
            ['layer', '1f', (stop + 0.5) / data.stops.length],
        ];
    }

    // 1 - E_avg, by the power of sigma between two nodes.
    lostAverage(stop, sigma) {
        const count = data.average_count;
        const at = Math.sqrt(sigma / data.sigma[1]) * count;
        const i = Math.min(Math.max(Math.floor(at), 1), count - 1);
        const w = Math.log(at / i) / Math.log((i + 1) / i);
        const [a, b] = [i - 1, i].map((j) => this.averages[stop * count + j]);
        return Math.exp(a + w * (b - a));
    }

    // Another material. What is dragged is shown at once, in fewer pixels if it has to be.
    show(state, { moving = false, size = 0, samples = ENOUGH } = {}) {
        this.state = state;
        this.moving = moving;
        this.fixed = size;
        this.samples = samples;
        for (const { fail } of this.waiting.splice(0)) fail(new Error('shown something else'));
        this.restart();
    }

    // What was dragged has come to rest.
    settle() {
        this.moving = false;
        if (!this.fixed && this.wanted() !== this.size) this.restart();
    }

    // Resolves when all samples are there.
    done() {
        return new Promise((done, fail) => {
            this.waiting.push({ done, fail });
            this.wake();
        });
    }

    wanted() {
        if (this.fixed) return this.fixed;
        const shown = this.canvas.clientWidth * Math.min(window.devicePixelRatio, 2);
        const most = this.moving ? PREVIEW : 4 * PREVIEW;
        const fits = SIZES.filter((size, i) => size <= shown || i === SIZES.length - 1);
        return fits.find((size) => size * size * this.cost <= most) ?? fits.at(-1);
    }

    restart() {
        if (!this.gl || this.gl.isContextLost()) return;
        const { gl } = this, size = this.wanted();
        if (size !== this.size) {
            for (const it of this.targets ?? []) {
                gl.deleteTexture(it.texture);
                gl.deleteFramebuffer(it.frame);
            }
            this.targets = [target(gl, size, size), target(gl, size, size)];
            this.canvas.width = this.canvas.height = this.size = size;
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[0].frame);
        gl.clear(gl.COLOR_BUFFER_BIT);
        this.index = 0;
        this.wake();
    }

    wake() {
        const wanted = this.visible || this.waiting.length > 0;
        const left = this.drawing || this.index < this.samples;
        if (this.request || !wanted || !left) return;
        this.request = requestAnimationFrame(() => {
            this.request = 0;
            if (!this.gl.isContextLost() && this.isDone()) this.frame();
            this.wake();
        });
    }

    // Whether what was drawn last is there. Nothing waits for it: how long that took says how much
    // can be drawn in a frame.
    isDone() {
        const { gl, drawing } = this;
        if (!drawing) return true;
        if (gl.getSyncParameter(drawing.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
        gl.deleteSync(drawing.fence);
        this.drawing = null;
        const took = performance.now() - drawing.begin;
        this.cost += (took / drawing.work - this.cost) * (took > PREVIEW ? 0.8 : 0.3);
        if (took < SMOOTH) this.batch = Math.min(2 * this.batch, 16);
        else if (took > 2 * SMOOTH) this.batch = Math.ceil(this.batch / 2);
        if (drawing.of !== this.state) return true;
        this.onprogress(this.index, this.samples);
        if (this.index >= this.samples) for (const { done } of this.waiting.splice(0)) done();
        else if (!this.fixed && this.index < 8 && this.wanted() < this.size) this.restart();
        return true;
    }

    // A few samples more, and what there is of the picture.
    frame() {
        const { gl, program, size } = this;
        const count = Math.min(this.batch, this.samples - this.index);
        if (count <= 0) return;
        const begin = performance.now();
        gl.viewport(0, 0, size, size);
        gl.useProgram(program.program);
        for (const it of this.uniforms(this.state)) program.set(...it);
        program.set('seed', '1ui', 0);
        program.set('size', '1f', size);
        for (let i = 0; i < count; i++) {
            const [from, to] = this.targets;
            gl.bindFramebuffer(gl.FRAMEBUFFER, to.frame);
            program.set('index', '1ui', this.index++);
            program.draw({
                student_t_tables: [gl.TEXTURE_2D, this.textures.tables],
                lost: [gl.TEXTURE_3D, this.textures.lost],
                before: [gl.TEXTURE_2D, from.texture],
            });
            this.targets = [to, from];
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.useProgram(this.present.program);
        this.present.draw({ sum: [gl.TEXTURE_2D, this.targets[0].texture] });
        const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        this.drawing = { fence, begin, work: count * size * size, of: this.state };
    }

    // The canvas as RGBA, from the lower left; a promise of it.
    pixels() {
        const { gl, size } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        return read(gl, [size, size], gl.UNSIGNED_BYTE, new Uint8Array(4 * size * size));
    }

    // f cos of a state, of GGX and of Beckmann at so many lights, in fours; a promise
    // of them, or of null while the context is lost.
    async lobe({ stop, sigma }, view, count) {
        const { gl, lobes } = this;
        if (gl.isContextLost()) return null;
        this.strip ??= { ...target(gl, count, 1), lights: directions(gl, count) };
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.strip.frame);
        gl.viewport(0, 0, count, 1);
        gl.useProgram(lobes.program);
        lobes.set('shape', '1ui', data.stops[stop].shape);
        lobes.set('ggx', '1ui', data.ggx);
        lobes.set('beckmann', '1ui', data.beckmann);
        lobes.set('sigma', '2f', ...sigma);
        lobes.set('view', '2f', Math.sin(view), Math.cos(view));
        lobes.draw({
            student_t_tables: [gl.TEXTURE_2D, this.textures.tables],
            lights: [gl.TEXTURE_2D, this.strip.lights],
        });
        return read(gl, [count, 1], gl.FLOAT, new Float32Array(4 * count));
    }
}
