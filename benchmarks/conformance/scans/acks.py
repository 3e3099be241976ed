# SPDX-License-Identifier: BSD-3-Clause
"""Results of commands: every MAV_CMD by COMMAND_LONG and COMMAND_INT, in states and modes of the vehicle.

A row is a state and a command with its parameters, "flying: CONDITION_YAW 90 10 1 0". Its value is the result where it
is the same in all modes and by both messages; else the modes by result. "ACCEPTED, UNSUPPORTED" is what COMMAND_LONG
gets, and COMMAND_INT.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fnmatch import fnmatchcase

from sitl.autopilot.mission.mission import Mission
from sitl.core.mavlink import MavCmd

from .ack_cases import BY_MODE, CASES, EVERY, ON_THE_GROUND, Case
from .program import Program, Programs

RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED", "IN_PROGRESS")
Value = str | dict[str, str]
DISARMING = (MavCmd.DO_MOTOR_TEST, 400)
"""In failsafe nothing is armed again."""
HEIGHT_M = 50.0
"""High enough for LAND to last as long as the scan of it."""
MODES = {
    "copter": (
        "STABILIZE", "ACRO", "ALT_HOLD", "AUTO", "LOITER", "RTL", "CIRCLE", "LAND", "DRIFT", "POSHOLD", "BRAKE",
        "GUIDED_NOGPS", "SMART_RTL", "ZIGZAG",
    ),
    "rover": ("MANUAL", "ACRO", "STEERING", "HOLD", "LOITER", "SIMPLE", "CIRCLE", "AUTO", "RTL", "SMART_RTL"),
}  # fmt: skip
"""In which it flies besides GUIDED."""
PARAMETERS = {"copter": {"DISARM_DELAY": 0.0, "FS_OPTIONS": 0.0, "FS_GCS_ENABLE": 0.0}, "rover": {"FS_ACTION": 1.0}}


class Scanned:
    """A program in a state and a mode, and the rows that come of it."""

    def __init__(self, program: Program, rows: str) -> None:
        self.program, self.wanted = program, rows
        self.found: dict[str, dict[str, str]] = {}
        """Result by mode, by row."""

    def scan(self, state: str, mode: str, cases: Iterable[Case]) -> None:
        """Send commands in a mode that the vehicle is in."""
        for case in cases:
            name = f"{state}: {case.name}"
            if fnmatchcase(name, self.wanted):
                words = [self._result(mode, case, by_int) for by_int in (False, True)]
                self.found.setdefault(name, {})[mode] = words[0] if words[0] == words[1] else ", ".join(words)

    def _result(self, mode: str, case: Case, by_int: bool) -> str:
        with tried(self.program, mode):
            program = self.program
            result, now = ask(program, case, by_int), program.now
            if result == "ACCEPTED" and not program.is_ours:  # the next HEARTBEATs tell whether it is in another mode
                program.passes(lambda: program.telemetry.heartbeat_at > now + 0.15, 3.0)
            return result

    def rows(self) -> dict[str, Value]:
        """What was found."""
        return {name: together(by_mode) for name, by_mode in self.found.items()}

    def supported(self, state: str) -> list[Case]:
        """Commands that were not answered with UNSUPPORTED in a state."""
        return [case for case in EVERY if set(self.found.get(f"{state}: {case.name}", {}).values()) - {"UNSUPPORTED"}]


def together(by_mode: dict[str, str]) -> Value:
    """The result of all modes, or the modes of each result."""
    results = sorted(set(by_mode.values()))
    if len(results) == 1:
        return results[0]
    return {result: " ".join(mode for mode, got in by_mode.items() if got == result) for result in results}


@contextmanager
def tried(program: Program, mode: str) -> Iterator[None]:
    """What a command did is undone afterwards: the mode, and whether it is armed and flies."""
    if program.is_ours:
        with program.fork():
            yield
        return
    armed = program.armed
    yield
    program.passes(lambda: program.armed == armed, 3.0)  # a motor test ends
    if program.mode != mode or program.armed != armed:
        if armed and not program.armed and program.mode != "GUIDED":
            program.set_mode("GUIDED")
        if armed and not program.armed:
            program.arm()
        elif program.armed and not armed:
            program.disarm()
        program.set_mode(mode)


def ask(program: Program, case: Case, by_int: bool) -> str:
    """What a command is answered with; "nothing" without an answer."""
    p = [*case.params, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0][:7]
    fields = {f"param{k}": p[k - 1] for k in range(1, 5)}
    if by_int:
        scale = 1e7 if case.is_location else 1.0
        fields |= {"x": round(p[4] * scale), "y": round(p[5] * scale), "z": p[6], "frame": case.frame}
    else:
        fields |= {f"param{k}": p[k - 1] for k in range(5, 8)}
    with program.messages("COMMAND_ACK") as acks:
        for _ in range(1 if program.is_ours else 3):
            program.send("COMMAND_INT" if by_int else "COMMAND_LONG", command=case.number, **fields)
            if program.passes(lambda: any(ack.command == case.number for ack in acks), 2.0):
                break
        results = [RESULTS[ack.result] for ack in acks if ack.command == case.number]
        return results[0] if results else "nothing"


def scan(programs: Programs) -> dict[str, Value]:
    """Rows by state and command."""
    rows: dict[str, Value] = {}
    for flight in (disarmed, armed, in_flight, in_failsafe):
        with programs.started(PARAMETERS[programs.kind]) as program:
            scanned = Scanned(program, programs.rows)
            flight(scanned)
            rows |= scanned.rows()
    return rows


def disarmed(scanned: Scanned) -> None:
    """On the ground; calibrations come last, because they keep it from arming."""
    program = scanned.program
    program.be_ready()
    program.upload(mission(program))
    program.set_mode("GUIDED")
    scanned.scan("disarmed", "GUIDED", (*EVERY, *CASES))
    other = "LOITER" if program.of == "copter" else "MANUAL"
    program.set_mode(other)
    scanned.scan("disarmed", other, (*scanned.supported("disarmed"), *BY_MODE))
    program.set_mode("GUIDED")
    scanned.scan("disarmed", "GUIDED", ON_THE_GROUND)


def armed(scanned: Scanned) -> None:
    """On the ground, with the motors idling."""
    program = scanned.program
    program.be_armed()
    scanned.scan("armed", "GUIDED", [c for c in (*EVERY, *BY_MODE) if c.number != MavCmd.DO_MOTOR_TEST])


def in_flight(scanned: Scanned) -> None:
    """Flying, in every mode that it can be in for a while."""
    program = scanned.program
    be_high(program)
    program.set_mode(MODES[program.of][0])
    program.set_mode("GUIDED")  # it has no target
    tested = () if program.of == "copter" else (MavCmd.DO_MOTOR_TEST,)  # a rover is disarmed by a test
    scanned.scan("flying", "GUIDED", [case for case in (*EVERY, *CASES) if case.number not in tested])
    cases = (*scanned.supported("flying"), *BY_MODE)
    for mode in MODES[program.of]:
        go_back(program)
        program.set_mode(mode)
        program.delay(0.5)
        scanned.scan("flying", mode, cases)


def in_failsafe(scanned: Scanned) -> None:
    """Without radio, while it does what the failsafe does."""
    program = scanned.program
    be_high(program)
    program.release_rc()
    program.params["SIM_RC_FAIL"] = 1.0
    program.wait_mode("RTL")
    scanned.scan("failsafe", "RTL", [c for c in (*EVERY, *BY_MODE) if c.number not in DISARMING])


def be_high(program: Program) -> None:
    """In GUIDED at rest, with a mission, the throttle stick in the middle."""
    program.be_ready()
    program.upload(mission(program))
    program.rc({3: 1000 if program.of == "copter" else 1500})
    program.be_flying(HEIGHT_M)
    program.rc({3: 1500})
    go_back(program)


def go_back(program: Program) -> None:
    """In GUIDED a little off the start, at rest."""
    if program.mode != "GUIDED":
        program.set_mode("GUIDED")
    program.goto(5.0, 5.0, HEIGHT_M if program.of == "copter" else None, accuracy=3.0)
    program.delay(3.0)


def mission(program: Program) -> Mission:
    """One that goes on for longer than the scan."""
    item = program.item
    up = [item("NAV_TAKEOFF", altitude=HEIGHT_M)] if program.of == "copter" else []
    way = [item("DO_CHANGE_SPEED", param1=1, param2=0.5), item("NAV_WAYPOINT", 500.0, 0.0, HEIGHT_M)]
    return Mission((item("NAV_WAYPOINT"), *up, *way))
