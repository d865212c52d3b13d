"""Pictures that cannot be written, and the command ended in the middle: what was there before stays
as it was, byte for byte."""

import errno
import os
import resource
import shutil
import signal
import subprocess

from harness import (BAD_INPUT, OK, OUTPUT, SANITIZED, TURNER, USAGE, Running, Skip, as_nobody,
                     fault, require)

OLD = b"an old picture"
REFERENCE = ("render", "scene.json", "--device", "reference")  # needs no Vulkan
LONG = ("--size", "64x65536", "--spp", "1024")  # for hours, in many small steps


# ---- refused before anything is drawn ----

def output_fault(name, path, status, message, prepare=lambda folder: None):
    def check(place):
        prepare(place.folder)
        # the missing scene shows that the output is looked at first
        place.refuses(status, message, "render", "no.json", "-o", path)
    fault(check, name="output_" + name)


output_fault("is_folder", "folder.png", OUTPUT,
             "cannot write folder.png: it is a folder; name a file",
             lambda folder: (folder / "folder.png").mkdir())
output_fault("folder_missing", "no/picture.png", OUTPUT,
             "cannot write no/picture.png: No such file or directory; create the folder first or "
             "choose another")
output_fault("in_a_file", "scene.json/picture.png", OUTPUT,
             "cannot write scene.json/picture.png: Not a directory; create the folder first or "
             "choose another")
output_fault("is_device", "link.png", OUTPUT,
             "cannot write link.png: it is not an ordinary file; name a file",
             lambda folder: (folder / "link.png").symlink_to("/dev/full"))
output_fault("name_too_long", "x" * 300 + ".png", OUTPUT, "File name too long")
output_fault("unknown_ending", "picture.xyz", USAGE,
             "picture.xyz: the ending says no picture format that can be written; use .exr .hdr "
             ".tif (linear floats), .png .jpg .ppm (8 bit) or .16.png (16 bit)")
output_fault("without_ending", "picture", USAGE,
             "picture: the ending says no picture format that can be written")


@fault
def output_folder_read_only(place):
    options = as_nobody(place)
    locked = place.folder / "locked"
    locked.mkdir()
    (locked / "picture.png").write_bytes(OLD)
    (locked / "picture.png").chmod(0o666)
    locked.chmod(0o555)
    for name in ("picture.png", "new.png"):
        place.refuses(OUTPUT, f"cannot write locked/{name}: Permission denied; choose a folder "
                              "that you may write to",
                      "render", "no.json", "-o", "locked/" + name, **options)
    locked.chmod(0o755)


@fault
def output_file_read_only(place):
    """A file that is protected is not replaced, though its folder would allow it."""
    options = as_nobody(place)
    place.folder.chmod(0o777)
    (place.folder / "picture.png").write_bytes(OLD)
    (place.folder / "picture.png").chmod(0o444)
    place.refuses(OUTPUT, "cannot write picture.png: Permission denied",
                  "render", "no.json", "-o", "picture.png", **options)


@fault
def stats_folder_missing(place):
    """Known before the picture is drawn, so neither file appears."""
    place.refuses(OUTPUT, "cannot write no/stats.json: No such file or directory; create the "
                          "folder first",
                  *REFERENCE, "-o", "picture.png", "--stats", "no/stats.json")


# ---- while it is written ----

def in_small_disk(place, size, script):
    """Runs a shell script in a mount namespace where "disk" is a file system of `size`."""
    (place.folder / "disk").mkdir()
    unshare = shutil.which("unshare")
    if not unshare:
        raise Skip("no unshare to make a small disk with")
    line = [unshare, "-m"] if os.geteuid() == 0 else [unshare, "-rm"]
    mount = f"mount -t tmpfs -o size={size} tmpfs disk || exit 77\n"
    print(mount + script)
    done = subprocess.run([*line, "sh", "-c", mount + script], cwd=place.folder, text=True,
                          capture_output=True, env=dict(os.environ, TURNER=TURNER))
    print(f"{done.stdout}{done.stderr}=> {done.returncode}")
    if done.returncode == 77 or done.stderr.startswith("unshare:"):
        raise Skip("cannot mount a small disk here: " + done.stderr.strip())
    return done


