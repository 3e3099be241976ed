# SPDX-License-Identifier: BSD-3-Clause
"""Runs one test of the suite; a program of its own, for the Python that has what the suite needs.

``driver.py VEHICLE TEST SPEEDUP BINARY CHECKOUT REPORT``: the report is a JSON file with "passed", "cause", "where".
"""

from __future__ import annotations

import fcntl
import json
import os
import socket
import struct
import sys
import traceback
from importlib import import_module
from pathlib import Path

CLASSES = {"copter": ("arducopter", "AutoTestCopter"), "rover": ("rover", "AutoTestRover")}
_SET_FLAGS, _UP_AND_RUNNING = 0x8914, 0x1 | 0x40  # SIOCSIFFLAGS, IFF_UP | IFF_RUNNING (netdevice(7))


def loopback_up() -> None:
    """A new network namespace has a loopback device that is down; elsewhere it is up, and nothing is changed."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            fcntl.ioctl(s, _SET_FLAGS, struct.pack("16sH14x", b"lo", _UP_AND_RUNNING))
        except PermissionError:
            return


def describe(error: BaseException | None, test: str) -> tuple[str, str]:
    """(what, where): the error's text on one line, and the line of the test itself that it came from."""
    if error is None:
        return "", ""
    lines = [f for f in traceback.extract_tb(error.__traceback__) if f.name == test]
    where = f"{Path(lines[0].filename).name}:{lines[0].lineno} {lines[0].line}" if lines else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())}", where


def run(vehicle: str, test: str, speedup: int, binary: str, checkout: str) -> dict[str, object]:
    """Run it; returns what the report says."""
    autotest = f"{checkout}/Tools/autotest"
    sys.path[:0] = [autotest, f"{autotest}/pysim"]
    module, name = CLASSES[vehicle]
    try:
        suite = getattr(import_module(module), name)(binary, speedup=speedup, _show_test_timings=True)
        passed = bool(suite.autotest(tests=[getattr(suite, test)], allow_skips=False))
    except Exception as error:
        traceback.print_exc()
        what, where = describe(error, test)
        return {"passed": False, "cause": what, "where": where}
    failed = suite.fail_list
    what, where = describe(failed[0].exception, test) if failed else ("", "")
    return {"passed": passed, "cause": what, "where": where}


if __name__ == "__main__":
    vehicle, test, speedup, binary, checkout, report = sys.argv[1:]
    loopback_up()
    result = run(vehicle, test, int(speedup), binary, checkout)
    Path(report).write_text(json.dumps(result), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0 if result["passed"] else 1)  # threads that a failed test leaves would wait for ever
