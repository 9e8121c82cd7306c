// The lobe in the plane of incidence, with a view that can be dragged.

const LIGHTS = 721;
const REACH = 150;      // length of the longest arrow, in units of the drawing

class LobePlot {
    constructor(figure, sphere) {
        this.figure = figure;
        this.sphere = sphere;
        this.handle = figure.querySelector('[role=slider]');
        this.curves = ['shape', 'ggx', 'beckmann'].map((name) => figure.querySelector(`.of-${name}`));
        this.degrees = 45;
        const svg = figure.querySelector('svg');
        svg.addEventListener('pointerdown', (event) => {
            svg.setPointerCapture(event.pointerId);
            this.handle.focus({ preventScroll: true });
            this.drag(svg, event);
            event.preventDefault();
        });
        svg.addEventListener('pointermove', (event) => {
            if (svg.hasPointerCapture(event.pointerId)) this.drag(svg, event);
        });
        const steps = { ArrowLeft: 1, ArrowUp: 1, ArrowRight: -1, ArrowDown: -1,
            PageUp: 10, PageDown: -10, Home: -90, End: 90 };
        this.handle.addEventListener('keydown', (event) => {
            if (!(event.key in steps)) return;
            event.preventDefault();
            this.turn(this.degrees + steps[event.key]);
        });
    }

    drag(svg, { clientX, clientY }) {
        const at = new DOMPoint(clientX, clientY).matrixTransform(svg.getScreenCTM().inverse());
        this.turn(Math.atan2(Math.max(-at.x, 0), Math.max(-at.y, 1e-6)) * 180 / Math.PI);
    }

    turn(degrees) {
        this.degrees = Math.min(Math.max(Math.round(degrees), 0), 89);
        this.draw();
    }

    draw(state = this.state) {
        this.state = state;
        const view = this.degrees * Math.PI / 180;
        const all = this.sphere.lobe(state, view, LIGHTS);
        if (!all) return;
        this.values = all;
        let most = 0;
        for (let i = 0; i < LIGHTS; i++) for (let j = 0; j < 3; j++) most = Math.max(most, all[4 * i + j]);
        this.curves.forEach((curve, j) => {
            const points = [];
            for (let i = 0; i < LIGHTS; i++) {
                const angle = Math.PI * (i / (LIGHTS - 1) - 0.5);
                const r = most > 0 ? REACH * all[4 * i + j] / most : 0;
                points.push(`${(r * Math.sin(angle)).toFixed(2)},${(-r * Math.cos(angle)).toFixed(2)}`);
            }
            curve.setAttribute('points', points.join(' '));
        });
        const [x, y] = [-Math.sin(view), -Math.cos(view)].map((at) => at * REACH);
        this.figure.querySelector('.of-view').setAttribute('d', `M0 0L${x} ${y}`);
        this.handle.setAttribute('transform', `translate(${x} ${y})`);
        this.handle.setAttribute('aria-valuenow', this.degrees);
        this.handle.setAttribute('aria-valuetext', `${this.degrees} degrees`);
        this.figure.querySelector('.of-angle').textContent = `θ = ${this.degrees}°`;
        this.figure.querySelector('.of-scale').textContent = most.toPrecision(3);
    }
}