@fault
def disk_full(place):
    """The picture takes 192 KiB, the disk has 64."""
    done = in_small_disk(place, "64k", """
printf 'an old picture' > disk/picture.exr
"$TURNER" render scene.json --device reference --size 128x128 -o disk/picture.tif
echo "status $?"
"$TURNER" render scene.json --device reference --size 128x128 -o disk/picture.exr -q
echo "status $?"
ls -A disk; cat disk/picture.exr
""")
    require(done.stdout == "status 5\nstatus 5\npicture.exr\nan old picture",
            "wrong status, or something on the disk has changed")
    for name in ("tif", "exr"):
        require(f"turner: error: cannot write disk/picture.{name}: No space left on device; free "
                "some space or write to another disk" in done.stderr, "wrong message")


@fault
def disk_full_before(place):
    """Not one file more fits: said before anything is drawn."""
    done = in_small_disk(place, "64k,nr_inodes=3", """
: > disk/a; : > disk/b
"$TURNER" render no.json -o disk/picture.png
echo "status $?"; ls -A disk
""")
    require(done.stdout == "status 5\na\nb\n", "wrong status, or files left behind")
    require("cannot write disk/picture.png: No space left on device; free some space" in
            done.stderr, "wrong message")


@fault
def file_size_limit(place):
    place.write("picture.exr", OLD)
    before = place.files()
    done = subprocess.run(
        [TURNER, *REFERENCE, "-o", "picture.exr", "--size", "128x128"], cwd=place.folder,
        capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
    print(done.stderr, "=>", done.returncode)
    require(done.returncode == OUTPUT, "wrong status")
    require("cannot write picture.exr: File too large; raise the limit on file sizes" in
            done.stderr, "wrong message")
    place.unchanged(before)


def broken(call, **what):
    """The environment that breaks a call (break_write.c)."""
    env = {"LD_PRELOAD": os.environ["TURNER_FAULT_LIBRARY"], "TURNER_BREAK": call}
    if SANITIZED:
        env["ASAN_OPTIONS"] = os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"
    return env | {"TURNER_BREAK_" + key.upper(): str(int(value)) for key, value in what.items()}


@fault
def disk_breaks(place):
    place.write("picture.png", OLD)
    for call in ("write", "rename"):
        place.refuses(OUTPUT, "cannot write picture.png: Input/output error; choose another "
                              "folder", *REFERENCE, "-o", "picture.png",
                      env=broken(call, errno=errno.EIO))


def stdout_fault(name, open_stdout):
    """The picture is there, its statistics are not: exit status and message say so."""
    def check(place):
        with open_stdout() as stdout:
            status, _, err = place.run(*REFERENCE, "-o", "picture.png", "--stats", "-",
                                       stdout=stdout)
        require(status == OUTPUT, f"exit status {status}")
        require(err == "turner: error: cannot write to standard output; is the disk full or the "
                       "pipe closed?\n", "wrong message")
        require(sorted(place.files()) == ["picture.png", "scene.json"], "files left behind")
    fault(check, name="stdout_" + name)


def broken_pipe():
    reader, writer = os.pipe()
    os.close(reader)
    return os.fdopen(writer, "wb")


stdout_fault("full", lambda: open("/dev/full", "wb"))
stdout_fault("pipe_closed", broken_pipe)


@fault
def stdout_closed(place):
    """No file of ours takes the number of the closed stream and gets its text."""
    for streams, statuses in ((">&-", {OUTPUT}), ("<&- >&- 2>&-", {OUTPUT}), ("<&- 2>&-", {OK})):
        done = subprocess.run(
            ["sh", "-c", f'"$0" "$@" {streams}', TURNER, *REFERENCE, "-o", "picture.ppm", "--stats",
             "-"], cwd=place.folder, capture_output=True, text=True)
        print(streams, "=>", done.returncode, done.stderr)
        require(done.returncode in statuses, "wrong status")
        picture = (place.folder / "picture.ppm").read_bytes()
        require(picture.startswith(b"P6") and len(picture) < 32 * 24 * 3 + 100 and
                b"settings" not in picture, "the picture is not whole or has text in it")
        (place.folder / "picture.ppm").unlink()
    require(sorted(place.files()) == ["scene.json"], "files left behind")


# ---- ended from outside ----

def draw_again(place):
    """After all that, the next picture comes out right."""
    place.succeeds(*REFERENCE, "-o", "picture.png")
    place.succeeds(*REFERENCE, "-o", "other.png")
    files = place.files()
    require(files["picture.png"] == files["other.png"], "the next picture is not right")


def end_fault(name, number, device):
    """Ended while it traces; three tries to be quick, for the machine may be busy."""
    def check(place):
        place.write("picture.png", OLD)
        before = place.files()
        choice = [] if device else ["--device", "reference"]
        expected = -number if number == signal.SIGKILL else 128 + number
        for _ in range(3):
            running = Running(place, "render", "scene.json", "-o", "picture.png", *LONG, *choice)
            try:
                running.wait_until_tracing()
                status, seconds = running.end(number)
            finally:
                running.close()
            require(status == expected, f"status {status} instead of {expected}")
            place.unchanged(before)
            if seconds < 1:
                break
        require(seconds < 1, "it took more than a second to end")
        draw_again(place)
    fault(check, name=name, device=device)


for is_device, suffix in ((False, ""), (True, "_device")):
    end_fault("kill_9" + suffix, signal.SIGKILL, is_device)
    end_fault("ctrl_c" + suffix, signal.SIGINT, is_device)
    end_fault("sigterm" + suffix, signal.SIGTERM, is_device)
end_fault("sighup", signal.SIGHUP, False)


@fault
def nohup(place):
    """A signal that is ignored from the start stays so."""
    running = Running(place, "render", "scene.json", "-o", "picture.png", *LONG, "--device",
                      "reference", ignore=[signal.SIGHUP])
    try:
        running.wait_until_tracing()
        running.process.send_signal(signal.SIGHUP)
        shown = len(running.shown)
        running.shown = b""
        running.wait_until_tracing()
        require(running.process.poll() is None and shown, "it ended")
        status, _ = running.end(signal.SIGTERM)
        require(status == 128 + signal.SIGTERM, f"status {status}")
    finally:
        running.close()


@fault
def kill_9_in_write(place):
    """Half of the new picture stands aside, the old one is as it was."""
    for call in ("write", "rename"):
        place.write("picture.png", OLD)
        status, _, _ = place.run(*REFERENCE, "-o", "picture.png",
                                 env=broken(call, signal=signal.SIGKILL))
        require(status == -signal.SIGKILL, f"status {status}")
        files = place.files()
        require(files["picture.png"] == OLD, "the old picture has changed")
        left = [name for name in files if name not in ("picture.png", "scene.json")]
        print("left behind:", left)
        require(len(left) == 1 and left[0].endswith(".part"), "more is left than the file aside")
        draw_again(place)
        (place.folder / left[0]).unlink()
        (place.folder / "other.png").unlink()


@fault
def ctrl_c_in_write(place):
    """The file aside goes."""
    place.write("picture.png", OLD)
    before = place.files()
    for call in ("write", "rename"):
        for number in (signal.SIGINT, signal.SIGTERM):
            status, _, _ = place.run(*REFERENCE, "-o", "picture.png",
                                     env=broken(call, signal=number))
            require(status == 128 + number, f"status {status}")
            place.unchanged(before)
    draw_again(place)
