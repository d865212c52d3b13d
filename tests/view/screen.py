"""A display of its own (Xvfb), the window on it, and somebody at mouse and keys (xdotool).

What the display shows is read from Xvfb's frame buffer, a file in the format of xwd.
"""

import ctypes
import json
import mmap
import os
import pathlib
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import time

TURNER = os.environ["TURNER"]
OK, USAGE, BAD_INPUT, DEVICE, INTERRUPTED = 0, 2, 3, 4, 130
PATIENCE = 120  # seconds that anything may take on a busy machine


class Skip(Exception):
    """The machine cannot do what the test needs; the text says why."""


def wait_until(what, condition, seconds=PATIENCE):
    """The first true result of `condition`."""
    end = time.monotonic() + seconds
    while True:
        result = condition()
        if result:
            return result
        assert time.monotonic() < end, f"waited {seconds} s: {what}"
        time.sleep(0.03)


def check_machine():
    for tool, package in (("Xvfb", "xvfb"), ("xdotool", "xdotool")):
        if not shutil.which(tool):
            raise Skip(f"{tool} is not there; install {package}")
    if subprocess.run([TURNER, "devices"], capture_output=True, timeout=60).returncode:
        raise Skip("no Vulkan device")
    done = subprocess.run([TURNER, "view"], capture_output=True, text=True, timeout=60)
    if "built without a window" in done.stderr:
        raise Skip("turner was built without a window")


