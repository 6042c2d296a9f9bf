// Reads the sections of a recording; the format is described in core/record/recording_format.h.
'use strict';

const WIDE = 255;
const STANDS_MPS = 0.1;

class Bytes {
    constructor(bytes) {
        this.bytes = bytes;
        this.next = 0;
    }
    varint() {
        let value = 0;
        for (let factor = 1;; factor *= 128) {
            const byte = this.bytes[this.next++];
            value += (byte & 127) * factor;
            if (byte < 128) return value;
        }
    }
    take(count) {
        this.next += count;
        return this.bytes.subarray(this.next - count, this.next);
    }
}

const unzigzag = (code) => (code >>> 1) ^ -(code & 1);

// One vehicle for as long as it has a seat.
class Vehicle {
    constructor(number, policy, length_m, lane, next) {
        Object.assign(this, {number, policy, length_m, lane, next, before: -1, cause: 0, waitedFor: -1});
        this.position = 0;
        this.speed = 0;
    }
}

// A frame for drawing: one entry a vehicle in each array.
class Frame {
    constructor(count) {
        this.number = new Int32Array(count);
        this.policy = new Uint8Array(count);
        this.cause = new Uint8Array(count);
        this.waitedFor = new Int32Array(count);
        this.lane = new Int32Array(count);
        this.next = new Int32Array(count);
        this.before = new Int32Array(count);  // lane that it was on; -1: unknown
        this.length_m = new Float32Array(count);
        this.position_m = new Float32Array(count);
        this.speed_mps = new Float32Array(count);
        this.lights = null;
        this.index = null;  // by number of the vehicle, made when asked for
    }
    indexOf(number) {
        if (!this.index) {
            this.index = new Map();
            this.number.forEach((each, k) => this.index.set(each, k));
        }
        const k = this.index.get(number);
        return k === undefined ? -1 : k;
    }
}

class SectionDecoder {
    constructor(head, bytes) {
        this.head = head;
        this.in = new Bytes(bytes);
        this.seats = [];
        this.lights = new Uint8Array(head.signal_groups);
    }

    frames(count) {
        return Array.from({length: count}, () => this.frame());
    }

    frame() {
        this.readEvents();
        this.in.varint();  // entered and left: in the series
        this.in.varint();
        this.readColumns();
        return this.picture();
    }

    readEvents() {
        const {seats} = this;
        const read = () => this.in.varint();
        for (let n = read(); n > 0; --n) {
            const group = read();
            this.lights[group] = read();
        }
        for (let n = read(); n > 0; --n) seats[read()] = null;
        for (let n = read(); n > 0; --n) {
            const seat = read();
            seats[seat] = new Vehicle(read(), read(), read() / 1000, read(), read() - 1);
        }
        for (let n = read(); n > 0; --n) {
            const vehicle = seats[read()];
            const lane = read();
            if (lane !== vehicle.lane) vehicle.before = vehicle.lane;
            vehicle.lane = lane;
            vehicle.next = read() - 1;
            vehicle.position = 0;
        }
        for (let n = read(); n > 0; --n) {
            const vehicle = seats[read()];
            vehicle.cause = read();
            vehicle.waitedFor = read() - 1;
        }
    }

    readColumns() {
        const count = this.in.varint();
        const marks = this.in.take((count + 7) >> 3);
        const marked = (k) => (marks[k >> 3] >> (k & 7)) & 1;
        let told = 0;
        for (let k = 0; k < count; ++k) told += marked(k);
        const columns = [this.in.take(told), this.in.take(told)];
        const wides = columns.map((column) => {
            let wide = 0;
            for (const byte of column) wide += byte === WIDE ? 1 : 0;
            return new Bytes(this.in.take(2 * wide));
        });
        const code = (which, k) => {
            const byte = columns[which][k];
            if (byte !== WIDE) return unzigzag(byte);
            const [low, high] = wides[which].take(2);
            return unzigzag(low | (high << 8));
        };
        let k = 0;
        for (let seat = 0; seat < count; ++seat) {
            const vehicle = this.seats[seat];
            const differs = marked(seat);
            if (!vehicle) continue;
            const before = vehicle.speed;
            if (differs) vehicle.speed = (before + code(0, k)) & 0xffff;
            vehicle.position += Math.imul(before + vehicle.speed, this.head.advance_q12) >>> 12;
            if (differs) vehicle.position += code(1, k++);
            vehicle.position &= 0xffff;
        }
    }

