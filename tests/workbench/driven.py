"""The window of `ductile view` under Xvfb, driven by pointer and keys; what it shows is known from --trace."""
import json
import subprocess
import tempfile
import threading
import time
import unittest

import xwindow


def missing(command, scenes):
    """What a window lacks here; None: nothing."""
    probe = subprocess.run([command, "view", scenes / "cantilever.scene.json", "--frames", "0"],
                           capture_output=True, text=True, env={"DISPLAY": ":no"})
    return xwindow.missing() or (probe.stderr.strip() if "without its window" in probe.stderr else None)


class Window(unittest.TestCase):
    """One window per test, small so that software draws it fast; self.state is what the last frame showed."""

    def open(self, command, screen, scene):
        self.screen = screen
        self.kept = tempfile.TemporaryDirectory()  # what it keeps of the user, who is another one here
        self.process = subprocess.Popen([command, "view", scene, "--zoom", "0.5", "--trace"],
                                        env={**screen.env, "XDG_STATE_HOME": self.kept.name},
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.frames, self.line = 0, ""
        self.reader = threading.Thread(target=self.read)
        self.reader.start()
        self.window = screen.window()
        screen.move(2500, 1400)  # off the window
        self.settle()

    def read(self):
        for line in self.process.stdout:
            self.line = line
            self.frames += 1

    def close(self):
        self.screen.quit(self.window)
        if self.state["changed"]:  # asked once more, it goes
            self.settle()
            self.screen.quit(self.window)
        _, code = self.process.stderr.read(), self.process.wait(timeout=20)
        self.reader.join()
        self.process.stdout.close()
        self.process.stderr.close()
        self.kept.cleanup()
        self.assertEqual(code, 0)

    @property
    def state(self):
        return json.loads(self.line)

    def settle(self, frames=2):
        """So many frames go by: the one that is being made, and at least one that has seen all input."""
        until = self.frames + frames
        self.wait(lambda: self.frames >= until)

    def wait(self, done, seconds=20):
        end = time.monotonic() + seconds
        while not done():
            self.assertIsNone(self.process.poll(), "the window has gone")
            self.assertLess(time.monotonic(), end, "it does not come; last: " + self.line[:2000])
            time.sleep(0.005)

    def key(self, name, *modifiers):
        for modifier in modifiers:
            self.screen.key(modifier)
        self.screen.key(name)
        self.settle()
        for key in (name, *modifiers):
            self.screen.key(key, down=False)
        self.settle()

    def drag(self, start, end, *modifiers):
        self.screen.move(*start)
        for modifier in modifiers:
            self.screen.key(modifier)
        self.settle()
        self.screen.press()
        self.settle()
        if end != start:
            for k in range(1, 4):
                self.screen.move(*(a + (b - a) * k / 3 for a, b in zip(start, end)))
                self.settle()
        self.screen.press(down=False)
        for modifier in modifiers:
            self.screen.key(modifier, down=False)
        self.settle(3)

    def click(self, at, *modifiers):
        self.drag(at, at, *modifiers)

    def control(self, name, across=0.5):
        """A click on a control, at a share of its width with its label."""
        self.wait(lambda: name in self.state["controls"])
        self.settle()  # what has just opened may still move
        x0, y0, x1, y1 = self.state["controls"][name]
        self.click((x0 + across * (x1 - x0), (y0 + y1) / 2))

    def type(self, text):
        for letter in text:
            self.key({" ": "space", ".": "period"}.get(letter, letter.lower()), *(["Shift_L"] if letter.isupper() else []))

    def reach(self, control):
        """Gives it the keys, in the panel on the right."""
        self.key("Tab")
        self.wait(lambda: self.state["focus"] == control or self.key("Down"))

    def pause_at(self, step):
        self.wait(lambda: self.state["step"] >= step)
        self.key("p")
        self.assertFalse(self.state["playing"])
