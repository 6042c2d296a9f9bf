// Colours and their labels. The palettes suit every kind of colour vision: Okabe and Ito, and cividis for speeds.
'use strict';

const LIGHT_COLOURS = ['#d55e00', '#009e73', '#f0c000'];  // red, green, yellow
const SPEED_COLOURS = ['#00224e', '#213b6e', '#4c556c', '#6c6e72', '#8e8978', '#b2a570', '#d9c55c'];
const SCALE_END_MPS = 14;  // end of the speed scale; faster vehicles have the last colour
// Colour and label of each delay cause, by its name in the recording.
const CAUSES = {
    none: ['#8fa2b3', 'none (moving, or just stopped)'],
    queue_discharge: ['#f0e442', 'queue discharge (the leader moves)'],
    signal: ['#4d565e', 'signal (or the queue there)'],
    yielding: ['#56b4e9', 'yielding'],
    junction_blocking: ['#d55e00', 'junction blocking'],
    turn_blocking: ['#e69f00', 'turn blocking (full exit lane)'],
    spillback: ['#0072b2', 'spillback (full exit lane)'],
    gridlock: ['#cc0078', 'gridlock'],
    wrong_lane: ['#009e73', 'wrong lane (waits for a gap)'],
    refusal: ['#b39ddb', 'refusal (cooperative clearing)'],
};

// Colour and label of each kind of links between vehicles, by its name in the recording.
const LINKS = {
    refusal: ['#6a1b9a', 'refused: waits for room (line to the vehicle or lane)'],
    gap: ['#1565c0', 'asks for a gap (line to the vehicle that opens it)'],
};

// Returns the ways to colour vehicles, by name. Each way has colours, their labels, and a function `of` that returns
// the index of the colour of vehicle k in a frame.
function colourModes(head, policyColours) {
    const classes = SPEED_COLOURS.length;
    return {
        policy: {
            colours: policyColours,
            labels: head.policies,
            of: (frame, k) => frame.policy[k],
        },
        speed: {
            colours: SPEED_COLOURS,
            labels: SPEED_COLOURS.map((colour, k) => {
                const [from, to] = [k, k + 1].map((bound) => Math.round(bound * SCALE_END_MPS * 3.6 / classes));
                return k + 1 < classes ? `${from} to ${to} km/h` : `over ${from} km/h`;
            }),
            of: (frame, k) => Math.min(Math.floor(frame.speed_mps[k] / SCALE_END_MPS * classes), classes - 1),
        },
        cause: {
            colours: head.causes.map((name) => (CAUSES[name] || ['#000000'])[0]),
            labels: head.causes.map((name) => (CAUSES[name] || ['', name])[1]),
            of: (frame, k) => frame.cause[k],
        },
    };
}
