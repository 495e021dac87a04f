"""A program under Xvfb, with a pointer, keys and files dropped on its window as another program would drop them."""
import os
import shutil
import subprocess
import time

try:
    from Xlib import X, XK, display
    from Xlib.ext import xtest
    from Xlib.protocol import event
except ImportError:
    display = None


def missing():
    """What of this machine a test lacks; None: nothing."""
    if not shutil.which("Xvfb"):
        return "Xvfb is not here (Debian: xvfb)"
    return None if display else "python3-xlib is not here"


class Screen:
    """An X server of its own."""

    def __init__(self, width=1280, height=720):
        out, self._name = os.pipe()[::-1]
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(out), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"],
            pass_fds=[out], stderr=subprocess.DEVNULL)
        os.close(out)
        with os.fdopen(self._name) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError("Xvfb did not start")
        self.env = dict(os.environ, DISPLAY=":" + number, LIBGL_ALWAYS_SOFTWARE="1")
        self.display = display.Display(":" + number)
        self.root = self.display.screen().root

    def close(self):
        self.display.close()
        self.server.terminate()
        self.server.wait()

    def window(self):
        """The one on the screen, once it is there."""
        for _ in range(200):
            for window in self.root.query_tree().children:
                if window.get_attributes().map_state == X.IsViewable and window.get_wm_protocols():
                    window.set_input_focus(X.RevertToParent, X.CurrentTime)
                    self.display.sync()
                    return window
            time.sleep(0.05)
        raise RuntimeError("there is no window")

    def move(self, x, y):
        xtest.fake_input(self.display, X.MotionNotify, x=round(x), y=round(y))
        self.display.sync()

    def press(self, button=1, down=True):
        xtest.fake_input(self.display, X.ButtonPress if down else X.ButtonRelease, button)
        self.display.sync()

    def key(self, name, down=True):
        code = self.display.keysym_to_keycode(XK.string_to_keysym(name))
        xtest.fake_input(self.display, X.KeyPress if down else X.KeyRelease, code)
        self.display.sync()

    def quit(self, window):
        """What a window manager asks when its cross is clicked."""
        atom = self.display.intern_atom
        window.send_event(event.ClientMessage(window=window, client_type=atom("WM_PROTOCOLS"),
                                              data=(32, [atom("WM_DELETE_WINDOW"), X.CurrentTime, 0, 0, 0])))
        self.display.sync()

    def drop(self, window, files, x, y):
        """Drag and drop by the XDND protocol, version 5, as a file manager does it."""
        atom = self.display.intern_atom
        source = self.root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
        uris = "".join(f"file://{file}\r\n" for file in files).encode()

        def tell(kind, *data):
            window.send_event(event.ClientMessage(window=window, client_type=atom(kind),
                                                  data=(32, [source.id, *data])))
            self.display.sync()

        def wait(done):
            end = time.monotonic() + 10
            while time.monotonic() < end:
                if not self.display.pending_events():
                    time.sleep(0.01)
                    continue
                message = self.display.next_event()
                if message.type == X.SelectionRequest:
                    message.requestor.change_property(message.property, message.target, 8, uris)
                    message.requestor.send_event(event.SelectionNotify(
                        time=message.time, requestor=message.requestor, selection=message.selection,
                        target=message.target, property=message.property))
                    self.display.sync()
                elif message.type == X.ClientMessage and message.client_type == atom(done):
                    return message
            raise RuntimeError("no " + done)

        self.move(x, y)
        tell("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
        tell("XdndPosition", 0, (round(x) << 16) | round(y), X.CurrentTime, atom("XdndActionCopy"))
        if not wait("XdndStatus").data[1][1] & 1:
            raise RuntimeError("the window takes no files")
        tell("XdndDrop", 0, X.CurrentTime, 0, 0)
        wait("XdndFinished")
        source.destroy()
