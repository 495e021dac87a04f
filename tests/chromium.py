"""A page in headless Chromium, driven over the DevTools pipe: for tests of the HTML that ductile writes.

Needs Debian's `chromium` and nothing else. Every request that the page makes and every error in it is recorded.
"""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from pathlib import Path


def chromium():
    """Path of the browser, or None."""
    return shutil.which("chromium")


class Page:
    def __init__(self, file, width=1280, height=720, scale=1, dark=False, timeout=60, gl=False):
        self.requests, self.errors = [], []
        self._timeout, self._id, self._rest, self._replies = timeout, 0, b"", {}
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()

        def in_place():  # the browser reads its commands from 3 and answers on 4
            low = [os.dup2(fd, 100 + i) for i, fd in enumerate((to_browser, from_browser))]
            for fd, place in zip(low, (3, 4)):
                os.dup2(fd, place)

        self._browser = subprocess.Popen(
            [chromium(), "--headless", "--no-sandbox",
             *(("--use-angle=swiftshader", "--enable-unsafe-swiftshader") if gl else ("--disable-gpu",)), "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             # Pages of its own for the address bar, which nobody sees: half a second of the processor.
             "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup",
             "--disable-dev-shm-usage", "--remote-debugging-pipe", f"--user-data-dir={self._profile.name}",
             "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            close_fds=False, preexec_fn=in_place)
        os.close(to_browser)
        os.close(from_browser)
        targets = self._call("Target.getTargets", session=False)["targetInfos"]
        target = next(t["targetId"] for t in targets if t["type"] == "page")
        self._session = self._call("Target.attachToTarget", session=False, targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self._call(domain + ".enable")
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale,
                   mobile=False)
        self._call("Emulation.setEmulatedMedia",
                   features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.url = file if str(file).startswith("http:") else Path(file).absolute().as_uri()
        self._call("Page.navigate", url=self.url)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("Browser.close", session=False)
            self._browser.wait(self._timeout)
        finally:
            self._browser.kill()
            self._browser.wait()
        os.close(self._read)
        os.close(self._write)
        self._profile.cleanup()

    def evaluate(self, expression):
        """The value of a JavaScript expression; promises are awaited."""
        reply = self._call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in reply:
            raise RuntimeError(reply["exceptionDetails"])
        return reply["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + self._timeout
        while not self.evaluate(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"{expression}; errors in the page: {self.errors}")
            time.sleep(0.02)

    def mouse(self, kind, x, y, button="none", buttons=0):
        """kind: mouseMoved, mousePressed or mouseReleased."""
        self._call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=buttons,
                   clickCount=0 if kind == "mouseMoved" else 1)

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, "left", 1)
        self.mouse("mouseReleased", x, y, "left")

    def wheel(self, x, y, pixels):
        """Down for pixels > 0; a notch has 100."""
        self._call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=pixels)
        self.frame()

    def key(self, key, code):
        for kind in ("keyDown", "keyUp"):
            self._call("Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code)

    def frame(self):
        """Waits for two of the page's: the one that is being made, and one that has seen all input."""
        self.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def chord(self, *keys):
        """Keys that are held together for one frame and no longer, so that a slow one does not repeat them; each (key, code,
        number of its key code)."""
        for kind, order in (("rawKeyDown", keys), ("keyUp", keys[::-1])):
            for key, code, number in order:
                self._call("Input.dispatchKeyEvent", type=kind, key=key, code=code, windowsVirtualKeyCode=number)
            self.evaluate("new Promise((done) => requestAnimationFrame(() => done(true)))")

    def type(self, text):
        for letter in text:
            self._call("Input.dispatchKeyEvent", type="char", text=letter)
            self.frame()

    def touch(self, kind, *points):
        """kind: touchStart, touchMove or touchEnd; points: those that touch now."""
        self._call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])
        self.frame()

    def cpu_seconds(self):
        """What the page's process has used of the processor so far."""
        processes = self._call("SystemInfo.getProcessInfo", session=False)["processInfo"]
        return sum(process["cpuTime"] for process in processes if process["type"] == "renderer")

    def middle(self, selector):
        """Centre of an element on the screen."""
        return self.evaluate(f"(r => [r.x + r.width / 2, r.y + r.height / 2])"
                             f"(document.querySelector({json.dumps(selector)}).getBoundingClientRect())")

    def screenshot(self, file):
        data = self._call("Page.captureScreenshot", format="png")["data"]
        Path(file).write_bytes(base64.b64decode(data))

    def _call(self, method, session=True, **params):
        self._id += 1
        message = {"id": self._id, "method": method, "params": params}
        if session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + self._timeout
        while self._id not in self._replies:
            if not select.select([self._read], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError(method)
            chunk = os.read(self._read, 1 << 20)
            if not chunk:
                raise RuntimeError("chromium has gone")
            *messages, self._rest = (self._rest + chunk).split(b"\0")
            for text in messages:
                self._take(json.loads(text))
        reply = self._replies.pop(self._id)
        if "error" in reply:
            raise RuntimeError(f"{method}: {reply['error']}")
        return reply["result"]

    def _take(self, message):
        if "id" in message:
            self._replies[message["id"]] = message
            return
        params = message.get("params", {})
        if message["method"] == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif message["method"] == "Runtime.exceptionThrown":
            self.errors.append(params["exceptionDetails"])
        elif message["method"] == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"])
