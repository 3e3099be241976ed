# SPDX-License-Identifier: BSD-3-Clause
"""Mission items: what is answered to a mission with one item, and how that item is read back.

A row is a MAV_CMD with parameters of ``GIVEN``: the MAV_MISSION_RESULT, and of an accepted item what is read back by
MISSION_REQUEST_INT. Commands that are refused have one row.
"""

from __future__ import annotations

import math
from fnmatch import fnmatchcase
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega

from sitl.client.commands import command_name
from sitl.core.mavlink import MavCmd, MavMissionResult

from .program import Program, Programs

HEADINGS = "result, frame, parameters 1 to 4, x, y, z, current, autocontinue"
NAN, INF = math.nan, math.inf
HERE = (350_000_000, 1_490_000_000)
GIVEN: dict[str, tuple[float, ...]] = {
    "zeros": (0, 0, 0, 0, 0, 0, 0, 0),
    "plain": (1.75, 2.75, 3.75, 4.75, *HERE, 12.345, 3),
    "minus": (-1.75, -2.75, -3.75, -4.75, -HERE[0], -HERE[1], -12.345, 0),
    "small": (0.3, 0.3, 0.3, 0.3, 3, 5, 0.3, 0),
    "large": (300.5, 300.5, 300.5, 300.5, *HERE, 300.129, 10),
    "huge": (70000.5, 70000.5, 70000.5, 70000.5, *HERE, 80000.0, 6),
    "p1 NaN": (NAN, 0, 0, 0, 0, 0, 0, 0),
    "p2 NaN": (0, NAN, 0, 0, 0, 0, 0, 0),
    "p3 NaN": (0, 0, NAN, 0, 0, 0, 0, 0),
    "p4 NaN": (0, 0, 0, NAN, 0, 0, 0, 0),
    "z NaN": (0, 0, 0, 0, 0, 0, NAN, 0),
    "p4 infinite": (0, 0, 0, INF, 0, 0, 0, 0),
    "north": (0, 0, 0, 0, 910_000_000, 0, 0, 0),
    "east": (0, 0, 0, 0, 0, 1_810_000_000, 0, 0),
    "high": (0, 0, 0, 0, 0, 0, 83000.0, 0),
    **{f"frame {frame}": (0, 0, 0, 0, 0, 0, 5, frame) for frame in (1, 2, 5, 6, 11, 20)},
}
"""Parameters 1 to 4, x, y, z and the frame."""
LEFT_OUT = ((1000, "z NaN"),)
"""What is not sent."""
UPLOAD_S = 10.0
"""An upload is answered within [simulated s]."""


def upload(program: Program, items: list[tuple[int, tuple[float, ...]]]) -> int | None:
    """Send a mission, home first; the MAV_MISSION_RESULT, None without one."""
    with program.messages("MISSION_REQUEST") as asked, program.messages("MISSION_ACK") as acks:
        program.send("MISSION_COUNT", count=len(items), mission_type=0)
        for seq, (command, (p1, p2, p3, p4, x, y, z, frame)) in enumerate(items):
            if not program.passes(lambda: acks or _asks(asked, seq), UPLOAD_S) or acks:  # noqa: B023
                break
            program.send(
                "MISSION_ITEM_INT", seq=seq, command=command, frame=int(frame), autocontinue=1, mission_type=0,
                param1=p1, param2=p2, param3=p3, param4=p4, x=int(x), y=int(y), z=z,
            )  # fmt: skip
        program.passes(lambda: acks, UPLOAD_S)
        return acks[0].type if acks else None


def _asks(asked: list[Any], seq: int) -> bool:
    return any(m.seq == seq for m in asked)


def read_back(program: Program, seq: int) -> list[float | str] | None:
    """The item as the vehicle has it."""
    m = program.ask("MISSION_REQUEST_INT", "MISSION_ITEM_INT", UPLOAD_S, seq=seq, mission_type=0)
    if m is None:
        return None
    numbers = (m.param1, m.param2, m.param3, m.param4, m.x, m.y, m.z)
    return [m.frame, *(_number(value) for value in numbers), m.current, m.autocontinue]


def _number(value: float) -> float | str:
    """In single precision; JSON has no words for what is not finite."""
    return float(f"{value:.7g}") if math.isfinite(value) else str(value)


def scan(programs: Programs) -> dict[str, Any]:
    """Rows "NUMBER NAME PARAMETERS"."""
    rows: dict[str, Any] = {}
    with programs.started() as program:
        program.be_ready()
        for number in sorted(ardupilotmega.enums["MAV_CMD"]):
            for given, values in GIVEN.items():
                row = f"{number} {command_name(number)} {given}"
                if number >= 2**16 or (number, given) in LEFT_OUT or not fnmatchcase(row, programs.rows):
                    continue
                result = upload(program, [(MavCmd.NAV_WAYPOINT, GIVEN["zeros"]), (number, values)])
                rows[row] = [result, *(read_back(program, 1) or ())] if result == MavMissionResult.ACCEPTED else result
                if given == "zeros" and result == MavMissionResult.UNSUPPORTED:
                    break
    return rows
