# SPDX-License-Identifier: BSD-3-Clause
"""Results of commands: every MAV_CMD by COMMAND_LONG and COMMAND_INT, in states and modes of the vehicle."""

from __future__ import annotations

from fnmatch import fnmatchcase

from .program import Program, Programs

RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED", "IN_PROGRESS")
COMMANDS = {115: "CONDITION_YAW", 178: "DO_CHANGE_SPEED"}


def result(program: Program, message: str, command: int, **fields: float) -> str:
    """What a command is answered with; "" without an answer."""
    ack = program.ask(message, "COMMAND_ACK", command=command, **fields)
    return RESULTS[ack.result] if ack else ""


def scan(programs: Programs) -> dict[str, str]:
    """Rows "STATE COMMAND"."""
    rows = {}
    with programs.started() as program:
        program.be_ready()
        for number, name in COMMANDS.items():
            if fnmatchcase(name, programs.rows):
                rows[f"landed {name}"] = result(program, "COMMAND_LONG", number)
    return rows