    picture() {
        const present = this.seats.filter((vehicle) => vehicle);
        const frame = new Frame(present.length);
        present.forEach((vehicle, k) => {
            for (const each of ['number', 'policy', 'cause', 'waitedFor', 'lane', 'next', 'before', 'length_m']) {
                frame[each][k] = vehicle[each];
            }
            frame.position_m[k] = vehicle.position * this.head.position_unit_m;
            frame.speed_mps[k] = vehicle.speed * this.head.speed_unit_mps;
            if (frame.speed_mps[k] < STANDS_MPS) return;
            frame.cause[k] = 0;
            frame.waitedFor[k] = -1;
        });
        frame.lights = this.lights.slice();
        return frame;
    }
}

// The sections of the page, unpacked when they are needed and kept while they are near.
class Recording {
    constructor(payload) {
        this.payload = payload;
        this.sections = new Map();  // number -> promise of frames, the one used last at the end
        this.ready = new Map();     // number -> frames
        this.onReady = () => {};
        this.onError = () => {};
    }

    async open() {
        this.head = JSON.parse(new TextDecoder().decode(await this.unpack(this.payload.head)));
        const series = await this.unpack(this.payload.series);
        // [frame] vehicles present, entered and left since the start, passages of stop lines
        this.series = new Uint32Array(series.buffer, series.byteOffset, series.byteLength / 4);
        this.frameCount = this.series.length / 4;
        return this;
    }

    async unpack(id) {
        const text = document.getElementById(id).textContent;
        const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
        const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
        return new Uint8Array(await new Response(stream).arrayBuffer());
    }

    present(frame) { return this.series[4 * frame]; }
    entered(frame) { return this.series[4 * frame + 1]; }
    left(frame) { return this.series[4 * frame + 2]; }
    passed(frame) { return this.series[4 * frame + 3]; }
    time_s(frame) { return this.payload.first_s + frame * this.head.frame_s; }
    frameAt(time_s) { return (time_s - this.payload.first_s) / this.head.frame_s; }

    sectionOf(frame) {
        const {starts} = this.payload;
        let low = 0;
        for (let high = starts.length - 1; low < high;) {
            const middle = (low + high + 1) >> 1;
            if (starts[middle] <= frame) low = middle;
            else high = middle - 1;
        }
        return low;
    }

    lengthOf(section) {
        const {starts} = this.payload;
        return (section + 1 < starts.length ? starts[section + 1] : this.frameCount) - starts[section];
    }

    // The frame if its section is there; asks for it if not.
    frame(number) {
        const section = this.sectionOf(number);
        const frames = this.ready.get(section);
        if (!frames) this.load(section);
        return frames ? frames[number - this.payload.starts[section]] : null;
    }

    load(section) {
        const MOST = 16;
        if (section < 0 || section >= this.payload.starts.length) return Promise.resolve(null);
        let promise = this.sections.get(section);
        this.sections.delete(section);
        if (!promise) {
            promise = this.unpack('data-' + section).then((bytes) => {
                const frames = new SectionDecoder(this.head, bytes).frames(this.lengthOf(section));
                this.ready.set(section, frames);
                this.onReady(section);
                return frames;
            });
            promise.catch((error) => this.onError(error));
        }
        this.sections.set(section, promise);
        for (const old of this.sections.keys()) {
            if (this.sections.size <= MOST) break;
            this.sections.delete(old);
            this.ready.delete(old);
        }
        return promise;
    }
}
