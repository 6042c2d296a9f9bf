// The map of the network on a canvas: view, drawing and pointer input.
'use strict';

class MapView {
    constructor(canvas, network, onPick) {
        Object.assign(this, {canvas, network, onPick});
        this.ctx = canvas.getContext('2d');
        // Background image; redrawn only if the view or the marked street changes.
        this.roads = document.createElement('canvas');
        this.pointers = new Map();
        this.fitted = true;
        canvas.addEventListener('wheel', (event) => this.onWheel(event), {passive: false});
        canvas.addEventListener('pointerdown', (event) => this.onDown(event));
        canvas.addEventListener('pointermove', (event) => this.onMove(event));
        for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => this.onUp(event));
        new ResizeObserver(() => this.resize()).observe(canvas);
        this.resize();
    }

    resize() {
        const ratio = window.devicePixelRatio || 1;
        const {clientWidth, clientHeight} = this.canvas;
        for (const canvas of [this.canvas, this.roads]) {
            canvas.width = Math.max(1, Math.round(clientWidth * ratio));
            canvas.height = Math.max(1, Math.round(clientHeight * ratio));
        }
        this.ratio = ratio;
        if (this.fitted) this.fit();
        this.changed();
    }

    fit() {
        const [x0, y0, x1, y1] = this.network.bounds;
        const MARGIN = 1.06;
        const {width, height} = this.canvas;
        this.scale = Math.min(width / (MARGIN * (x1 - x0) + 10), height / (MARGIN * (y1 - y0) + 10));
        this.centre = [(x0 + x1) / 2, (y0 + y1) / 2];
        this.fitted = true;
        this.changed();
    }

    // Marks the view as changed: the next draw() redraws the roads.
    changed() {
        this.stale = true;
        if (this.onChange) this.onChange();
    }

    toWorld(x, y) {
        return [this.centre[0] + (x - this.canvas.width / 2) / this.scale,
                this.centre[1] - (y - this.canvas.height / 2) / this.scale];
    }

    zoom(factor, x = this.canvas.width / 2, y = this.canvas.height / 2) {
        const [wx, wy] = this.toWorld(x, y);
        this.scale = Math.min(Math.max(this.scale * factor, 0.02), 200);
        const [nx, ny] = this.toWorld(x, y);
        this.centre = [this.centre[0] + wx - nx, this.centre[1] + wy - ny];
        this.fitted = false;
        this.changed();
    }

    lookAt(x, y) {
        this.centre = [x, y];
        this.fitted = false;
        this.changed();
    }

    setTransform(ctx) {
        const {width, height} = this.canvas;
        const s = this.scale;
        ctx.setTransform(s, 0, 0, -s, width / 2 - s * this.centre[0], height / 2 + s * this.centre[1]);
    }

    // Draws the state at `share` (0 to 1) of the time between two frames. Marks `street`, and the vehicle with the
    // number `selected` (-1: none). `linkColours` has a colour for each kind of links.
    draw(from, to, share, frame_s, mode, street, selected, linkColours) {
        const {ctx} = this;
        if (this.stale || this.drawnStreet !== street) this.drawRoads(street);
        ctx.setTransform(1, 0, 0, 1, 0, 0);
        ctx.drawImage(this.roads, 0, 0);
        if (!from) return;
        this.setTransform(ctx);
        this.linkedVehicles = new Map();  // from the number of a vehicle with a link to its centre
        for (const link of from.links) {
            for (const number of [link.vehicle, link.other]) this.linkedVehicles.set(number, null);
        }
        this.drawVehicles(from, to, share, frame_s, mode, selected);
        this.drawLinks(from.links, linkColours);
        this.network.drawLights(ctx, this.scale, from.lights);
    }

    drawRoads(street) {
        const ctx = this.roads.getContext('2d');
        ctx.setTransform(1, 0, 0, 1, 0, 0);
        ctx.fillStyle = '#f7f8fa';
        ctx.fillRect(0, 0, this.roads.width, this.roads.height);
        this.setTransform(ctx);
        this.network.drawRoads(ctx, this.scale);
        ctx.strokeStyle = '#8a5a9e';  // marks the street of the time-space diagram
        ctx.lineWidth = 1.5 * this.ratio / this.scale;
        ctx.beginPath();
        for (const {lane} of street.pieces) {
            const {numbers} = lane.shape;
            for (let k = 0; k < numbers.length; k += 2) {
                if (k === 0) ctx.moveTo(numbers[k], numbers[k + 1]);
                else ctx.lineTo(numbers[k], numbers[k + 1]);
            }
        }
        ctx.stroke();
        this.stale = false;
        this.drawnStreet = street;
    }

    drawVehicles(from, to, share, frame_s, mode, selected) {
        const {ctx, scale} = this;
        const paths = mode.colours.map(() => new Path2D());
        // Rectangles of axis-parallel vehicles; fillRect is faster than a path.
        const boxes = mode.colours.map(() => []);
        const half_m = Math.max(VEHICLE_WIDTH_M, 2.2 * this.ratio / scale) / 2;
        const [left, top] = this.toWorld(-20, -20);
        const [right, bottom] = this.toWorld(this.canvas.width + 20, this.canvas.height + 20);
        let mark = null;
        this.drawnVehicles = [];  // x, y and number of each vehicle in view, for pick()
        interpolate(this.network, from, to, share, frame_s, (k, [fx, fy, rx, ry]) => {
            if (this.linkedVehicles.has(from.number[k])) {
                this.linkedVehicles.set(from.number[k], [(fx + rx) / 2, (fy + ry) / 2]);
            }
            if (fx < left || fx > right || fy > top || fy < bottom) return;
            const length = Math.hypot(fx - rx, fy - ry) || 1;
            const [nx, ny] = [-(fy - ry) / length * half_m, (fx - rx) / length * half_m];
            const colour = mode.of(from, k);
            if (Math.abs(nx * ny) < 1e-6) {
                const [wide, high] = [Math.abs(nx), Math.abs(ny)];
                boxes[colour].push(Math.min(fx, rx) - wide, Math.min(fy, ry) - high,
                                   Math.abs(fx - rx) + 2 * wide, Math.abs(fy - ry) + 2 * high);
            } else {
                const path = paths[colour];
                path.moveTo(fx + nx, fy + ny);
                path.lineTo(fx - nx, fy - ny);
                path.lineTo(rx - nx, ry - ny);
                path.lineTo(rx + nx, ry + ny);
                path.closePath();
            }
            this.drawnVehicles.push((fx + rx) / 2, (fy + ry) / 2, from.number[k]);
            if (from.number[k] === selected) mark = [(fx + rx) / 2, (fy + ry) / 2, length / 2];
        });
        paths.forEach((path, k) => {
            ctx.fillStyle = mode.colours[k];
            ctx.fill(path);
            for (let n = 0, box = boxes[k]; n < box.length; n += 4) ctx.fillRect(box[n], box[n + 1], box[n + 2], box[n + 3]);
        });
        if (!mark) return;
        ctx.beginPath();
        ctx.arc(mark[0], mark[1], mark[2] + 5 * this.ratio / scale, 0, 2 * Math.PI);
        ctx.strokeStyle = '#111820';
        ctx.lineWidth = 2 * this.ratio / scale;
        ctx.stroke();
    }

    // Marks each vehicle at the start of a link with a ring, and draws a line to the other vehicle. Without one, the
    // line ends at the start of the lane.
    drawLinks(links, colours) {
        const {ctx, scale} = this;
        const pixel = this.ratio / scale;
        for (const {kind, vehicle, other, lane} of links) {
            const from = this.linkedVehicles.get(vehicle);
            if (!from) continue;
            let to = this.linkedVehicles.get(other);
            if (!to && lane >= 0) to = this.network.lanes[lane].shape.numbers.slice(0, 2);
            ctx.strokeStyle = ctx.fillStyle = colours[kind];
            ctx.lineWidth = Math.max(1.5 * pixel, 0.4);
            ctx.beginPath();
            ctx.arc(from[0], from[1], Math.max(4 * pixel, 2.2), 0, 2 * Math.PI);
            ctx.stroke();
            if (!to) continue;
            ctx.setLineDash([4 * pixel, 3 * pixel]);
            ctx.beginPath();
            ctx.moveTo(from[0], from[1]);
            ctx.lineTo(to[0], to[1]);
            ctx.stroke();
            ctx.setLineDash([]);
            ctx.beginPath();
            ctx.arc(to[0], to[1], Math.max(2 * pixel, 0.9), 0, 2 * Math.PI);
            ctx.fill();
        }
    }

    // Returns the number of the vehicle nearest to a point in canvas pixels, or -1 if no vehicle is near.
    pick(x, y) {
        const [wx, wy] = this.toWorld(x, y);
        let nearest_m = Math.max(4, 9 * this.ratio / this.scale);
        let found = -1;
        for (let k = 0; k < (this.drawnVehicles || []).length; k += 3) {
            const distance_m = Math.hypot(this.drawnVehicles[k] - wx, this.drawnVehicles[k + 1] - wy);
            if (distance_m < nearest_m) [nearest_m, found] = [distance_m, this.drawnVehicles[k + 2]];
        }
        return found;
    }

    // Returns the position of a pointer event in canvas pixels.
    at(event) {
        const box = this.canvas.getBoundingClientRect();
        return [(event.clientX - box.left) * this.ratio, (event.clientY - box.top) * this.ratio];
    }

    onWheel(event) {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY * 0.0015), ...this.at(event));
    }

    onDown(event) {
        this.canvas.setPointerCapture(event.pointerId);
        this.pointers.set(event.pointerId, this.at(event));
        this.movedPixels = this.pointers.size > 1 ? Infinity : 0;
    }

    onMove(event) {
        const before = this.pointers.get(event.pointerId);
        if (!before) return;
        const now = this.at(event);
        const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
        this.pointers.set(event.pointerId, now);
        if (others.length > 0) {
            const span = (at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]);
            this.zoom(span(now) / Math.max(span(before), 1), ...others[0]);
            return;
        }
        const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
        this.movedPixels += Math.hypot(dx, dy);
        this.lookAt(this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale);
    }

    onUp(event) {
        if (!this.pointers.delete(event.pointerId)) return;
        const MAX_CLICK_PX = 4;
        const isClick = event.type === 'pointerup' && this.movedPixels < MAX_CLICK_PX * this.ratio;
        if (isClick) this.onPick(this.pick(...this.at(event)));
    }
}
