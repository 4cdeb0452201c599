"""A headless Chromium, driven over a pipe with the DevTools protocol: no package besides python3 and chromium."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


player_is_ready = """new Promise((done) => {
  const look = () => (window.helixnavPlayer ? requestAnimationFrame(() => done()) : setTimeout(look, 5));
  look();
})"""
two_frames = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


class Page:
    """One page. `errors` holds what its console said of errors, and exceptions nobody caught."""

    def __init__(self, browser, session):
        self._browser, self._session = browser, session
        self.errors = []
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        return self._browser.call(method, parameters, self._session)

    def look(self, width, height, dark=False, scale=1.0, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=mobile)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def open(self, path):
        """Seconds until the page is loaded and has painted twice."""
        begin = time.monotonic()
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        self._browser.wait_for(self._session, "Page.loadEventFired")
        self.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return time.monotonic() - begin

    def run(self, expression):
        """The value of a script, promises awaited."""
        answer = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:2000])
        return answer["result"].get("value")

    def thread_s(self):
        """Processor seconds of the thread that runs the page's scripts."""
        self.call("Performance.enable", timeDomain="threadTicks")
        metrics = {one["name"]: one["value"] for one in self.call("Performance.getMetrics")["metrics"]}
        return metrics["TaskDuration"]

    def press(self, key, code=None, shift=False):
        more = {"key": key, "code": code or key, "modifiers": 8 if shift else 0}
        if len(key) == 1:
            more["text"] = key
        self.call("Input.dispatchKeyEvent", type="keyDown", **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", **more)

    def touch(self, places):
        """Fingers on the screen: where each is, first and then."""
        for i, fingers in enumerate(places):
            self.call("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart",
                      touchPoints=[{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(fingers)])
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def download_into(self, folder):
        self._browser.call("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": folder})

    def picture(self, path=None, whole=False):
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"])
        if path:
            with open(path, "wb") as file:
                file.write(data)
        return data


class Browser:
    def __init__(self, program=None):
        program = program or shutil.which("chromium") or shutil.which("google-chrome")
        if not program:
            raise RuntimeError("no chromium; apt-get install chromium")
        self._profile = tempfile.TemporaryDirectory()
        to_us, from_it = os.pipe()
        to_it, from_us = os.pipe()

        def as_3_and_4():
            # Both ends away from 3 and 4 first: one may stand where the other must go.
            a, b = os.dup(to_it), os.dup(from_it)
            high_a, high_b = 50, 51
            os.dup2(a, high_a)
            os.dup2(b, high_b)
            os.dup2(high_a, 3)
            os.dup2(high_b, 4)

        self._process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
             "--disable-component-update", "--remote-debugging-pipe", "--user-data-dir=" + self._profile.name, "about:blank"],
            preexec_fn=as_3_and_4, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_it)
        os.close(from_it)
        self._in, self._out = to_us, from_us
        self._rest, self._last, self._events, self._pages = b"", 0, [], {}

    def page(self):
        target = self.call("Target.createTarget", {"url": "about:blank"})["targetId"]
        session = self.call("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        page = self._pages[session] = Page(self, session)
        return page

    def call(self, method, parameters, session=None):
        self._last += 1
        message = {"id": self._last, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def processor_s(self):
        """Processor seconds that pages and painting have used, all threads."""
        processes = self.call("SystemInfo.getProcessInfo", {})["processInfo"]
        return sum(one["cpuTime"] for one in processes if one["type"] != "browser")

    def wait_for(self, session, event):
        while True:
            for i, seen in enumerate(self._events):
                if seen == (session, event):
                    del self._events[i]
                    return
            self._next()

    def _next(self, timeout_s=120):
        while b"\0" not in self._rest:
            if not select.select([self._in], [], [], timeout_s)[0]:
                raise RuntimeError("chromium does not answer")
            data = os.read(self._in, 1 << 20)
            if not data:
                raise RuntimeError("chromium ended")
            self._rest += data
        text, self._rest = self._rest.split(b"\0", 1)
        message = json.loads(text)
        self._note(message)
        return message

    def _note(self, message):
        session, method, more = message.get("sessionId"), message.get("method"), message.get("params", {})
        if method == "Page.loadEventFired":
            self._events.append((session, method))
        page = self._pages.get(session)
        if page is None:
            return
        if method == "Runtime.exceptionThrown":
            details = more["exceptionDetails"]
            page.errors.append(details.get("exception", {}).get("description", details["text"]))
        if method == "Runtime.consoleAPICalled" and more["type"] in ("error", "assert"):
            page.errors.append(json.dumps(more["args"])[:500])
        if method == "Log.entryAdded" and more["entry"]["level"] == "error":
            page.errors.append(more["entry"]["text"])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close", {})
        except (RuntimeError, OSError):
            pass
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._profile.cleanup()
