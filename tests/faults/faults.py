"""faults.py list | NAME: runs one fault of the command, in a folder of its own.

Environment: TURNER, the command; TURNER_FAULT_LIBRARY, what breaks writes from inside (see
break_write.c). Exit status 77 means skipped, with the reason.
"""

import os
import sys

os.environ.setdefault("TURNER", "turner")

import harness  # noqa: E402
import command_faults  # noqa: E402,F401 registers its faults, as the next three do
import device_faults  # noqa: E402,F401
import input_faults  # noqa: E402,F401
import output_faults  # noqa: E402,F401


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if sys.argv[1] == "list":
        for name, (_, device) in harness.faults.items():
            print(name + (":device" if device else ""))
        return
    function, device = harness.faults[sys.argv[1]]
    place = harness.Place()
    try:
        if device:
            harness.needs_device()
        function(place)
    except harness.Skip as reason:
        print("skipped:", reason)
        sys.exit(77)
    except AssertionError as failure:
        print("FAILED:", failure)
        sys.exit(1)
    finally:
        place.close()


main()
