// Controls, the address of a view, and what tests call:
//     report.set({sigma: [x, y], gamma, metal, compensation, size, samples}) -> Promise
//         shows this, and resolves when exactly so many samples are there; what is left out stays.
//         gamma is that of a stop, metal a name of the list
//     report.pixels() -> Promise of RGBA of the canvas, from the lower left
//     report.state() -> what is shown, with the shape `drawn` whose normals are drawn, and the
//         number of shapes to choose from
//     report.lobe(degrees) -> Promise of f cos of the lobe, of GGX and of Beckmann at 721 lights
//         from -90 to 90 degrees, in fours of which the last is 1; whole degrees from 0 to 89

const $ = (id) => document.getElementById(id);
const controls = {
    material: $('material'), shape: $('shape'), x: $('sigma-x'), y: $('sigma-y'),
    link: $('sigma-link'), metal: $('metal'), compensation: $('compensation'),
};
const [SMALLEST, LARGEST] = data.sigma;
// Sliders have a hundred steps a decade.
const fromSlider = (slider) => SMALLEST * (LARGEST / SMALLEST) ** (slider.value / slider.max);
const toSlider = (slider, sigma) => {
    slider.value = slider.max * Math.log(sigma / SMALLEST) / Math.log(LARGEST / SMALLEST);
};
const short = (x) => String(Number(x.toPrecision(3)));
const gammaOf = (stop) => data.stops[stop].gamma ?? Infinity;
let state = { stop: 0, sigma: [0.3, 0.3], reflectance: 0, compensation: true };

function stopOf(gamma) {
    const off = (i) => Math.abs(1 / (gammaOf(i) - 1) - 1 / (gamma - 1));
    return data.stops.reduce((best, _, i) => (off(i) < off(best) ? i : best), 0);
}

// The controls say what the state is.
function tell() {
    const { stop, sigma, reflectance, compensation } = state, label = data.stops[stop].label;
    controls.shape.value = stop;
    if (controls.shape.type === 'range') controls.shape.setAttribute('aria-valuetext', label);
    $('shape-value').textContent = label;
    for (const [axis, value] of [['x', sigma[0]], ['y', sigma[1]]]) {
        const slider = controls[axis];
        if (Math.abs(fromSlider(slider) / value - 1) > 0.02) toSlider(slider, value);
        slider.setAttribute('aria-valuetext', short(value));
        $(`sigma-${axis}-value`).textContent = short(value);
    }
    controls.metal.value = reflectance;
    controls.compensation.checked = compensation;
    const named = data.materials.findIndex((it) => it.stop === stop
        && it.reflectance === reflectance && it.sigma.every((x, i) => x === sigma[i]));
    controls.material.value = named;
    for (const button of document.querySelectorAll('[data-material]')) {
        button.setAttribute('aria-pressed', Number(button.dataset.material) === named);
    }
    const round = sigma[0] === sigma[1];
    $('stand-in').hidden = round || !compensation;
    const [x, y] = sigma.map(short);
    const rough = round ? `σ\u00a0=\u00a0${x}` : `σx\u00a0=\u00a0${x}, σy\u00a0=\u00a0${y}`;
    const metal = data.reflectances[reflectance].name;
    const bounces = compensation ? 'with compensation' : 'one bounce';
    $('sphere').setAttribute('aria-label', `A sphere of ${metal}, ${label}, ${rough}, ${bounces}`);
    $('lobe-name').textContent = `${label}, ${rough}`;
}

function address() {
    const { stop, sigma, reflectance, compensation } = state;
    const at = new URLSearchParams({
        gamma: data.stops[stop].gamma ?? 'inf', sigma: sigma.map(short).join(),
        metal: data.reflectances[reflectance].name, bounces: compensation ? 'all' : 'one',
    });
    history.replaceState(null, '', `#${at}`);
}

// What is named replaces the state, where it is valid.
function merge({ sigma, gamma, metal, compensation }) {
    const next = { ...state };
    const inside = (x) => Math.min(Math.max(x, SMALLEST), LARGEST);
    if (sigma?.length === 2 && sigma.every(Number.isFinite)) next.sigma = sigma.map(inside);
    if (gamma > 1) next.stop = stopOf(gamma);
    const found = data.reflectances.findIndex(({ name }) => name === metal);
    if (found >= 0) next.reflectance = found;
    if (compensation !== undefined) next.compensation = compensation;
    return next;
}

function ofAddress() {
    const at = new URLSearchParams(location.hash.slice(1)), options = {};
    const gamma = at.get('gamma');
    if (gamma) options.gamma = gamma === 'inf' ? Infinity : Number(gamma);
    const sigma = at.get('sigma')?.split(',').map(Number);
    if (sigma) options.sigma = [sigma[0], sigma[1] ?? sigma[0]];
    options.metal = at.get('metal');
    if (at.has('bounces')) options.compensation = at.get('bounces') === 'all';
    return options;
}

