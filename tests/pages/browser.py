"""A headless Chromium, spoken to over a pair of pipes: one page at a time, and all that it says.

Nothing but Debian's package chromium and Python is needed. The protocol: one JSON message after the other,
each ended by a zero byte (chromedevtools.github.io/devtools-protocol).
"""
import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import failures  # pylint: disable=wrong-import-position

SECONDS_MAX = 300  # that a page may take for anything before it counts as hung
PAPER = 718  # px of 1/96 inch: A4 between Chromium's margins


class BrowserError(Exception):
    """What the browser refused, or never answered."""


def program():
    """Where Chromium is."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not found:
        raise BrowserError("no Chromium here; `.ci/setup.sh test` installs it")
    return found


class Browser:
    """Used with `with`. @param webgl: without it pages find none, as on a machine that has none"""

    def __init__(self, webgl=True):
        self.profile = tempfile.TemporaryDirectory(prefix="tenon_chromium_")
        to_browser, self.writing = os.pipe()
        self.reading, from_browser = os.pipe()

        def descriptors():
            # Chromium reads from 3 and writes to 4. Moved out of the way first: either may be one of these.
            inward, outward = os.dup(to_browser), os.dup(from_browser)
            high_in, high_out = 100, 101
            os.dup2(inward, high_in)
            os.dup2(outward, high_out)
            os.dup2(high_in, 3)
            os.dup2(high_out, 4)

        graphics = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        self.process = subprocess.Popen(
            [program(), "--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--no-first-run",
             "--disable-extensions", "--hide-scrollbars", f"--user-data-dir={self.profile.name}",
             "--disable-background-networking", "--disable-dev-shm-usage",
             *(graphics if webgl else ["--disable-3d-apis"]), "about:blank"],
            preexec_fn=descriptors, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.number = 0
        self.events = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = None
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.writing)
        os.close(self.reading)
        # Its helpers may write a last time while the folder goes.
        for _ in range(10):
            try:
                self.profile.cleanup()
                return
            except OSError:
                time.sleep(0.1)

    def receive(self, seconds):
        """The next message; None if there is none in time."""
        end = time.monotonic() + seconds
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.reading], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                return None
            read = os.read(self.reading, 1 << 20)
            if not read:
                raise BrowserError("Chromium has ended by itself")
            self.buffer += read
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        """One command and its answer; events that come meanwhile are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if getattr(self, "session", None):
            message["sessionId"] = self.session
        os.write(self.writing, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + SECONDS_MAX
        while time.monotonic() < end:
            answer = self.receive(end - time.monotonic())
            if answer is None:
                break
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise BrowserError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)
        raise BrowserError(f"{method}: no answer in {SECONDS_MAX} s")

    def evaluate(self, expression):
        """The value of a JavaScript expression; promises are waited for."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise BrowserError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + SECONDS_MAX
        while not self.evaluate(expression):
            if time.monotonic() > end:
                raise BrowserError(f"still not so after {SECONDS_MAX} s: {expression}")
            time.sleep(0.05)

    def wait_for_event(self, method):
        """Until the browser tells of it by itself: a page that is being replaced may leave a question unanswered."""
        end = time.monotonic() + SECONDS_MAX
        while not any(event.get("method") == method for event in self.events):
            event = self.receive(max(0.0, end - time.monotonic()))
            if event is None:
                raise BrowserError(f"no {method} in {SECONDS_MAX} s")
            self.events.append(event)

    def open(self, file, width=1400, height=900, dark=False, calm=True, fragment=""):
        """@param file: or an address that begins with http  @param calm: the reader wants no motion: nothing plays by
        itself"""
        served = str(file).startswith("http")
        self.events.clear()
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                  mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", media="", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if calm else "no-preference"}])
        self.call("Page.navigate", url="about:blank")
        self.events.clear()
        self.call("Page.navigate", url=(str(file) if served else pathlib.Path(file).resolve().as_uri()) + fragment)
        self.wait_for("document.readyState === 'complete' && document.body.childElementCount > 0")

    def to_paper(self, width=PAPER):
        """As the open page is printed by who reads it dark. A page is told of a printer; emulation leaves that out."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=1000, deviceScaleFactor=1, mobile=False)
        self.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        self.call("Emulation.setEmulatedMedia", media="print",
                  features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def said(self):
        """What the page wrote to the console, threw, or the browser noted about it."""
        texts = []
        end = time.monotonic() + 1.0  # a page that is served events never falls silent
        while time.monotonic() < end and (event := self.receive(0.2)) is not None:
            self.events.append(event)
        for event in self.events:
            parameters = event.get("params", {})
            if event.get("method") == "Runtime.consoleAPICalled":
                texts.append(" ".join(str(a.get("value", a.get("description"))) for a in parameters["args"]))
            elif event.get("method") == "Runtime.exceptionThrown":
                texts.append(str(parameters["exceptionDetails"]))
            elif event.get("method") == "Log.entryAdded":
                texts.append(parameters["entry"]["text"])
        return texts

    def requests(self):
        """All that the page asked for beside itself."""
        urls = [event["params"]["request"]["url"] for event in self.events
                if event.get("method") == "Network.requestWillBeSent"]
        return [url for url in urls[1:] if not url.startswith("data:")]

    def picture(self, file, whole=True):
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        pathlib.Path(file).write_bytes(base64.b64decode(data))


def run_test(test):
    """Runs the test of a page, and ends the program; see tests/support/failures.py."""
    failures.run_test(test, BrowserError)
