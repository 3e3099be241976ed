# SPDX-License-Identifier: BSD-3-Clause
"""Commands in a mission: what is told when each is run behind a waypoint, before the vehicle stays.

A row is a MAV_CMD that ArduPilot's missions take: texts, and numbers of MISSION_ITEM_REACHED, in their order, until
item 3 is current.
"""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import Any

from benchmarks.manoeuvres.__main__ import HOME
from sitl.client.commands import command_name

from .items import GIVEN, upload
from .program import HEIGHT_M, Program, Programs

HEADINGS = "texts; numbers of items that were reached"
HERE = (round(HOME[0] * 1e7), round(HOME[1] * 1e7), HEIGHT_M, 3)
WAYPOINT, STAY = (16, (0, 0, 0, 0, *HERE)), (17, (0, 0, 0, 0, *HERE))
PLACED = (31, 36, 82)
"""Need a place of their own: those of ``HERE``."""
WITH: dict[int, tuple[float, ...]] = {
    **dict.fromkeys(PLACED, (0, 0, 0, 0, *HERE)),
    218: (9, 0, 0, 0, 0, 0, 0, 0),
    42702: (1, 1, 0, 0, 0, 0, 0, 0),
    42703: (1, 0, 0, 0, 0, 0, 0, 0),
}
"""Parameters of commands that cannot do with zeros."""
COMMANDS = {
    "copter": (30, 31, 36, 82, 83, 112, 114, 115, 178, 179, 181, 182, 183, 184, 188, 189, 191, 193, 194, 195, 197,
               201, 202, 203, 205, 206, 207, 208, 210, 212, 215, 216, 217, 218, 222, 223, 531, 532, 534, 600, 1000,
               2000, 2001, 2500, 2501, 3000, 42600, 42702, 42703),
    "rover": (21, 22, 30, 31, 36, 82, 83, 84, 85, 94, 112, 114, 115, 179, 181, 183, 188, 189, 191, 193, 194, 195,
              197, 201, 202, 203, 205, 206, 207, 208, 210, 212, 215, 216, 217, 218, 222, 223, 531, 532, 534, 600,
              1000, 2000, 2001, 2500, 2501, 3000, 42600, 42703),
}  # fmt: skip
RUN_S, SETTLE_S = 12.0, 0.5
LAST = 3


def run(program: Program, command: int) -> list[str | int]:
    """What is told when the mission is flown from its beginning."""
    program.set_mode("GUIDED")
    if upload(program, [WAYPOINT, WAYPOINT, (command, WITH.get(command, GIVEN["zeros"])), STAY]) != 0:
        return []
    program.send("MISSION_SET_CURRENT", seq=0)
    program.delay(SETTLE_S)
    texts: list[str] = []
    with program.messages("MISSION_ITEM_REACHED") as reached:
        program.new_texts()
        program.set_mode("AUTO")
        program.passes(lambda: _adds(texts, program) and any(f": {LAST} " in text for text in texts), RUN_S)
        program.delay(SETTLE_S)
        _adds(texts, program)
        return [*texts, *(m.seq for m in reached)]


def _adds(texts: list[str], program: Program) -> bool:
    texts += program.new_texts()
    return True


def scan(programs: Programs) -> dict[str, Any]:
    """Rows "NUMBER NAME"."""
    rows: dict[str, Any] = {}
    with programs.started() as program:
        program.be_flying()
        for number in COMMANDS[programs.kind]:
            row = f"{number} {command_name(number)}"
            if fnmatchcase(row, programs.rows):
                rows[row] = run(program, number)
    return rows
