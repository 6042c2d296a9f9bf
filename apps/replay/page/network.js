// The lanes of the recorded network, the positions of vehicles on them, and their drawing. World coordinates are in
// metres, with y upwards.
'use strict';

const VEHICLE_WIDTH_M = 1.8;

// The centre line of a lane.
class Shape {
    // `scale` is the length of the shape divided by the length of the lane. All distances are in metres along the lane.
    constructor(numbers, scale) {
        this.numbers = numbers;
        this.along_m = [0];  // distance of each point from the start of the lane
        for (let k = 2; k < numbers.length; k += 2) {
            const step = Math.hypot(numbers[k] - numbers[k - 2], numbers[k + 1] - numbers[k - 1]);
            this.along_m.push(this.along_m[this.along_m.length - 1] + step / scale);
        }
        this.length_m = this.along_m[this.along_m.length - 1];
    }
    // Writes x and y of the point at a distance to out[at] and out[at + 1]. Beyond its ends, the centre line continues
    // straight.
    pointAt(distance_m, out, at) {
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
        this.lanes = head.lanes.map(
            (lane, number) => ({...lane, number, shape: new Shape(lane.shape, lane.shape_scale ?? 1)}));
        this.entries = head.entries.length ? head.entries : this.firstLanes();
        this.laneWidth_m = head.lane_width_m;
        this.signalLanes = this.lanes.filter((lane) => lane.signal_group !== undefined);
        this.roads = new Path2D();
        this.connections = new Path2D();
        this.bounds = [Infinity, Infinity, -Infinity, -Infinity];
        for (const lane of this.lanes) this.addLane(lane);
    }

    // Returns the lanes outside intersections that have no predecessor, or all lanes outside intersections if each has
    // a predecessor. Imported networks need this function, because they list no entries.
    firstLanes() {
        const successors = new Set(this.lanes.flatMap((lane) => lane.next));
        const roadLanes = this.lanes.filter((lane) => lane.origin === undefined);
        const first = roadLanes.filter((lane) => !successors.has(lane.number));
        return (first.length ? first : roadLanes).map((lane) => lane.number);
    }

    addLane(lane) {
        const path = lane.origin === undefined ? this.roads : this.connections;
        const {numbers} = lane.shape;
        for (let k = 0; k < numbers.length; k += 2) {
            const [x, y] = [numbers[k], numbers[k + 1]];
            if (k === 0) path.moveTo(x, y);
            else path.lineTo(x, y);
            const b = this.bounds;
            [b[0], b[1], b[2], b[3]] = [Math.min(b[0], x), Math.min(b[1], y), Math.max(b[2], x), Math.max(b[3], y)];
        }
    }

    // Returns the placement of each vehicle of a frame: the lane whose shape it follows, the lane of its rear (-1:
    // unknown), and the distance of its front along the shape.
    placements(frame) {
        if (frame.placements) return frame.placements;
        const count = frame.number.length;
        frame.placements = {lane: new Int32Array(count), rearLane: new Int32Array(count), front_m: new Float32Array(count)};
        for (let k = 0; k < count; ++k) this.findPlacement(frame, k, frame.placements);
        return frame.placements;
    }

    findPlacement(frame, k, placements) {
        const lane = this.lanes[frame.lane[k]];
        // Beyond the stop line a vehicle follows the shape of its connection.
        const beyond = lane.stop_line_m !== undefined && frame.position_m[k] > lane.stop_line_m && frame.next[k] >= 0;
        placements.lane[k] = beyond ? frame.next[k] : lane.number;
        placements.rearLane[k] = beyond ? lane.number : frame.previous[k];
        placements.front_m[k] = frame.position_m[k] + (beyond ? -lane.stop_line_m : lane.shape_start_m);
    }

    // Returns the distance along a lane's shape at which vehicles change to the shape of the next lane.
    end_m(lane) { return lane.stop_line_m !== undefined ? lane.stop_line_m : lane.shape.length_m; }

    // Writes x and y of the vehicle's front to out[0] and out[1], and those of its rear to out[2] and out[3].
    vehicleEnds(laneNumber, rearLaneNumber, front_m, length_m, out) {
        const lane = this.lanes[laneNumber];
        lane.shape.pointAt(front_m, out, 0);
        const rear_m = front_m - length_m;
        const rearLane = rearLaneNumber >= 0 && rear_m < 0 ? this.lanes[rearLaneNumber] : null;
        if (rearLane && rearLane.next.includes(laneNumber)) {
            rearLane.shape.pointAt(this.end_m(rearLane) + rear_m, out, 2);
        } else {
            lane.shape.pointAt(rear_m, out, 2);
        }
    }

    // Returns the distance that a vehicle drives along the lanes between two successive frames. `a` and `b` are the
    // placements of the frames; the vehicle has index k in `a` and index j in `b`. Returns -1 unless the vehicle stays
    // on its lane or moves to the next one.
    distance_m(a, k, b, j) {
        if (a.lane[k] === b.lane[j]) return b.front_m[j] - a.front_m[k];
        const lane = this.lanes[a.lane[k]];
        return lane.next.includes(b.lane[j]) ? this.end_m(lane) - a.front_m[k] + b.front_m[j] : -1;
    }

