// Connects the recording, the map, the time-space diagram and the controls of the page. Tests use the global `replay`.
'use strict';

const FLOW_S = 300;  // averaging time of the flows that the page shows
const byId = (id) => document.getElementById(id);

class Replay {
    constructor(recording) {
        const {head} = recording;
        Object.assign(this, {recording, head, playing: false, rate: 5, time_s: recording.time_s(0), selected: -1});
        this.last_s = recording.time_s(recording.frameCount - 1);
        this.modes = colourModes(head, recording.payload.policy_colours);
        this.linkKinds = (head.links || []).map((name) => {
            const [colour, label] = LINKS[name] || ['#000000', name];
            return {colour, label};
        });
        this.network = new Network(head);
        this.map = new MapView(byId('map'), this.network, (number) => this.select(number));
        this.diagram = new TimeSpace(byId('time-space'), recording, (time_s) => this.seek(time_s));
        this.drawCount = 0;  // number of calls of draw(), for tests
        this.addCounters();
        this.addStreets();
        this.setMode(head.policies.length > 1 ? 'policy' : 'cause');
        for (const part of [this.map, this.diagram]) part.onChange = () => this.requestDraw();
        recording.onReady = () => this.requestDraw();
        recording.onError = (error) => {
            byId('message').textContent = `The recording in this page is damaged: ${error.message}`;
        };
        this.connectControls();
        this.drawSeries();
        this.requestDraw();
    }

    addStreets() {
        const streets = this.network.entries.map((entry) => this.network.street(entry));
        const longest_m = Math.max(...streets.map((street) => street.length_m));
        streets.forEach((street, k) => byId('street').add(new Option(`from ${street.pieces[0].lane.name}`, k)));
        const long = streets.filter((street) => street.length_m > longest_m - 1);
        this.streets = streets;
        this.setStreet(streets.indexOf(long[long.length >> 1]));
    }

    setStreet(number) {
        byId('street').value = number;
        this.street = this.streets[number];
        if (this.mode) this.diagram.show(this.street, this.mode);
        this.requestDraw();
    }

    setMode(name) {
        byId('mode').value = name;
        this.mode = this.modes[name];
        const items = this.mode.labels.map((label, k) => {
            const item = document.createElement('li');
            const sample = document.createElement('i');
            sample.style.background = this.mode.colours[k];
            item.append(sample, label);
            return item;
        });
        const lights = document.createElement('li');
        LIGHT_COLOURS.forEach((colour, k) => {
            const bar = document.createElement('i');
            bar.className = 'light';
            bar.style.background = colour;
            lights.append(bar, ['red', 'green', 'yellow'][k]);
        });
        byId('legend').replaceChildren(...items, ...this.linkKinds.map(({colour, label}) => {
            const item = document.createElement('li');
            const ring = document.createElement('i');
            ring.className = 'ring';
            ring.style.borderColor = colour;
            item.append(ring, label);
            return item;
        }), lights);
        this.diagram.show(this.street, this.mode);
        this.requestDraw();
    }

    connectControls() {
        byId('play').onclick = () => this.play(!this.playing);
        byId('rate').onchange = (event) => { this.rate = Number(event.target.value); };
        byId('mode').onchange = (event) => this.setMode(event.target.value);
        byId('street').onchange = (event) => this.setStreet(Number(event.target.value));
        byId('zoom-in').onclick = () => this.map.zoom(1.5);
        byId('zoom-out').onclick = () => this.map.zoom(1 / 1.5);
        byId('zoom-fit').onclick = () => this.map.fit();
        const scrub = byId('scrub');
        scrub.min = this.recording.time_s(0);
        scrub.max = this.last_s;
        scrub.oninput = () => this.seek(Number(scrub.value));
        const keys = {
            ' ': () => this.play(!this.playing),
            ArrowLeft: () => this.seek(this.time_s - this.head.frame_s),
            ArrowRight: () => this.seek(this.time_s + this.head.frame_s),
            '+': () => this.map.zoom(1.5),
            '-': () => this.map.zoom(1 / 1.5),
            0: () => this.map.fit(),
        };
        document.addEventListener('keydown', (event) => {
            if (!keys[event.key] || event.target.tagName === 'SELECT' || event.ctrlKey || event.metaKey) return;
            event.preventDefault();
            keys[event.key]();
        });
        new ResizeObserver(() => this.drawSeries()).observe(byId('series'));
    }

