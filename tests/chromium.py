# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A page in headless Chromium, by the DevTools protocol over a pipe: messages of JSON, each ended by a zero byte.

Nothing but the page's own file can be reached: names resolve nowhere and the page is told that it is offline; what it asked for is
kept in `requests`, what it complained of in `complaints`."""
import base64
import json
import os
import pathlib
import select
import shlex
import shutil
import subprocess
import tempfile
import time


def program():
    return os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")


class Page:
    def __init__(self, address, width=1440, height=1100, arguments=(), before=None):
        """`before`: a script that runs before the page's own."""
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        reading, self.out = os.pipe()
        self.into, writing = os.pipe()
        command = [program(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                   "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
                   "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}",
                   "--force-color-profile=srgb", "--remote-debugging-pipe", *arguments, "about:blank"]
        self.process = subprocess.Popen(["sh", "-c", f"exec {shlex.join(command)} 3<&{reading} 4>&{writing}"], pass_fds=(reading, writing),
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(reading)
        os.close(writing)
        self.text, self.number, self.session = b"", 0, None
        self.complaints, self.requests = [], []
        target = next(each for each in self.call("Target.getTargets")["targetInfos"] if each["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Network", "Page"):
            self.call(f"{domain}.enable")
        self.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        if before:
            self.call("Page.addScriptToEvaluateOnNewDocument", source=before)
        self.loaded = False
        self.call("Page.navigate", url=address)
        while not self.loaded:
            self.keep(self.message(60))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.out)
        os.close(self.into)
        self.folder.cleanup()

    def message(self, seconds):
        end = time.monotonic() + seconds
        while b"\0" not in self.text:
            ready, _, _ = select.select([self.into], [], [], max(end - time.monotonic(), 0))
            some = os.read(self.into, 1 << 20) if ready else b""
            if not some:
                raise TimeoutError(f"Chromium said nothing for {seconds} s, or ended")
            self.text += some
        one, self.text = self.text.split(b"\0", 1)
        return json.loads(one)

    def keep(self, message):
        """What happened meanwhile."""
        what, said = message.get("method"), message.get("params", {})
        if what == "Page.loadEventFired":
            self.loaded = True
        elif what == "Runtime.exceptionThrown":
            details = said["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description") or details["text"])
        elif what == "Runtime.consoleAPICalled" and said["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(each.get("value", each.get("description"))) for each in said["args"]))
        elif what == "Log.entryAdded" and said["entry"]["level"] in ("error", "warning"):
            self.complaints.append(said["entry"]["text"])
        elif what == "Network.requestWillBeSent":
            self.requests.append(said["request"]["url"])

    def call(self, method, seconds=60, **params):
        self.number += 1
        call = {"id": self.number, "method": method, "params": params}
        if self.session:
            call["sessionId"] = self.session
        os.write(self.out, json.dumps(call).encode() + b"\0")
        while True:
            message = self.message(seconds)
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]
            self.keep(message)

    def run(self, script, seconds=60):
        """The value of an expression, awaited if it is a promise."""
        done = self.call("Runtime.evaluate", seconds, expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in done:
            raise RuntimeError(done["exceptionDetails"].get("exception", {}).get("description") or done["exceptionDetails"]["text"])
        return done["result"].get("value")

    def until(self, condition, seconds=60):
        """Waits until an expression is true; its value."""
        end = time.monotonic() + seconds
        while not (value := self.run(condition)):
            if time.monotonic() > end:
                raise TimeoutError(f"{condition} is not so after {seconds} s")
            time.sleep(0.05)
        return value

    def picture(self, file):
        pathlib.Path(file).write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
