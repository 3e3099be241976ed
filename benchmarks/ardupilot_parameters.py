# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.ardupilot_parameters PROGRAM FILE``: the table of a real ArduPilot's parameters.

It starts the program (``arducopter``, ``ardurover``) with its own simulator and without files of parameters, and asks
for the list over MAVLink. Many groups are in the list only while one of their parameters is not 0 (BATT_MONITOR,
FENCE_ENABLE, ...): each that may be such a one is set, and what the list then has more is noted with its name.

The rows are what ``sitl.autopilot.params.names`` reads: name, type, default, and what must be set for it to be listed.
"""

from __future__ import annotations

import argparse
import csv
import re
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

from pymavlink import mavutil

from sitl.errors import SitlError
from sitl.foreign.process import HOST, AutopilotProcess, free_tcp_run

TYPES = {2: "int8", 4: "int16", 6: "int32", 9: "float"}
"""MAV_PARAM_TYPE"""
SWITCH = re.compile(r".*(ENABLED?|_EN|_TYPE|_MONITOR|_FUNCTION|_DRIVER)|SID_AXIS")
NO_SWITCH = re.compile(r"(FRAME|SERVO|BRD|FS|EK3|ARMING|RTL|GPS1_MB|BTN|SIM_(?!.*_ENABLE)).*")
AFTER_BOOT = (
    "FRAME_CLASS=7", "CC_TYPE=2", "GEN_TYPE=3", "CAN_P1_DRIVER=1", "CAN_P1_DRIVER=1,CAN_D1_UC_SER_EN=1",
    "BATT_MONITOR=4", "BATT2_MONITOR=4", "BATT3_MONITOR=4",
)  # fmt: skip
"""What has an effect on the list at the next boot only; the last of each shows what is new."""
QUIET_S = 1.0
COUNTED_S = 0.2
"""It counts anew some time after a parameter was set."""
PATIENCE_S = 30.0


class Value(NamedTuple):
    """What a PARAM_VALUE says."""

    kind: str
    value: float


class Program:
    """A running ArduPilot and its first link.

    Args:
        program: the executable.
        values: parameters that it boots with.
    """

    def __init__(self, program: Path, values: str = "") -> None:
        model = "rover" if "rover" in program.name else "quad"
        port = free_tcp_run(8)
        command = [
            str(program), "--model", model, "--speedup", "20", "--wipe", "--base-port", str(port),
            "--rc-in-port", str(port + 7), "--defaults", "{folder}/values.parm",
        ]  # fmt: skip
        self._process = AutopilotProcess(
            command, {"values.parm": values.replace("=", " ").replace(",", "\n") + "\n"}, {}
        )
        self._link: Any = None
        while self._link is None:
            self._process.check()
            try:
                self._link = mavutil.mavlink_connection(f"tcp:{HOST}:{port}", retries=1)
            except OSError:
                time.sleep(0.1)
        self._link.wait_heartbeat(timeout=PATIENCE_S)

    def _next(self, timeout: float = QUIET_S) -> Any:
        self._process.check()
        return self._link.recv_match(type="PARAM_VALUE", blocking=True, timeout=timeout)

    def settled(self) -> dict[str, Value]:
        """The list when it grows no more, some seconds after boot."""
        found, before = self.list(), -1
        while len(found) != before:
            time.sleep(QUIET_S)
            found, before = self.list(), len(found)
        return found

    def list(self) -> dict[str, Value]:
        """All parameters in the order of their index."""
        found: dict[int, tuple[str, Value]] = {}
        count, asks = -1, True
        while len(found) != count:
            if asks:
                self._link.mav.param_request_list_send(1, 1)
            m = self._next()
            asks = m is None  # what was lost comes with the next list
            if m is not None and m.param_index != 65535:
                if m.param_count != count:
                    found.clear()
                count = m.param_count
                found[m.param_index] = (m.param_id, Value(TYPES[m.param_type], m.param_value))
        return dict(found[k] for k in range(count))

    def set(self, name: str, value: float) -> int:
        """Set one; returns how many the list has then."""
        self._link.mav.param_set_send(1, 1, name.encode(), value, 9)
        time.sleep(COUNTED_S)
        while self._link.recv_match(type="PARAM_VALUE") is not None:
            pass
        for _ in range(round(PATIENCE_S / QUIET_S)):
            self._link.mav.param_request_read_send(1, 1, name.encode(), -1)
            if (m := self._next()) is not None and m.param_id == name:
                return int(m.param_count)
        raise SitlError(f"{name} = {value:g}: no answer")

    def stop(self) -> None:
        """End it."""
        self._link.close()
        self._process.stop()


def table(program: Path) -> dict[str, tuple[Value, str]]:
    """Name -> its default, and what shows it ("": always in the list)."""
    vehicle = Program(program)
    listed = vehicle.settled()
    found = {name: (value, "") for name, value in listed.items()}
    tried: set[str] = set()
    while todo := [n for n in listed if SWITCH.fullmatch(n) and not NO_SWITCH.fullmatch(n) and n not in tried]:
        for name in todo:
            tried.add(name)
            kind, value = found[name][0]
            if kind == "float":
                continue
            if vehicle.set(name, 0 if value else 4 if name.endswith("_MONITOR") else 1) == len(listed):
                continue
            now = vehicle.list()
            shown, hidden = {n: (v, name) for n, v in now.items() if n not in found}, listed.keys() - now.keys()
            found |= shown | {n: (found[n][0], name) for n in hidden}
            print(f"{name}: {len(shown) or len(hidden)}", file=sys.stderr)
            if hidden:
                vehicle.set(name, value)
                now = vehicle.list()
            listed = now
    vehicle.stop()
    order = list(listed)
    for setting in AFTER_BOOT:
        if setting.partition("=")[0] not in found:
            continue
        vehicle = Program(program, setting)
        listed = vehicle.settled()
        vehicle.stop()
        shown = {n: (v, setting.split(",")[-1]) for n, v in listed.items() if n not in found}
        found |= shown
        print(f"{setting}: {len(shown)}", file=sys.stderr)
        names = list(listed)
        for name in shown:
            before = names[names.index(name) - 1]
            order.insert(order.index(before) + 1 if before in order else len(order), name)
    found["SIM_SPEEDUP"] = (Value("float", 1.0), "")  # not what it was started with
    return {name: found[name] for name in order}


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ardupilot_parameters", description=__doc__)
    parser.add_argument("program", type=Path, help="arducopter or ardurover, built for SITL")
    parser.add_argument("file", type=Path, help="where the table goes")
    options = parser.parse_args()
    found = table(options.program.resolve())
    with options.file.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("name", "type", "default", "shown_by"))
        rows.writerows((name, value.kind, f"{value.value:.9g}", by) for name, (value, by) in found.items())


if __name__ == "__main__":
    main()
