// The lobe in the plane of incidence, with a view that can be dragged.

const LIGHTS = 721;
const REACH = 150;      // length of the longest arrow, in units of the drawing

class LobePlot {
    constructor(figure, sphere) {
        this.figure = figure;
        this.sphere = sphere;
        this.handle = figure.querySelector('[role=slider]');
        const names = ['shape', 'ggx', 'beckmann'];
        this.curves = names.map((name) => figure.querySelector(`.of-${name}`));
        this.degrees = 45;
        const svg = figure.querySelector('svg');
        // A finger elsewhere scrolls. Browsers do not heed touch-action within a drawing.
        this.handle.addEventListener('touchstart', (event) => event.preventDefault(),
            { passive: false });
        svg.addEventListener('pointerdown', (event) => {
            if (event.pointerType === 'touch' && !this.handle.contains(event.target)) return;
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
        return this.draw();
    }

    // Draws a state; while one is being computed, only the latest of those that follow is drawn.
    draw(state = this.state) {
        this.state = state;
        this.again = true;
        this.place(this.degrees);
        this.drawing ??= this.work().finally(() => { this.drawing = null; });
        return this.drawing;
    }

    async work() {
        while (this.again) {
            this.again = false;
            const { degrees } = this;
            const all = await this.sphere.lobe(this.state, degrees * Math.PI / 180, LIGHTS);
            if (all) this.show(all);
        }
    }

    place(degrees) {
        const view = degrees * Math.PI / 180;
        const [x, y] = [-Math.sin(view), -Math.cos(view)].map((at) => (at * REACH).toFixed(2));
        this.figure.querySelector('.of-view').setAttribute('d', `M0 0L${x} ${y}`);
        this.handle.setAttribute('transform', `translate(${x} ${y})`);
        this.handle.setAttribute('aria-valuenow', degrees);
        this.handle.setAttribute('aria-valuetext', `${degrees} degrees`);
        this.figure.querySelector('.of-angle').textContent = `θ\u00a0=\u00a0${degrees}°`;
    }

    show(all) {
        this.values = all;
        let most = 0;
        for (let i = 0; i < 4 * LIGHTS; i++) if (i % 4 < 3) most = Math.max(most, all[i]);
        this.curves.forEach((curve, j) => {
            const points = [];
            for (let i = 0; i < LIGHTS; i++) {
                const angle = Math.PI * (i / (LIGHTS - 1) - 0.5);
                const r = most > 0 ? REACH * all[4 * i + j] / most : 0;
                const at = [r * Math.sin(angle), -r * Math.cos(angle)];
                points.push(at.map((x) => x.toFixed(2)).join());
            }
            curve.setAttribute('points', points.join(' '));
        });
        this.figure.querySelector('.of-scale').textContent = Number(most.toPrecision(3));
    }
}
