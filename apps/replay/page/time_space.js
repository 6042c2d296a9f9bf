// The time-space diagram of one street: trajectories from 100 s before to 20 s after the current time, with red and
// yellow at the stop lines.
'use strict';

const PAST_S = 100;
const FUTURE_S = 20;

class TimeSpace {
    constructor(canvas, recording, onSeek) {
        Object.assign(this, {canvas, recording});
        this.ctx = canvas.getContext('2d');
        this.strips = new Map();  // from section number to a canvas with its trajectories
        new ResizeObserver(() => this.resize()).observe(canvas);
        canvas.addEventListener('click', (event) => {
            const box = canvas.getBoundingClientRect();
            const x = (event.clientX - box.left) * this.ratio;
            if (x > this.plot.x) onSeek(this.now_s - PAST_S + (x - this.plot.x) / this.perSecond);
        });
        this.resize();
    }

    resize() {
        this.ratio = window.devicePixelRatio || 1;
        this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * this.ratio));
        this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * this.ratio));
        const [left, top, bottom] = [52, 8, 34].map((px) => px * this.ratio);
        this.plot = {x: left, y: top, width: this.canvas.width - left - 4, height: this.canvas.height - top - bottom};
        this.perSecond = this.plot.width / (PAST_S + FUTURE_S);
        this.clearStrips();
    }

    clearStrips() {
        this.strips.clear();
        if (this.onChange) this.onChange();
    }

    show(street, mode) {
        Object.assign(this, {street, mode});
        this.clearStrips();
    }

    draw(now_s) {
        const {ctx, plot, recording} = this;
        this.now_s = now_s;
        ctx.fillStyle = '#ffffff';
        ctx.fillRect(0, 0, this.canvas.width, this.canvas.height);
        const frames = [now_s - PAST_S, now_s + FUTURE_S].map((time_s) =>
            Math.min(Math.max(Math.floor(recording.frameAt(time_s)), 0), recording.frameCount - 1));
        ctx.save();
        ctx.beginPath();
        ctx.rect(plot.x, plot.y, plot.width, plot.height);
        ctx.clip();
        for (let section = recording.sectionOf(frames[0]); section <= recording.sectionOf(frames[1]); ++section) {
            const strip = this.strip(section);
            if (!strip) continue;
            const begin_s = recording.time_s(recording.payload.starts[section] - 1);
            ctx.drawImage(strip, Math.round(plot.x + (begin_s - now_s + PAST_S) * this.perSecond), plot.y);
        }
        ctx.restore();
        this.drawAxes(now_s);
    }

    // Returns a canvas with the trajectories of a section. If its frames are not unpacked yet, starts to unpack them
    // and returns null.
    strip(section) {
        if (this.strips.has(section)) return this.strips.get(section);
        const {recording} = this;
        const frames = recording.ready.get(section);
        const previousFrames = recording.ready.get(section - 1);  // the trajectories start at the last of these frames
        if (!frames || (section > 0 && !previousFrames)) {
            recording.load(section);
            recording.load(section - 1);
            return null;
        }
        const strip = this.drawStrip([previousFrames ? previousFrames[previousFrames.length - 1] : null, ...frames]);
        this.strips.set(section, strip);
        const MAX_STRIPS = 8;
        if (this.strips.size > MAX_STRIPS) this.strips.delete(this.strips.keys().next().value);
        return strip;
    }

    drawStrip(frames) {
        const strip = document.createElement('canvas');
        const perFrame = this.recording.head.frame_s * this.perSecond;
        strip.width = Math.ceil(frames.length * perFrame) + 1;
        strip.height = this.plot.height;
        const ctx = strip.getContext('2d');
        const y = (distance_m) => this.plot.height * (1 - distance_m / this.street.length_m);
        const paths = this.mode.colours.map(() => new Path2D());
        let previous_m = new Map();  // from vehicle to its distance along the street in the previous frame
        frames.forEach((frame, n) => {
            const now_m = new Map();
            for (let k = 0; frame && k < frame.number.length; ++k) {
                const from_m = this.street.from.get(frame.lane[k]);
                if (from_m === undefined) continue;
                const at_m = from_m + frame.position_m[k];
                now_m.set(frame.number[k], at_m);
                const last_m = previous_m.get(frame.number[k]);
                if (last_m === undefined || last_m > at_m + 1) continue;
                const path = paths[this.mode.of(frame, k)];
                path.moveTo((n - 1) * perFrame, y(last_m));
                path.lineTo(n * perFrame, y(at_m));
            }
            previous_m = now_m;
        });
        ctx.lineWidth = this.ratio;
        paths.forEach((path, k) => {
            ctx.strokeStyle = this.mode.colours[k];
            ctx.stroke(path);
        });
        this.drawLights(ctx, frames, perFrame, y);
        return strip;
    }

    drawLights(ctx, frames, perFrame, y) {
        const thick = 3 * this.ratio;
        for (const {lane, from_m} of this.street.pieces) {
            if (lane.signal_group === undefined) continue;
            const line = y(from_m + lane.stop_line_m);
            frames.forEach((frame, n) => {
                const light = frame ? frame.lights[lane.signal_group] : 1;
                if (light === 1) return;
                ctx.fillStyle = LIGHT_COLOURS[light];
                ctx.fillRect(n * perFrame, line - thick / 2, perFrame + 0.5, thick);
            });
        }
    }

    drawAxes(now_s) {
        const {ctx, plot} = this;
        ctx.strokeStyle = '#8b96a1';
        ctx.lineWidth = this.ratio;
        ctx.strokeRect(plot.x, plot.y, plot.width, plot.height);
        const now_x = plot.x + PAST_S * this.perSecond;
        ctx.strokeStyle = '#111820';
        ctx.beginPath();
        ctx.moveTo(now_x, plot.y);
        ctx.lineTo(now_x, plot.y + plot.height);
        ctx.stroke();
        ctx.fillStyle = '#3c4650';
        ctx.font = `${11 * this.ratio}px system-ui, sans-serif`;
        ctx.textAlign = 'center';
        const STEP_S = 20;
        for (let time_s = Math.ceil((now_s - PAST_S) / STEP_S) * STEP_S; time_s <= now_s + FUTURE_S; time_s += STEP_S) {
            if (time_s < 0 || time_s > now_s + FUTURE_S - 5) continue;
            ctx.fillText(`${time_s}`, plot.x + (time_s - now_s + PAST_S) * this.perSecond, plot.y + plot.height + 13 * this.ratio);
        }
        ctx.fillText('time (s)', plot.x + plot.width / 2, plot.y + plot.height + 28 * this.ratio);
        ctx.textAlign = 'right';
        const step_m = [100, 200, 500, 1000, 2000, 5000].find((step) => this.street.length_m <= 10 * step) ?? 10000;
        for (let at_m = 0; at_m <= this.street.length_m; at_m += step_m) {
            const y = plot.y + plot.height * (1 - at_m / this.street.length_m);
            ctx.fillText(`${at_m}`, plot.x - 4 * this.ratio, y + 4 * this.ratio);
        }
        ctx.save();
        ctx.translate(10 * this.ratio, plot.y + plot.height / 2);
        ctx.rotate(-Math.PI / 2);
        ctx.textAlign = 'center';
        ctx.fillText('distance along the street (m)', 0, 0);
        ctx.restore();
    }
}
