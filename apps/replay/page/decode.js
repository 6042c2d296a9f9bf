// Decodes the sections of a recording. core/record/recording/recording_format.h describes the format.
'use strict';

const WIDE_CODE = 255;
const STOPPED_MPS = 0.1;

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

const unzigzag = (difference) => (difference >>> 1) ^ -(difference & 1);

// A vehicle in the network. The recording refers to it by its seat, an index that another vehicle can reuse later;
// `number` always means this vehicle. `position` and `speed` are whole multiples of the units in the header of the
// recording.
class Vehicle {
    constructor(number, policy, length_m, lane, next) {
        Object.assign(this, {number, policy, length_m, lane, next, previous: -1, cause: 0, waitedFor: -1});
        this.position = 0;
        this.speed = 0;
    }
}

// The state at one recorded time, ready for drawing. Each array has one entry per vehicle.
class Frame {
    constructor(count) {
        this.number = new Int32Array(count);
        this.policy = new Uint8Array(count);
        this.cause = new Uint8Array(count);
        this.waitedFor = new Int32Array(count);
        this.lane = new Int32Array(count);
        this.next = new Int32Array(count);      // next lane; -1: the vehicle leaves the network
        this.previous = new Int32Array(count);  // previous lane; -1: unknown
        this.length_m = new Float32Array(count);
        this.position_m = new Float32Array(count);
        this.speed_mps = new Float32Array(count);
        this.lights = null;
        this.links = [];  // {kind, vehicle, other (-1: none), lane (-1: none)}
        this.index = null;  // Map from vehicle number to the index in the arrays, built on first use
    }
    // Returns the index of a vehicle in the arrays, or -1 if the vehicle is not in the network.
    indexOf(number) {
        if (!this.index) {
            this.index = new Map();
            this.number.forEach((vehicle, k) => this.index.set(vehicle, k));
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
        this.links = [];
    }

    frames(count) {
        return Array.from({length: count}, () => this.frame());
    }

    frame() {
        this.readEvents();
        if (this.head.links) this.readLinks();
        this.in.varint();  // skip the counts of entries and exits; Recording.series contains them
        this.in.varint();
        this.readColumns();
        return this.drawableFrame();
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
            if (lane !== vehicle.lane) vehicle.previous = vehicle.lane;
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

    readLinks() {
        const read = () => this.in.varint();
        this.links = Array.from({length: read()}, () => {
            return {kind: read(), vehicle: read(), other: read() - 1, lane: read() - 1};
        });
    }

    readColumns() {
        const count = this.in.varint();
        const bits = this.in.take((count + 7) >> 3);
        const isChanged = (k) => (bits[k >> 3] >> (k & 7)) & 1;
        let changed = 0;
        for (let k = 0; k < count; ++k) changed += isChanged(k);
        const columns = [this.in.take(changed), this.in.take(changed)];
        const wideCodes = columns.map((column) => {
            let count = 0;
            for (const byte of column) count += byte === WIDE_CODE ? 1 : 0;
            return new Bytes(this.in.take(2 * count));
        });
        const difference = (column, k) => {
            const byte = columns[column][k];
            if (byte !== WIDE_CODE) return unzigzag(byte);
            const [low, high] = wideCodes[column].take(2);
            return unzigzag(low | (high << 8));
        };
        let k = 0;
        for (let seat = 0; seat < count; ++seat) {
            const vehicle = this.seats[seat];
            const isWritten = isChanged(seat);
            if (!vehicle) continue;
            const before = vehicle.speed;
            if (isWritten) vehicle.speed = (before + difference(0, k)) & 0xffff;
            vehicle.position += Math.imul(before + vehicle.speed, this.head.advance_q12) >>> 12;
            if (isWritten) vehicle.position += difference(1, k++);
            vehicle.position &= 0xffff;
        }
    }

    // Returns the current state as a Frame. In a Frame, only stopped vehicles have a delay cause.
    drawableFrame() {
        const present = this.seats.filter((vehicle) => vehicle);
        const frame = new Frame(present.length);
        present.forEach((vehicle, k) => {
            for (const name of ['number', 'policy', 'cause', 'waitedFor', 'lane', 'next', 'previous', 'length_m']) {
                frame[name][k] = vehicle[name];
            }
            frame.position_m[k] = vehicle.position * this.head.position_unit_m;
            frame.speed_mps[k] = vehicle.speed * this.head.speed_unit_mps;
            if (frame.speed_mps[k] < STOPPED_MPS) return;
            frame.cause[k] = 0;
            frame.waitedFor[k] = -1;
        });
        frame.lights = this.lights.slice();
        frame.links = this.links;
        return frame;
    }
}

// The recording in the page. A section of up to 128 frames is unpacked when it is needed. The most recently used
// sections stay in memory.
class Recording {
    constructor(payload) {
        this.payload = payload;
        this.sections = new Map();  // from section number to the promise of its frames, ordered by last use
        this.ready = new Map();     // from section number to its frames, once they are unpacked
        this.onReady = () => {};
        this.onError = () => {};
    }

    async open() {
        this.head = JSON.parse(new TextDecoder().decode(await this.unpack(this.payload.head)));
        const series = await this.unpack(this.payload.series);
        // One number per frame and counter, in the order of the counters.
        this.series = new Uint32Array(series.buffer, series.byteOffset, series.byteLength / 4);
        this.frameCount = this.series.length / this.counters.length;
        return this;
    }

    async unpack(id) {
        const text = document.getElementById(id).textContent;
        const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
        const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
        return new Uint8Array(await new Response(stream).arrayBuffer());
    }

    get counters() { return this.payload.counters; }
    // Returns the value of the counter with this position in `counters`.
    count(counter, frame) { return this.series[this.counters.length * frame + counter]; }
    present(frame) { return this.count(0, frame); }
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

    // Returns a frame. If its section is not unpacked yet, starts to unpack the section and returns null.
    frame(number) {
        const section = this.sectionOf(number);
        const frames = this.ready.get(section);
        if (!frames) this.load(section);
        return frames ? frames[number - this.payload.starts[section]] : null;
    }

    load(section) {
        const MAX_SECTIONS = 16;
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
        for (const oldest of this.sections.keys()) {
            if (this.sections.size <= MAX_SECTIONS) break;
            this.sections.delete(oldest);
            this.ready.delete(oldest);
        }
        return promise;
    }
}
