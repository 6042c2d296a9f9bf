"""Controls a headless Chromium through the DevTools protocol over pipes, with Python's standard library only."""

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

NAMES = ["chromium", "chromium-browser", "google-chrome"]
LIMIT_S = 60


def find_browser():
    return next((path for path in map(shutil.which, NAMES) if path), None)


def move_above_shell_descriptors(descriptor):
    """Duplicates a pipe, closes the original and returns the duplicate. The duplicate has a number from 20 up, because
    the shell in Browser redirects the pipes to the numbers 3 and 4."""
    copy = fcntl.fcntl(descriptor, fcntl.F_DUPFD, 20)
    os.close(descriptor)
    return copy


class Browser:
    """A browser with one page. `problems` collects console errors and warnings, exceptions, and network requests."""

    def __init__(self, width, height):
        self.folder = tempfile.mkdtemp()
        to_browser, self.to_browser = map(move_above_shell_descriptors, os.pipe())
        self.from_browser, from_browser = map(move_above_shell_descriptors, os.pipe())
        command = [find_browser(), "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
                   "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe",
                   f"--user-data-dir={self.folder}", f"--window-size={width},{height}", "about:blank"]
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "browser", *command],
            pass_fds=(to_browser, from_browser), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.number = 0
        self.session = None
        self.problems = []
        self.loaded = False
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def receive(self, until):
        """Returns the next message of the browser."""
        while b"\0" not in self.buffer:
            if not select.select([self.from_browser], [], [], max(until - time.monotonic(), 0))[0]:
                raise TimeoutError("the browser does not answer")
            chunk = os.read(self.from_browser, 1 << 20)
            if not chunk:
                raise RuntimeError("the browser has exited")
            self.buffer += chunk
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def record_problem(self, message):
        """Adds an event of the page to `problems`, and notices that the page has loaded."""
        method, params = message.get("method"), message.get("params", {})
        if method == "Page.loadEventFired":
            self.loaded = True
        elif method == "Runtime.exceptionThrown":
            self.problems.append(json.dumps(params["exceptionDetails"])[:500])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.problems.append(json.dumps(params["args"])[:500])
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.problems.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent" and not params["request"]["url"].startswith(("file:", "data:", "blob:")):
            self.problems.append("requests from the network: " + params["request"]["url"])

    def call(self, method, **params):
        """Calls a method of the DevTools protocol. Returns its result."""
        self.number += 1
        request = {"id": self.number, "method": method, "params": params}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(request).encode() + b"\0")
        until = time.monotonic() + LIMIT_S
        while True:
            message = self.receive(until)
            if message.get("id") != self.number:
                self.record_problem(message)
                continue
            if "error" in message:
                raise RuntimeError(f"{method}: {message['error']}")
            return message["result"]

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, path, address=""):
        self.loaded = False
        self.call("Page.navigate", url=f"file://{os.path.abspath(path)}{address}")
        self.wait("document.readyState === 'complete'")

    def value(self, expression):
        """Evaluates a JavaScript expression in the page. Returns its value."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {json.dumps(result['exceptionDetails'])[:500]}")
        return result["result"].get("value")

    def wait(self, condition):
        """Waits until a JavaScript condition is true."""
        until = time.monotonic() + LIMIT_S
        while not self.value(condition):
            if time.monotonic() > until:
                raise TimeoutError(f"the condition did not become true: {condition}; problems: {self.problems}")
            time.sleep(0.05)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def screenshot(self, path=None):
        picture = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path:
            with open(path, "wb") as file:
                file.write(picture)
        return picture
