// The network as it was recorded, where vehicles are on it, and how both are drawn. World coordinates: metres, y upwards.
'use strict';

const VEHICLE_WIDTH_M = 1.8;

class Shape {
    constructor(numbers) {
        this.numbers = numbers;
        this.along_m = [0];  // of each point
        for (let k = 2; k < numbers.length; k += 2) {
            const step = Math.hypot(numbers[k] - numbers[k - 2], numbers[k + 1] - numbers[k - 1]);
            this.along_m.push(this.along_m[this.along_m.length - 1] + step);
        }
        this.length_m = this.along_m[this.along_m.length - 1];
    }
    // Into out[at] and out[at + 1]: the point at a distance, continued straight beyond the ends.
    place(distance_m, out, at) {
        const {numbers, along_m} = this;
        let k = 1;
        while (k + 1 < along_m.length && along_m[k] < distance_m) ++k;
        const share = (distance_m - along_m[k - 1]) / (along_m[k] - along_m[k - 1]);
        const from = 2 * k - 2;
        out[at] = numbers[from] + share * (numbers[from + 2] - numbers[from]);
        out[at + 1] = numbers[from + 1] + share * (numbers[from + 3] - numbers[from + 1]);
    }
}

class Network {
    constructor(head) {
        this.lanes = head.lanes.map((lane, number) => ({...lane, number, shape: new Shape(lane.shape)}));
        this.entries = head.entries.length ? head.entries : this.beginnings();
        this.laneWidth_m = head.lane_width_m;
        this.lines = this.lanes.filter((lane) => lane.signal_group !== undefined);
        this.roads = new Path2D();
        this.inside = new Path2D();
        this.bounds = [Infinity, Infinity, -Infinity, -Infinity];
        for (const lane of this.lanes) this.add(lane);
    }

    // Of a network that tells no entries: lanes to which no other leads, or all of them.
    beginnings() {
        const reached = new Set(this.lanes.flatMap((lane) => lane.next));
        const outside = this.lanes.filter((lane) => lane.origin === undefined);
        const first = outside.filter((lane) => !reached.has(lane.number));
        return (first.length ? first : outside).map((lane) => lane.number);
    }

    add(lane) {
        const path = lane.origin === undefined ? this.roads : this.inside;
        const {numbers} = lane.shape;
        for (let k = 0; k < numbers.length; k += 2) {
            const [x, y] = [numbers[k], numbers[k + 1]];
            if (k === 0) path.moveTo(x, y);
            else path.lineTo(x, y);
            const b = this.bounds;
            [b[0], b[1], b[2], b[3]] = [Math.min(b[0], x), Math.min(b[1], y), Math.max(b[2], x), Math.max(b[3], y)];
        }
    }

    // Front and rear of all vehicles of a frame: x, y, x, y for each.
    points(frame) {
        if (frame.points) return frame.points;
        const points = new Float32Array(4 * frame.number.length);
        for (let k = 0; k < frame.number.length; ++k) this.locate(frame, k, points);
        frame.points = points;
        return points;
    }

    locate(frame, k, points) {
        let lane = this.lanes[frame.lane[k]];
        let before = frame.before[k];
        let front_m = lane.shape_start_m + frame.position_m[k];
        // Behind the stop line it is on its own path already, which shares that stretch with others.
        if (lane.stop_line_m !== undefined && frame.position_m[k] > lane.stop_line_m && frame.next[k] >= 0) {
            before = lane.number;
            front_m = frame.position_m[k] - lane.stop_line_m;
            lane = this.lanes[frame.next[k]];
        }
        lane.shape.place(front_m, points, 4 * k);
        const rear_m = front_m - frame.length_m[k];
        const behind = before >= 0 && rear_m < 0 ? this.lanes[before] : null;
        if (behind && behind.next.includes(lane.number)) {
            const end_m = behind.stop_line_m !== undefined ? behind.stop_line_m : behind.shape.length_m;
            behind.shape.place(end_m + rear_m, points, 4 * k + 2);
        } else {
            lane.shape.place(rear_m, points, 4 * k + 2);
        }
    }

    // Lanes that follow each other straight on, with the distance at which each begins.
    street(entry) {
        const street = [];
        const seen = new Set();
        let from_m = 0;
        for (let number = entry; number !== undefined && !seen.has(number);) {
            const lane = this.lanes[number];
            seen.add(number);
            street.push({lane, from_m});
            from_m += lane.length_m;
            number = lane.next.find((each) => (this.lanes[each].turn || 'straight') === 'straight');
        }
        return {pieces: street, length_m: from_m, from: new Map(street.map((each) => [each.lane.number, each.from_m]))};
    }

    drawRoads(ctx, scale) {
        ctx.lineCap = 'butt';
        ctx.lineJoin = 'round';
        const width = Math.max(this.laneWidth_m, 1.2 / scale);
        for (const [path, colour] of [[this.inside, '#dde2e7'], [this.roads, '#d3d9df']]) {
            ctx.strokeStyle = colour;
            ctx.lineWidth = width;
            ctx.stroke(path);
        }
        if (scale < 1.5) return;
        ctx.strokeStyle = '#b4bdc6';  // middles of lanes, so that movements can be told apart
        ctx.lineWidth = 1 / scale;
        ctx.setLineDash([1.5, 3]);
        ctx.stroke(this.inside);
        ctx.setLineDash([]);
    }

    drawLights(ctx, scale, lights) {
        const at = [0, 0, 0, 0];
        ctx.lineCap = 'butt';
        ctx.lineWidth = Math.max(1.2, 2.5 / scale);
        for (const light of [0, 1, 2]) {
            ctx.beginPath();
            for (const lane of this.lines) {
                if (lights[lane.signal_group] !== light) continue;
                lane.shape.place(lane.stop_line_m, at, 0);
                lane.shape.place(lane.stop_line_m - 1, at, 2);
                const [dx, dy] = [(at[0] - at[2]) * this.laneWidth_m * 0.46, (at[1] - at[3]) * this.laneWidth_m * 0.46];
                ctx.moveTo(at[0] - dy, at[1] + dx);
                ctx.lineTo(at[0] + dy, at[1] - dx);
            }
            ctx.strokeStyle = LIGHT_COLOURS[light];
            ctx.stroke();
        }
    }
}

// Where vehicles are between two frames. Along the way their speeds at both ends decide how far they have come.
function between(network, from, to, share, frame_s, visit) {
    const a = network.points(from);
    const b = to ? network.points(to) : a;
    const p = [0, 0, 0, 0];
    for (let k = 0; k < from.number.length; ++k) {
        let j = -1;
        if (to) j = to.number[k] === from.number[k] ? k : to.indexOf(from.number[k]);
        if (j < 0) {
            if (to && share > 0.5) continue;  // it leaves
            for (let i = 0; i < 4; ++i) p[i] = a[4 * k + i];
        } else {
            const way_m = Math.hypot(b[4 * j] - a[4 * k], b[4 * j + 1] - a[4 * k + 1]);
            const done = way_m < 0.01 ? 0 : eased(share, from.speed_mps[k] * frame_s / way_m, to.speed_mps[j] * frame_s / way_m);
            for (let i = 0; i < 4; ++i) p[i] = a[4 * k + i] + done * (b[4 * j + i] - a[4 * k + i]);
        }
        visit(k, p);
    }
}

// From 0 to 1 with these slopes at the ends.
function eased(u, slope0, slope1) {
    const [m0, m1] = [Math.min(slope0, 3), Math.min(slope1, 3)];
    return u * (1 - u) * (1 - u) * m0 + u * u * (3 - 2 * u) + u * u * (u - 1) * m1;
}