class Screen:
    """An X server that shows itself to nobody."""

    def __init__(self, width=800, height=600):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="turner-view-"))
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-nolisten",
             "tcp", "-noreset", "-fbdir", str(self.folder)], pass_fds=[write],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        # -noreset: else it begins anew when its last client leaves, and refuses others meanwhile
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise Skip("Xvfb does not start")
        self.display = ":" + number
        self.environment = dict(os.environ, DISPLAY=self.display)
        with open(self.folder / "Xvfb_screen0", "rb") as file:
            self.buffer = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        header = struct.unpack(">25I", self.buffer[:100])
        self.width, self.height, self.stride = header[4], header[5], header[12]
        assert header[11] == 32, "bits a pixel"
        self.pixels = header[0] + 12 * header[19]

    def shown(self, width, height):
        """RGB bytes of the top left corner, where a window without a window manager is."""
        rows = []
        for y in range(height):
            start = self.pixels + y * self.stride
            row = self.buffer[start:start + 4 * width]
            rgb = bytearray(3 * width)
            rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
            rows.append(bytes(rgb))
        return b"".join(rows)

    def close(self):
        self.buffer.close()
        self.server.terminate()
        self.server.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class View:
    """`turner view` on a screen."""

    all = []

    def __init__(self, screen, *arguments, environment=None):
        print("$ turner view", *arguments)
        View.all.append(self)
        self.screen = screen
        self.process = subprocess.Popen(
            [TURNER, "view", *map(str, arguments)], stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env=dict(screen.environment, **(environment or {})))
        self.window = None
        self.printed = b""

    def xdo(self, *arguments):
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.screen.environment,
                              capture_output=True, text=True, timeout=60)
        return done.stdout.strip()

    def find(self):
        """Waits for the window, and gives it the keys."""
        def there():
            assert self.process.poll() is None, "it ended: " + self.process.stderr.read()
            return self.xdo("search", "--onlyvisible", "--name", " turner$")
        self.window = wait_until("no window", there).split()[0]
        self.focus()
        self.xdo("mousemove", self.screen.width - 1, self.screen.height - 1)  # it is drawn, too
        return self

    def focus(self):
        def focused():
            self.xdo("windowfocus", self.window)
            return self.xdo("getwindowfocus") == self.window
        wait_until("the window does not get the keys", focused)

    def key(self, *names):
        self.xdo("key", *names)

    def wait_for_picture(self, width, height, wanted):
        """Until it is shown, but for the rows at the bottom where messages come and go."""
        size = 3 * width * (height - 40 if height > 80 else height)
        wait_until("the picture is not shown",
                   lambda: self.screen.shown(width, height)[:size] == wanted[:size])

    def press_close_button(self):
        """What a window manager does then; there is none here."""
        class Message(ctypes.Structure):
            _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong),
                        ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                        ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
                        ("format", ctypes.c_int), ("data", ctypes.c_long * 5),
                        ("rest", ctypes.c_long * 16)]
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        x11.XInternAtom.restype = ctypes.c_ulong
        display = ctypes.c_void_p(x11.XOpenDisplay(self.screen.display.encode()))
        atoms = [x11.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS",
                                                                b"WM_DELETE_WINDOW")]
        window = ctypes.c_ulong(int(self.window))
        message = Message(type=33, window=window, message_type=atoms[0], format=32)
        message.data[0] = atoms[1]
        x11.XSendEvent(display, window, 0, ctypes.c_long(0), ctypes.byref(message))
        x11.XCloseDisplay(display)

    def line(self):
        """The next line it prints."""
        while b"\n" not in self.printed:
            ready, _, _ = select.select([self.process.stdout], [], [], PATIENCE)
            assert ready, "nothing was printed"
            piece = os.read(self.process.stdout.fileno(), 65536)
            assert piece, "it ended"
            self.printed += piece
        line, self.printed = self.printed.split(b"\n", 1)
        return line.decode() + "\n"

    def camera(self):
        """What C prints."""
        self.key("c")
        return json.loads(self.line())

    def drag(self, button, x, y, dx, dy, *held):
        """In steps, as a hand does; `held` are keys."""
        self.xdo("mousemove", x, y)
        if held:
            self.xdo("keydown", *held)
        time.sleep(0.1)  # as slow as a hand: the panel looks at the mouse once a frame (drag_until)
        self.xdo("mousedown", button)
        time.sleep(0.1)
        for step in (0.3, 0.7, 1):
            self.xdo("mousemove", max(0, x + round(step * dx)), max(0, y + round(step * dy)))
        time.sleep(0.1)
        self.xdo("mouseup", button)
        if held:
            self.xdo("keyup", *held)

    def drag_until(self, what, done, button, place, dx, dy):
        """On the panel, from place(): again where it was too busy to look at the mouse in between."""
        end = time.monotonic() + PATIENCE
        while not done():
            assert time.monotonic() < end, what
            self.drag(button, *place(), dx, dy)
            try:
                wait_until(what, done, 5)
            except AssertionError:
                pass

    def rests(self):
        """Whether it takes no processor time for two seconds, but for a tick."""
        before = self.cpu()
        time.sleep(2)
        return self.cpu() - before <= 1

    def cpu(self):
        """Ticks of processor time so far."""
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1]
        return sum(map(int, fields.split()[11:13]))

    def memory(self):
        """Bytes that are resident."""
        pages = int(pathlib.Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGESIZE")

    def end(self, status=OK):
        """Waits for the end; returns what it printed."""
        out, err = self.process.communicate(timeout=PATIENCE)
        print(out[:2000], err, "=>", self.process.returncode, sep="")
        assert self.process.returncode == status, f"status {self.process.returncode}"
        assert "validation" not in err, "the validation layers have something to say"
        if status in (OK, INTERRUPTED):
            assert err == "", "something was said: " + err
        return out, err

    def quit(self):
        self.key("q")
        return self.end()

    def close(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()


def render(scene, output, *arguments):
    """What the picture is to be: `turner render` into a file; its bytes."""
    done = subprocess.run([TURNER, "render", scene, "-q", "-o", output, *map(str, arguments)],
                          capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return pathlib.Path(output).read_bytes() if "--path" not in arguments else None


def ppm_pixels(data):
    """Width, height and RGB bytes of a binary PPM."""
    fields = data.split(None, 4)
    assert fields[0] == b"P6" and fields[3] == b"255", "that is no PPM"
    width, height = int(fields[1]), int(fields[2])
    return width, height, data[-3 * width * height:]
