#!/usr/bin/env python3
"""Looks at a replay page in a headless browser, as a user does.

    page_test.py PAGE TRAJECTORIES_CSV [PAGE_WITH_MANY_VEHICLES]

Shows that the page loads without a word on the console and asks no network, plays, looks different at two times, and that a
vehicle that is clicked shows what the simulation wrote into trajectories.csv. Exit codes: 0, 1, 77 where there is no browser.
"""

import csv
import sys

from browser import Browser, find_browser

MOST_DRAWING_MS = 150  # software rendering, on a machine that does other things too


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def ready(browser):
    """All that was asked for is unpacked and drawn."""
    browser.wait("window.replay && replay.hasFrame && !replay.drawRequested && "
                 "[...replay.recording.sections.keys()].every((section) => replay.recording.ready.has(section))")


def settle(browser):
    browser.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def shows_the_state(browser, rows):
    """Seeks to the time of each row, finds the vehicle on the canvas by its coordinates, clicks, and compares."""
    for row in rows:
        time_s = float(row["time_s"])
        browser.value(f"replay.seek({time_s}); replay.select(-1)")
        browser.wait(f"replay.hasFrame && Math.abs(replay.time_s - {time_s}) < 1e-6")
        browser.value(f"replay.map.lookAt({row['x_m']}, {row['y_m']}); replay.map.scale = 12; replay.map.changed()")
        settle(browser)
        box = browser.value("(({left, top, width, height}) => [left, top, width, height])"
                            "(document.getElementById('map').getBoundingClientRect())")
        browser.click(box[0] + box[2] / 2, box[1] + box[3] / 2)
        settle(browser)
        state = browser.value("replay.state")
        check(state is not None, f"no vehicle where {row} is")
        text = browser.value("document.getElementById('vehicle').innerText")
        check(str(state["vehicle"]) == row["vehicle"], f"vehicle {state['vehicle']} instead of {row['vehicle']}")
        for key in ("policy", "lane"):
            check(state[key] == row[key] and row[key] in text, f"{key} {state[key]} instead of {row[key]}: {text}")
        check(abs(state["speed_mps"] - float(row["speed_mps"])) < 0.0051, f"speed {state} instead of {row}")
        check(f"{state['speed_mps']:.2f} m/s" in text, f"no speed in: {text}")
        if row["lane"].endswith(("_in_0", "_in_1")):  # the first lane of a route: place along the route is place on the lane
            check(abs(state["position_m"] - float(row["position_m"])) < 0.0051, f"place {state} instead of {row}")
            check(f"{state['position_m']:.2f} m" in text, f"no place in: {text}")


def keeps_to_its_path(browser):
    """Between two frames, vehicles that turn are drawn on the curve, not on a straight line across it."""
    off_m, turning = browser.value("""(() => {
        let [worst, seen] = [0, 0];
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
                ++seen;
            });
        }
        return [worst, seen];
    })()""")
    check(turning > 20, f"only {turning} vehicles on curves")
    check(off_m < 0.05, f"a vehicle is drawn {off_m:.2f} m beside its path")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if not find_browser():
        print("no browser (Debian package chromium): skipped")
        return 77
    with open(sys.argv[2], newline="") as file:
        rows = list(csv.DictReader(file))
    with Browser(1300, 800) as browser:
        browser.open(sys.argv[1], "#t=30")
        ready(browser)
        check(abs(browser.value("replay.time_s") - 30) < 1e-6, "does not begin where its address says")
        still = browser.screenshot()
        settle(browser)
        check(browser.screenshot() == still, "moves while it is paused")
        browser.click(*browser.value("(({left, top}) => [left + 5, top + 5])(document.getElementById('play')"
                                     ".getBoundingClientRect())"))
        browser.wait("replay.time_s > 33")
        check(browser.value("replay.playing"), "does not play")
        browser.value("replay.play(false)")
        check(browser.screenshot() != still, "looks the same at two times")
        for mode in ("policy", "speed", "cause"):
            browser.value(f"replay.setMode('{mode}')")
            settle(browser)
        shows_the_state(browser, rows[::max(len(rows) // 12, 1)])
        keeps_to_its_path(browser)
        browser.value("replay.map.fit(); replay.seek(1e9)")
        ready(browser)
        check(browser.value("document.getElementById('count-exited').textContent") != "0", "nobody has left at the end")
        browser.resize(400, 800)
        settle(browser)
        check(browser.value("document.documentElement.scrollWidth") <= 400, "wider than a narrow screen")
        check(not browser.problems, f"console: {browser.problems}")
    if len(sys.argv) > 3:
        with Browser(1300, 800) as browser:
            browser.open(sys.argv[3], "#t=1e9")
            ready(browser)
            present = browser.value("replay.recording.present(replay.recording.frameCount - 1)")
            took_ms = browser.value("(() => { const begin = performance.now(); for (let k = 20; k > 0; --k) {"
                                    "replay.seek(replay.last_s - 0.07 * k); replay.draw(); }"
                                    "return (performance.now() - begin) / 20; })()")
            print(f"{present} vehicles: {took_ms:.1f} ms a picture, drawn in software")
            check(present >= 5000, f"only {present} vehicles")
            check(took_ms < MOST_DRAWING_MS, f"{took_ms:.0f} ms for a picture of {present} vehicles")
            check(not browser.problems, f"console: {browser.problems}")
    print("the page loads, plays and shows what the simulation wrote")
    return 0


if __name__ == "__main__":
    sys.exit(main())