    // Returns the street that begins on an entry lane and goes straight on, with the distance at which each lane
    // begins.
    street(entry) {
        const pieces = [];
        const visited = new Set();
        let from_m = 0;
        for (let number = entry; number !== undefined && !visited.has(number);) {
            const lane = this.lanes[number];
            visited.add(number);
            pieces.push({lane, from_m});
            from_m += lane.length_m;
            number = lane.next.find((next) => (this.lanes[next].turn || 'straight') === 'straight');
        }
        return {pieces, length_m: from_m, from: new Map(pieces.map((piece) => [piece.lane.number, piece.from_m]))};
    }

    drawRoads(ctx, scale) {
        ctx.lineCap = 'butt';
        ctx.lineJoin = 'round';
        const width = Math.max(this.laneWidth_m, 1.2 / scale);
        for (const [path, colour] of [[this.connections, '#dde2e7'], [this.roads, '#d3d9df']]) {
            ctx.strokeStyle = colour;
            ctx.lineWidth = width;
            ctx.stroke(path);
        }
        if (scale < 1.5) return;
        ctx.strokeStyle = '#b4bdc6';  // centre lines, which make overlapping connections distinguishable
        ctx.lineWidth = 1 / scale;
        ctx.setLineDash([1.5, 3]);
        ctx.stroke(this.connections);
        ctx.setLineDash([]);
    }

    drawLights(ctx, scale, lights) {
        const at = [0, 0, 0, 0];
        ctx.lineCap = 'butt';
        ctx.lineWidth = Math.max(1.2, 2.5 / scale);
        for (const light of [0, 1, 2]) {
            ctx.beginPath();
            for (const lane of this.signalLanes) {
                if (lights[lane.signal_group] !== light) continue;
                lane.shape.pointAt(lane.stop_line_m, at, 0);
                lane.shape.pointAt(lane.stop_line_m - 1, at, 2);
                const [dx, dy] = [(at[0] - at[2]) * this.laneWidth_m * 0.46, (at[1] - at[3]) * this.laneWidth_m * 0.46];
                ctx.moveTo(at[0] - dy, at[1] + dx);
                ctx.lineTo(at[0] + dy, at[1] - dx);
            }
            ctx.strokeStyle = LIGHT_COLOURS[light];
            ctx.stroke();
        }
    }
}

// Calls visit(k, points) for each vehicle k of the frame `from`. `points` holds x and y of front and rear of the
// vehicle at a time between the frames `from` and `to`. `share` is the elapsed share of the time between these frames,
// 0 to 1. A vehicle that is missing in `to` is left out in the second half of this time. A vehicle moves along its
// lanes and has the recorded speed at both frames. A vehicle that changes to an adjacent lane, or passes a whole lane
// between the frames, moves along a straight line.
function interpolate(network, from, to, share, frame_s, visit) {
    const a = network.placements(from);
    const b = to ? network.placements(to) : a;
    const p = [0, 0, 0, 0];
    const q = [0, 0, 0, 0];
    for (let k = 0; k < from.number.length; ++k) {
        let j = -1;
        if (to) j = to.number[k] === from.number[k] ? k : to.indexOf(from.number[k]);
        const length_m = from.length_m[k];
        if (j < 0) {
            if (to && share > 0.5) continue;  // the vehicle has left the network
            network.vehicleEnds(a.lane[k], a.rearLane[k], a.front_m[k], length_m, p);
            visit(k, p);
            continue;
        }
        let distance_m = network.distance_m(a, k, b, j);
        const straight = distance_m < 0;
        if (straight) {
            network.vehicleEnds(a.lane[k], a.rearLane[k], a.front_m[k], length_m, p);
            network.vehicleEnds(b.lane[j], b.rearLane[j], b.front_m[j], length_m, q);
            distance_m = Math.hypot(q[0] - p[0], q[1] - p[1]);
        }
        const done = distance_m < 0.01 ? 0 :
            hermite(share, from.speed_mps[k] * frame_s / distance_m, to.speed_mps[j] * frame_s / distance_m);
        // Distance of the front from the start of the lane that the vehicle is on in the later frame. It is negative
        // while the front has not reached this lane.
        const on_next_m = b.front_m[j] - (1 - done) * distance_m;
        if (straight) {
            for (let i = 0; i < 4; ++i) p[i] += done * (q[i] - p[i]);
        } else if (a.lane[k] === b.lane[j] || on_next_m < 0) {
            network.vehicleEnds(a.lane[k], a.rearLane[k], a.front_m[k] + done * distance_m, length_m, p);
        } else {
            network.vehicleEnds(b.lane[j], a.lane[k], on_next_m, length_m, p);
        }
        visit(k, p);
    }
}

// Returns the value at u of the cubic Hermite curve from 0 to 1. The slopes at both ends are limited to 3, so that the
// curve never falls.
function hermite(u, slope0, slope1) {
    const [m0, m1] = [Math.min(slope0, 3), Math.min(slope1, 3)];
    return u * (1 - u) * (1 - u) * m0 + u * u * (3 - 2 * u) + u * u * (u - 1) * m1;
}
