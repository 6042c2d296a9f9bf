#!/usr/bin/env python3
"""Tests a replay page in a headless browser.

    page_test.py PAGE TRAJECTORIES_CSV [PAGE_WITH_MANY_VEHICLES]

The page must load without console messages and network requests, play, and look different at two times. A click on a
vehicle must show its state from trajectories.csv. Exit codes: 0 all checks pass, 1 a check fails, 77 no browser is
installed.
"""

import csv
import sys

from browser import Browser, find_browser

MAX_DRAWING_MS = 150  # with software rendering on a busy machine


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def wait_until_ready(browser):
    """Waits until the recording is unpacked and the frame is drawn."""
    browser.wait("window.replay && replay.hasFrame && !replay.drawRequested && "
                 "[...replay.recording.sections.keys()].every((section) => replay.recording.ready.has(section))")


def wait_for_redraw(browser):
    """Waits for two animation frames."""
    browser.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def check_states(browser, rows):
    """Clicks the vehicle of each row at its time and coordinates, and compares the displayed state with the row."""
    for row in rows:
        time_s = float(row["time_s"])
        browser.value(f"replay.seek({time_s}); replay.select(-1)")
        browser.wait(f"replay.hasFrame && Math.abs(replay.time_s - {time_s}) < 1e-6")
        browser.value(f"replay.map.lookAt({row['x_m']}, {row['y_m']}); replay.map.scale = 12; replay.map.changed()")
        wait_for_redraw(browser)
        box = browser.value("(({left, top, width, height}) => [left, top, width, height])"
                            "(document.getElementById('map').getBoundingClientRect())")
        browser.click(box[0] + box[2] / 2, box[1] + box[3] / 2)
        wait_for_redraw(browser)
        state = browser.value("replay.state")
        check(state is not None, f"there is no vehicle at the position of {row}")
        text = browser.value("document.getElementById('vehicle').innerText")
        check(str(state["vehicle"]) == row["vehicle"], f"vehicle {state['vehicle']} instead of {row['vehicle']}")
        for key in ("policy", "lane"):
            check(state[key] == row[key] and row[key] in text, f"{key} {state[key]} instead of {row[key]}: {text}")
        check(abs(state["speed_mps"] - float(row["speed_mps"])) < 0.0051, f"speed {state} instead of {row}")
        check(f"{state['speed_mps']:.2f} m/s" in text, f"the speed is missing in: {text}")
        # The page shows the position along the lane, the CSV file the position along the route. The two positions are
        # equal on the first lane of a route.
        if row["lane"].endswith(("_in_0", "_in_1")):
            check(abs(state["position_m"] - float(row["position_m"])) < 0.0051, f"position {state} instead of {row}")
            check(f"{state['position_m']:.2f} m" in text, f"the position is missing in: {text}")


def check_paths(browser):
    """Checks that turning vehicles are drawn on the curve between two frames, not on its chord."""
    off_m, turning = browser.value("""(() => {
        let [worst, count] = [0, 0];
        const {network, recording} = replay;
        for (let number = 0; number + 1 < recording.frameCount; ++number) {
            const [from, to] = [recording.frame(number), recording.frame(number + 1)];
            if (!from || !to) continue;
            const placements = network.placements(from);
            const point = [0, 0];
            interpolate(network, from, to, 0.5, recording.head.frame_s, (k, p) => {
                const shape = network.lanes[placements.lane[k]].shape;
                if (shape.numbers.length < 8 || to.indexOf(from.number[k]) < 0) return;
                if (network.placements(to).lane[to.indexOf(from.number[k])] !== placements.lane[k]) return;
                let near = Infinity;
                for (let at = 0; at < shape.length_m; at += 0.05) {
                    shape.pointAt(at, point, 0);
                    near = Math.min(near, Math.hypot(point[0] - p[0], point[1] - p[1]));
                }
                worst = Math.max(worst, near);
                ++count;
            });
        }
        return [worst, count];
    })()""")
    check(turning > 20, f"only {turning} vehicles are on curves")
    check(off_m < 0.05, f"a vehicle is drawn {off_m:.2f} m off its path")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if not find_browser():
        print("skipped: no browser is installed (Debian package chromium)")
        return 77
    with open(sys.argv[2], newline="") as file:
        rows = list(csv.DictReader(file))
    with Browser(1300, 800) as browser:
        browser.open(sys.argv[1], "#t=30")
        wait_until_ready(browser)
        check(abs(browser.value("replay.time_s") - 30) < 1e-6, "the page does not begin at the time in its address")
        paused = browser.screenshot()
        wait_for_redraw(browser)
        check(browser.screenshot() == paused, "the page changes while it is paused")
        browser.click(*browser.value("(({left, top}) => [left + 5, top + 5])(document.getElementById('play')"
                                     ".getBoundingClientRect())"))
        browser.wait("replay.time_s > 33")
        check(browser.value("replay.playing"), "the page does not play")
        browser.value("replay.play(false)")
        check(browser.screenshot() != paused, "the page looks the same at two times")
        for mode in ("policy", "speed", "cause"):
            browser.value(f"replay.setMode('{mode}')")
            wait_for_redraw(browser)
        check_states(browser, rows[::max(len(rows) // 12, 1)])
        check_paths(browser)
        browser.value("replay.map.fit(); replay.seek(1e9)")
        wait_until_ready(browser)
        check(browser.value("document.getElementById('count-exited').textContent") != "0", "no vehicle has exited at the end")
        browser.resize(400, 800)
        wait_for_redraw(browser)
        check(browser.value("document.documentElement.scrollWidth") <= 400, "the page is wider than a narrow screen")
        check(not browser.problems, f"console: {browser.problems}")
    if len(sys.argv) > 3:
        with Browser(1300, 800) as browser:
            browser.open(sys.argv[3], "#t=1e9")
            wait_until_ready(browser)
            present = browser.value("replay.recording.present(replay.recording.frameCount - 1)")
            frame_ms = browser.value("(() => { const begin = performance.now(); for (let k = 20; k > 0; --k) {"
                                    "replay.seek(replay.last_s - 0.07 * k); replay.draw(); }"
                                    "return (performance.now() - begin) / 20; })()")
            print(f"{present} vehicles: {frame_ms:.1f} ms per frame with software rendering")
            check(present >= 5000, f"only {present} vehicles are present")
            check(frame_ms < MAX_DRAWING_MS, f"a frame with {present} vehicles takes {frame_ms:.0f} ms")
            check(not browser.problems, f"console: {browser.problems}")
    print("the page loads, plays and shows the states of the simulation")
    return 0


if __name__ == "__main__":
    sys.exit(main())