    play(on) {
        if (on && this.time_s >= this.last_s) this.time_s = this.recording.time_s(0);
        this.playing = on;
        this.lastTick_ms = undefined;
        byId('play').textContent = on ? '\u23f8' : '\u25b6';
        byId('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
        this.requestDraw();
    }

    seek(time_s) {
        this.time_s = Math.min(Math.max(time_s, this.recording.time_s(0)), this.last_s);
        this.requestDraw();
    }

    select(number) {
        this.selected = number;
        this.requestDraw();
    }

    requestDraw() {
        if (this.drawRequested) return;
        this.drawRequested = true;
        requestAnimationFrame((now_ms) => this.tick(now_ms));
    }

    tick(now_ms) {
        this.drawRequested = false;
        if (this.playing) {
            const elapsed_s = this.lastTick_ms === undefined ? 0 : (now_ms - this.lastTick_ms) / 1000;
            this.lastTick_ms = now_ms;
            // From one drawing to the next, the replay counts at most this much real time. Otherwise the replay would
            // jump after the browser was inactive.
            const MAX_STEP_S = 0.25;
            if (this.hasFrame) this.time_s += Math.min(elapsed_s, MAX_STEP_S) * this.rate;
            if (this.time_s >= this.last_s) {
                this.time_s = this.last_s;
                this.play(false);
            }
        }
        this.draw();
        if (this.playing) this.requestDraw();
    }

    draw() {
        const at = this.recording.frameAt(this.time_s);
        const number = Math.min(Math.floor(at + 1e-9), this.recording.frameCount - 1);
        const from = this.recording.frame(number);
        const to = number + 1 < this.recording.frameCount ? this.recording.frame(number + 1) : null;
        const PREFETCH_FRAMES = 40;
        this.recording.frame(Math.min(number + PREFETCH_FRAMES, this.recording.frameCount - 1));
        this.hasFrame = from !== null;
        byId('message').textContent = from ? '' : 'Unpacking \u2026';
        this.map.draw(from, to, Math.max(at - number, 0), this.head.frame_s, this.mode, this.street, this.selected,
                      this.linkKinds.map(({colour}) => colour));
        this.diagram.draw(this.time_s);
        this.showCounters(number);
        if (from) this.showVehicle(from, number);
        byId('scrub').value = this.time_s;
        byId('clock').textContent = `${this.time_s.toFixed(1)} of ${this.last_s.toFixed(0)} s`;
        this.showScale();
        ++this.drawCount;
    }

    showCounters(number) {
        const {recording} = this;
        const since = Math.max(number - Math.round(FLOW_S / this.head.frame_s), 0);
        const hours = (number - since) * this.head.frame_s / 3600;
        recording.counters.forEach(({id, per_hour}, k) => {
            const now = recording.count(k, number);
            const shown = per_hour ? Math.round((now - recording.count(k, since)) / hours) : now;
            byId(id).textContent = per_hour && hours === 0 ? '\u2013' : shown.toLocaleString('en');
        });
    }

    addCounters() {
        for (const {id, label, meaning} of this.recording.counters) {
            const row = document.createElement('div');
            const [term, value] = [document.createElement('dt'), document.createElement('dd')];
            term.textContent = label;
            term.title = meaning;
            value.id = id;
            row.append(term, value);
            byId('counters').append(row);
        }
    }

    // Returns the recorded state of the selected vehicle, or null if it is not in the network.
    vehicleState(frame, number) {
        const k = frame.indexOf(this.selected);
        if (k < 0) return null;
        const lane = this.network.lanes[frame.lane[k]];
        const next = frame.next[k] < 0 ? 'leaves the network' : this.network.lanes[frame.next[k]].name;
        const cause = this.head.causes[frame.cause[k]];
        return {
            vehicle: frame.number[k], policy: this.head.policies[frame.policy[k]], lane: lane.name, next,
            position_m: frame.position_m[k], speed_mps: frame.speed_mps[k], length_m: frame.length_m[k], cause,
            waitedFor: frame.waitedFor[k], time_s: this.recording.time_s(number),
        };
    }

    showVehicle(frame, number) {
        const state = this.selected < 0 ? null : this.vehicleState(frame, number);
        this.state = state;
        const box = byId('vehicle');
        if (!state) {
            box.textContent = this.selected < 0 ? 'Click a vehicle to see its state.' :
                `Vehicle ${this.selected} is not in the network now.`;
            return;
        }
        const causeLabel = CAUSES[state.cause] ? CAUSES[state.cause][1] : state.cause;
        const rows = [
            ['number', state.vehicle], ['policy', state.policy], ['lane', state.lane], ['next lane', state.next],
            ['position of the front', `${state.position_m.toFixed(2)} m`],
            ['speed', `${state.speed_mps.toFixed(2)} m/s = ${(3.6 * state.speed_mps).toFixed(1)} km/h`],
            ['delay cause', state.cause === 'none' ? '\u2013' : causeLabel],
            ['time', `${state.time_s.toFixed(1)} s`],
        ];
        const list = document.createElement('dl');
        for (const [name, value] of rows) {
            const row = document.createElement('div');
            const [term, detail] = [document.createElement('dt'), document.createElement('dd')];
            term.textContent = name;
            detail.textContent = value;
            if (name === 'delay cause' && state.waitedFor >= 0) detail.append(' ', this.linkTo(state.waitedFor));
            row.append(term, detail);
            list.append(row);
        }
        box.replaceChildren(list);
    }

    linkTo(number) {
        const button = document.createElement('button');
        button.textContent = `vehicle ${number}`;
        button.onclick = () => this.select(number);
        return button;
    }

    showScale() {
        const NICE_M = [1000, 500, 200, 100, 50, 20, 10, 5, 2];
        const perPixel_m = this.map.ratio / this.map.scale;
        const length_m = NICE_M.find((length) => length / perPixel_m < 130) || 1;
        const bar = document.querySelector('#scale span');
        bar.style.width = `${length_m / perPixel_m}px`;
        bar.textContent = `${length_m} m`;
    }

    drawSeries() {
        const canvas = byId('series');
        const ratio = window.devicePixelRatio || 1;
        canvas.width = Math.max(1, canvas.clientWidth * ratio);
        canvas.height = Math.max(1, canvas.clientHeight * ratio);
        const ctx = canvas.getContext('2d');
        const {frameCount} = this.recording;
        let maxPresent = 1;
        for (let frame = 0; frame < frameCount; ++frame) {
            maxPresent = Math.max(maxPresent, this.recording.present(frame));
        }
        ctx.fillStyle = '#dbe6ef';
        for (let x = 0; x < canvas.width; ++x) {
            const frame = Math.round(x / canvas.width * (frameCount - 1));
            const height = this.recording.present(frame) / maxPresent * canvas.height;
            ctx.fillRect(x, canvas.height - height, 1, height);
        }
    }
}

// Applies the end of the page address: #t=120&vehicle=35 starts at 120 s with vehicle 35 selected.
function goToAddress(replay) {
    const parameters = new URLSearchParams(location.hash.slice(1));
    if (parameters.has('t')) replay.seek(Number(parameters.get('t')));
    if (parameters.has('vehicle')) replay.select(Number(parameters.get('vehicle')));
}

async function start() {
    if (typeof DecompressionStream === 'undefined') {
        throw new Error('This browser is too old: it cannot decompress the recording.');
    }
    const recording = await new Recording(JSON.parse(byId('payload').textContent)).open();
    const {head} = recording;
    byId('title').textContent = head.title || head.scenario;
    byId('subtitle').textContent = `${head.population} \u00b7 scenario ${head.scenario} ${head.scenario_hash} \u00b7 ` +
        `seed ${head.seed} \u00b7 stopline ${head.version}`;
    byId('subtitle').title = head.command;
    window.replay = new Replay(recording);
    goToAddress(window.replay);
}

start().catch((error) => {
    byId('message').textContent = error.message;
    console.error(error);
});
