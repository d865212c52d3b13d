"""Drivers of hardware are not opened where /dev/dri is missing, unless somebody wants them to be.

Environment: TURNER, the command. Exit status 77 where there is no such driver to open."""

import os
import pathlib
import re
import subprocess
import sys


def opened(**changes):
    """Mesa's drivers that `turner devices` opens."""
    env = {k: v for k, v in os.environ.items() if k != "VK_LOADER_DRIVERS_DISABLE"}
    env.update(changes, LD_DEBUG="files")
    done = subprocess.run([os.environ["TURNER"], "devices"], capture_output=True, text=True,
                          timeout=60, env=env)
    print("$ turner devices", changes, f"=> {done.returncode}", done.stdout)
    return set(re.findall(r"calling init: \S*/libvulkan_(\w+)\.so", done.stderr)), done.stdout


everything, listed = opened(VK_LOADER_DRIVERS_DISABLE="")
if not everything & {"radeon", "intel", "nouveau", "asahi"}:
    print("no driver of hardware is installed, or the loader looks elsewhere")
    sys.exit(77)
wanted, listed_by_default = opened()
assert listed == listed_by_default, "another list of devices"
if pathlib.Path("/dev/dri").exists():
    assert wanted == everything, wanted
else:
    assert not wanted & {"radeon", "intel", "intel_hasvk", "nouveau", "asahi"}, wanted
    assert "lvp" not in everything or "lvp" in wanted, wanted