function listen(sphere, plot) {
    let settled = 0;
    const update = (moving) => {
        tell();
        sphere.show(state, { moving });
        plot.draw(state);
        clearTimeout(settled);
        settled = setTimeout(() => {
            address();
            sphere.settle();
        }, moving ? 250 : 0);
    };
    const ofMaterial = (i) => {
        const { stop, sigma, reflectance } = data.materials[i];
        state = { ...state, stop, sigma: [...sigma], reflectance };
        controls.link.checked = sigma[0] === sigma[1];
        update(false);
    };
    controls.shape.addEventListener('input', () => {
        state = { ...state, stop: Number(controls.shape.value) };
        update(true);
    });
    for (const [i, axis] of ['x', 'y'].entries()) {
        controls[axis].addEventListener('input', () => {
            const value = Number(short(fromSlider(controls[axis])));
            const sigma = controls.link.checked ? [value, value] : state.sigma.with(i, value);
            state = { ...state, sigma };
            if (controls.link.checked) controls[i ? 'x' : 'y'].value = controls[axis].value;
            update(true);
        });
    }
    controls.link.addEventListener('change', () => {
        const [x] = state.sigma;
        if (controls.link.checked) state = { ...state, sigma: [x, x] };
        update(false);
    });
    controls.metal.addEventListener('change', () => {
        state = { ...state, reflectance: Number(controls.metal.value) };
        update(false);
    });
    controls.compensation.addEventListener('change', () => {
        state = { ...state, compensation: controls.compensation.checked };
        update(false);
    });
    controls.material.addEventListener('change', () => {
        if (controls.material.value >= 0) ofMaterial(Number(controls.material.value));
    });
    for (const button of document.querySelectorAll('[data-material]')) {
        button.addEventListener('click', () => {
            ofMaterial(Number(button.dataset.material));
            $('look').scrollIntoView({ block: 'nearest' });
        });
    }
    window.addEventListener('hashchange', () => {
        state = merge(ofAddress());
        update(false);
    });
    window.report = {
        async set({ size, samples, ...options }) {
            state = merge(options);
            tell();
            plot.draw(state);
            sphere.show(state, { size, samples });
            await sphere.done();
        },
        pixels: () => sphere.pixels(),
        state: () => ({
            sigma: state.sigma, gamma: gammaOf(state.stop), compensation: state.compensation,
            metal: data.reflectances[state.reflectance].name,
            drawn: gammaOf(data.stops[state.stop].drawn), shapes: data.stops.length,
        }),
        async lobe(degrees) {
            await plot.turn(degrees);
            return plot.values;
        },
    };
    return update;
}

async function begin() {
    if (!window.WebGL2RenderingContext || !window.DecompressionStream) return;
    const canvas = $('sphere');
    const probe = document.createElement('canvas').getContext('webgl2');
    if (!probe?.getExtension('EXT_color_buffer_float')) return;
    const { upload, averages } = await loadTables();
    const sphere = new Sphere(canvas, upload, averages);
    if (!sphere.start()) return;
    // What is drawn here, or pictures. The canvas has its place from the start, but the picture is
    // shown until the canvas is as clean, or shows something else.
    const still = $('sphere-still');
    const reveal = () => {
        still.hidden = true;
        canvas.classList.remove('waiting');
    };
    const live = (is) => {
        for (const it of ['sphere', 'sphere-controls', 'lobe-live']) $(it).hidden = !is;
        $('lobe-still').hidden = is;
        if (is) return;
        still.hidden = false;
        canvas.classList.add('waiting');
        $('sphere-samples').textContent = '';
    };
    live(true);
    const plot = new LobePlot($('lobe-live'), sphere);
    sphere.onprogress = (index, samples) => {
        const [size, enough] = [still.getAttribute('width'), still.dataset.samples].map(Number);
        const coarse = sphere.size < size;
        if (state !== opening || (index >= enough && !coarse)) reveal();
        $('sphere-samples').textContent = still.hidden ? `${index} of ${samples} samples`
            : coarse ? 'A picture; move a control, and the sphere is drawn live in fewer pixels'
                : `A picture; ${index} of ${enough} samples are drawn to replace it`;
    };
    const { stop, sigma, reflectance } = data.materials[data.opening];
    state = merge({ ...ofAddress() });
    if (!location.hash) state = { ...state, stop, sigma: [...sigma], reflectance };
    // The address may be that of another look, or that of the picture.
    const isPicture = state.stop === stop && state.reflectance === reflectance
        && state.compensation && state.sigma.every((x, i) => x === sigma[i]);
    const opening = isPicture ? state : null;
    controls.link.checked = state.sigma[0] === state.sigma[1];
    const update = listen(sphere, plot);
    update(false);

    canvas.addEventListener('webglcontextlost', (event) => {
        event.preventDefault();
        live(false);
    });
    canvas.addEventListener('webglcontextrestored', () => {
        sphere.strip = sphere.targets = undefined;
        if (!sphere.start()) return;
        live(true);
        update(false);
    });
    // What is not seen is not drawn.
    let inView = true;
    const look = () => {
        sphere.visible = inView && !document.hidden;
        sphere.wake();
    };
    new IntersectionObserver(([entry]) => {
        inView = entry.isIntersecting;
        look();
    }).observe(canvas);
    document.addEventListener('visibilitychange', look);
    let width = canvas.clientWidth;
    new ResizeObserver(() => {
        if (canvas.clientWidth !== width && !sphere.fixed) sphere.show(state);
        width = canvas.clientWidth;
    }).observe(canvas);
}

begin();
