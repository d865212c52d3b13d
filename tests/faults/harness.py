"""What every fault has: a folder of its own, the command, and what must be true afterwards.

A fault is a function of one argument, the Place it happens in, marked with @fault. It fails by an
AssertionError and is skipped by a Skip, which says why.
"""

import os
import pathlib
import resource
import select
import shutil
import signal
import subprocess
import tempfile
import time

TURNER = os.environ["TURNER"]
SANITIZED = os.environ.get("TURNER_SANITIZED", "") not in ("", "0", "OFF")

OK, DIFFERS, USAGE, BAD_INPUT, DEVICE, OUTPUT = range(6)

faults = {}  # name: (function, needs a device)


class Skip(Exception):
    """The machine cannot do what the fault needs; the text says why."""


def fault(function=None, *, name=None, device=False):
    """Registers a fault under the function's name, or `name`."""
    def register(f):
        faults[name or f.__name__] = (f, device)
        return f
    return register(function) if function else register


# The smallest scene that draws anything: a gradient, whose picture does not compress to nothing.
CAMERA = '"camera": {"from": [0, 0, 5], "at": [0, 0, 0]}'
SCENE = '{"version": 1, %s, "background": {"type": "gradient", "bottom": [0.1, 0.2, 0.3], ' \
        '"top": [1, 0.5, 0.25]}, "settings": {"size": [32, 24]}}' % CAMERA
# Something on every path of the kernel: a mirror, glass, a diffuse box, two lights.
FULL_SCENE = """{"version": 1, "camera": {"from": [0, 1, 5], "at": [0, 0, 0]},
 "background": 0.5, "settings": {"size": [48, 32]},
 "materials": {"mirror": {"k_r": 0.9}, "glass": {"k_r": 1, "k_t": 1, "index": 1.5},
               "grey": {"k_d": 0.5, "k_s": 0.1, "exponent": 20}},
 "primitives": [
  {"type": "sphere", "center": [-1, 0, 0], "radius": 0.8, "material": "mirror"},
  {"type": "sphere", "center": [1, 0, 0], "radius": 0.8, "material": "glass"},
  {"type": "box", "min": [-3, -2, -2], "max": [3, -1, 1], "material": "grey"}],
 "lights": [{"type": "point", "position": [2, 4, 3], "intensity": 30},
            {"type": "directional", "direction": [1, -1, 0], "irradiance": 1}]}"""


class Place:
    """A temporary folder, whose content is what a fault may not change."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="turner-fault-"))
        self.folder.chmod(0o755)  # others may look in, for faults that are run as nobody
        self.write("scene.json", SCENE)

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def files(self):
        """All there is: {name: bytes, or None for a folder}."""
        found = {}
        for path in sorted(self.folder.rglob("*")):
            name = str(path.relative_to(self.folder))
            found[name] = path.read_bytes() if path.is_file() else None
        return found

    def run(self, *arguments, command=(), env=None, timeout=60, **options):
        """The command in this folder. Returns (status, stdout, stderr); prints what it does."""
        environment = dict(os.environ, LC_ALL="C.UTF-8", **(env or {}))
        line = [*command, options.pop("program", TURNER), *map(str, arguments)]
        shown = [f"{key}={value}" for key, value in (env or {}).items()] + ["turner", *line[1:]]
        print("$", " ".join(shown) if not command else " ".join(line))
        start = time.monotonic()
        done = subprocess.run(line, cwd=self.folder, env=environment, timeout=timeout,
                              stdin=subprocess.DEVNULL,
                              stdout=options.pop("stdout", subprocess.PIPE),
                              stderr=subprocess.PIPE, **options)
        out = (done.stdout or b"").decode(errors="replace")
        err = done.stderr.decode(errors="replace")
        print(f"{out}{err}=> {done.returncode} ({time.monotonic() - start:.2f} s)")
        return done.returncode, out, err

    def refuses(self, status, messages, *arguments, **options):
        """The command ends with `status`, says every one of `messages` in one error on stderr, and
        leaves the folder as it was."""
        if isinstance(messages, str):
            messages = [messages]
        before = self.files()
        returned, out, err = self.run(*arguments, **options)
        require(returned == status, f"exit status {returned} instead of {status}")
        require(err.startswith("turner: error: ") and err.count("turner: error: ") == 1,
                "not one error on stderr")
        require(not out, "text on stdout")
        for message in messages:
            require(message in err, f"the message lacks: {message}")
        self.unchanged(before)
        return err

    def unchanged(self, before):
        after = self.files()
        for name in sorted(set(before) | set(after)):
            require(name in after, f"{name} is gone")
            require(name in before, f"{name} was left behind")
            require(before[name] == after[name], f"{name} has changed")

    def succeeds(self, *arguments, **options):
        status, out, err = self.run(*arguments, **options)
        require(status == OK, f"exit status {status} instead of 0")
        return out


def require(condition, text):
    if not condition:
        raise AssertionError(text)


def needs_device():
    """Skips unless a Vulkan device that turner can use is there."""
    done = subprocess.run([TURNER, "devices"], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise Skip(done.stderr.strip())
    if not any(line.startswith("   bvh         yes") for line in done.stdout.splitlines()):
        raise Skip("no Vulkan device has what turner requires")


def as_nobody(place):
    """Options for Place.run that make the command an ordinary user, to whom permissions mean
    something: root may write anywhere."""
    if os.geteuid() != 0:
        return {}
    copy = place.folder / "turner"
    shutil.copy(TURNER, copy)
    copy.chmod(0o755)
    who = {"user": 65534, "group": 65534, "extra_groups": []}
    try:
        done = subprocess.run([copy, "--version"], capture_output=True, text=True, **who)
    except OSError as error:
        raise Skip(f"root cannot become another user here: {error}") from error
    if done.returncode != 0:
        raise Skip("another user cannot run the command here: " + done.stderr.strip())
    return {"program": str(copy), **who}


class Running:
    """The command at work, with a terminal as its stderr so that the progress bar is seen."""

    def __init__(self, place, *arguments, env=None, ignore=()):
        def prepare():
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_IGN if number in ignore else signal.SIG_DFL)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        print("$ turner", *arguments, "&")
        self.terminal, end = os.openpty()
        self.process = subprocess.Popen(
            [TURNER, *map(str, arguments)], cwd=place.folder, preexec_fn=prepare,
            env=dict(os.environ, TERM="xterm", **(env or {})),
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=end)
        os.close(end)
        self.shown = b""

    def wait_until_tracing(self, seconds=60):
        """Until the progress bar has moved on: something is being traced."""
        end = time.monotonic() + seconds
        while self.shown.count(b"\r[") < 3:
            require(time.monotonic() < end, "no progress was shown: " + repr(self.shown))
            ready, _, _ = select.select([self.terminal], [], [], 0.05)
            if ready:
                try:
                    self.shown += os.read(self.terminal, 65536)
                except OSError:  # the other end is closed
                    pass
            require(self.process.poll() is None, "it ended before it was interrupted: "
                    + repr(self.shown))

    def end(self, number):
        """Sends a signal; returns the status and the seconds until the end."""
        start = time.monotonic()
        self.process.send_signal(number)
        status = self.process.wait(timeout=30)
        seconds = time.monotonic() - start
        print(f"{signal.Signals(number).name} => {status} after {seconds:.3f} s")
        return status, seconds

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.terminal)
