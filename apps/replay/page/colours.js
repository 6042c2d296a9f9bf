// What colours mean. Okabe and Ito's palette, and cividis for speeds: both can be told apart with any colour vision.
'use strict';

const LIGHT_COLOURS = ['#d55e00', '#009e73', '#f0c000'];  // red, green, yellow
const POLICY_COLOURS = ['#0072b2', '#e69f00', '#cc79a7', '#56b4e9', '#000000', '#009e73', '#d55e00'];
const SPEED_COLOURS = ['#00224e', '#213b6e', '#4c556c', '#6c6e72', '#8e8978', '#b2a570', '#d9c55c'];
const FASTEST_MPS = 14;
const CAUSES = {
    none: ['#8fa2b3', 'drives, or has just stopped'],
    start: ['#f0e442', 'its own start: the one ahead drives'],
    signal: ['#4d565e', 'a light, or the queue before it'],
    priority: ['#56b4e9', 'vehicles with priority'],
    junction_blocking: ['#d55e00', 'a vehicle across its way'],
    turn_blocking: ['#e69f00', 'room in the exit, to turn'],
    spillback: ['#0072b2', 'room in the exit, straight on'],
    gridlock: ['#cc0078', 'a circle: gridlock'],
    wrong_lane: ['#009e73', 'a gap in the lane beside'],
};

// Each mode: colours, a label for each, and the one that a vehicle has.
function colourModes(head) {
    const speeds = SPEED_COLOURS.length;
    return {
        policy: {
            colours: head.policies.map((name, k) => POLICY_COLOURS[k % POLICY_COLOURS.length]),
            labels: head.policies,
            of: (frame, k) => frame.policy[k],
        },
        speed: {
            colours: SPEED_COLOURS,
            labels: SPEED_COLOURS.map((colour, k) => {
                const [from, to] = [k, k + 1].map((each) => Math.round(each * FASTEST_MPS * 3.6 / speeds));
                return k + 1 < speeds ? `${from} to ${to} km/h` : `over ${from} km/h`;
            }),
            of: (frame, k) => Math.min(Math.floor(frame.speed_mps[k] / FASTEST_MPS * speeds), speeds - 1),
        },
        cause: {
            colours: head.causes.map((name) => (CAUSES[name] || ['#000000'])[0]),
            labels: head.causes.map((name) => (CAUSES[name] || ['', name])[1]),
            of: (frame, k) => frame.cause[k],
        },
    };
}
