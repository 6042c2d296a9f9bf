// The network as it was recorded, where vehicles are on it, and how both are drawn. World coordinates: metres, y upwards.
'use strict';

const VEHICLE_WIDTH_M = 1.8;

class Shape {
    // scale: metres of the shape to one of the lane, as which distances count.
    constructor(numbers, scale) {
        this.numbers = numbers;
        this.along_m = [0];  // of each point
        for (let k = 2; k < numbers.length; k += 2) {
            const step = Math.hypot(numbers[k] - numbers[k - 2], numbers[k + 1] - numbers[k - 1]);
            this.along_m.push(this.along_m[this.along_m.length - 1] + step / scale);
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
        this.lanes = head.lanes.map((lane, number) => ({...lane, number, shape: new Shape(lane.shape, lane.shape_scale ?? 1)}));
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

    // Where the vehicles of a frame are: lane, lane behind (-1: none) and place of the front along the lane's shape, for each.
    spots(frame) {
        if (frame.spots) return frame.spots;
        const count = frame.number.length;
        frame.spots = {lane: new Int32Array(count), behind: new Int32Array(count), front_m: new Float32Array(count)};
        for (let k = 0; k < count; ++k) this.findSpot(frame, k, frame.spots);
        return frame.spots;
    }

    findSpot(frame, k, spots) {
        const lane = this.lanes[frame.lane[k]];
        // Behind the stop line it is on its own path already, which shares that stretch with others.
        const past = lane.stop_line_m !== undefined && frame.position_m[k] > lane.stop_line_m && frame.next[k] >= 0;
        spots.lane[k] = past ? frame.next[k] : lane.number;
        spots.behind[k] = past ? lane.number : frame.before[k];
        spots.front_m[k] = frame.position_m[k] + (past ? -lane.stop_line_m : lane.shape_start_m);
    }

    // Where the path of a lane leaves its shape to go on.
    end_m(lane) { return lane.stop_line_m !== undefined ? lane.stop_line_m : lane.shape.length_m; }

    // Into out: front and rear of a vehicle, x, y, x, y.
    place(laneNumber, behindNumber, front_m, length_m, out) {
        const lane = this.lanes[laneNumber];
        lane.shape.place(front_m, out, 0);
        const rear_m = front_m - length_m;
        const behind = behindNumber >= 0 && rear_m < 0 ? this.lanes[behindNumber] : null;
        if (behind && behind.next.includes(laneNumber)) {
            behind.shape.place(this.end_m(behind) + rear_m, out, 2);
        } else {
            lane.shape.place(rear_m, out, 2);
        }
    }

    // How far vehicle k of a frame drives to be where vehicle j of a later one is; -1: not along one lane or from one to the next.
    way_m(a, k, b, j) {
        if (a.lane[k] === b.lane[j]) return b.front_m[j] - a.front_m[k];
        const lane = this.lanes[a.lane[k]];
        return lane.next.includes(b.lane[j]) ? this.end_m(lane) - a.front_m[k] + b.front_m[j] : -1;
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

// Where vehicles are between two frames: on their lanes, as far along as their speeds at both ends say. Who changes lanes, or passes
// more than one in between, goes straight.
function between(network, from, to, share, frame_s, visit) {
    const a = network.spots(from);
    const b = to ? network.spots(to) : a;
    const p = [0, 0, 0, 0];
    const q = [0, 0, 0, 0];
    for (let k = 0; k < from.number.length; ++k) {
        let j = -1;
        if (to) j = to.number[k] === from.number[k] ? k : to.indexOf(from.number[k]);
        const length_m = from.length_m[k];
        if (j < 0) {
            if (to && share > 0.5) continue;  // it leaves
            network.place(a.lane[k], a.behind[k], a.front_m[k], length_m, p);
            visit(k, p);
            continue;
        }
        let way_m = network.way_m(a, k, b, j);
        const straight = way_m < 0;
        if (straight) {
            network.place(a.lane[k], a.behind[k], a.front_m[k], length_m, p);
            network.place(b.lane[j], b.behind[j], b.front_m[j], length_m, q);
            way_m = Math.hypot(q[0] - p[0], q[1] - p[1]);
        }
        const done = way_m < 0.01 ? 0 : eased(share, from.speed_mps[k] * frame_s / way_m, to.speed_mps[j] * frame_s / way_m);
        const on_next_m = b.front_m[j] - (1 - done) * way_m;  // on the lane where it ends
        if (straight) {
            for (let i = 0; i < 4; ++i) p[i] += done * (q[i] - p[i]);
        } else if (a.lane[k] === b.lane[j] || on_next_m < 0) {
            network.place(a.lane[k], a.behind[k], a.front_m[k] + done * way_m, length_m, p);
        } else {
            network.place(b.lane[j], a.lane[k], on_next_m, length_m, p);
        }
        visit(k, p);
    }
}

// From 0 to 1 with these slopes at the ends.
function eased(u, slope0, slope1) {
    const [m0, m1] = [Math.min(slope0, 3), Math.min(slope1, 3)];
    return u * (1 - u) * (1 - u) * m0 + u * u * (3 - 2 * u) + u * u * (u - 1) * m1;
}
