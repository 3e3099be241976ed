# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks: what RUN_PREARM_CHECKS says of every parameter at 0, -1, its bounds and twice its bounds.

Rows have the parameter and its value as names, "ANGLE_MAX 500"; rows of several have them all, and rows "arm ..." are
what an attempt to arm says. Only what somebody objects to has a row. Of all parameters (some 1,300 a vehicle) those
are scanned, one by one, that ours or a real one has objected to before (``NAMES``); ``--rows PATTERN`` scans any, a
dozen at once, and one by one where the dozen is not taken.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from sitl.autopilot.params.parameter import INT8, INT16
from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.errors import SitlError
from sitl.vehicle.kinds import KINDS

from .kept import FOLDER
from .program import Program, Programs

SKIPPED = (
    "SIM_", "SERIAL", "MAV", "BRD_", "SCHED_", "LOG_", "NET_", "CAN_", "SCR_", "FORMAT_", "STAT_", "SYSID", "DDS_",
    "NMEA_", "FLTMODE", "MODE", "INITIAL_MODE", "ARMING_CHECK", "ARMING_SKIPCHK", "ARMING_REQUIRE", "AHRS_EKF_TYPE",
    "EK3_ENABLE", "TERRAIN_", "RCMAP_", "GPS_INJECT", "INS_TCAL", "EAHRS", "FFT_", "TEMP", "ESC_TLM", "OSD", "FRSKY_",
    "MSP_", "PSC_POS", "PSC_VEL", "PSC_ACC", "PSC_JERK",
)  # fmt: skip
"""Beginnings of names of links, storage, the simulation itself, and of what changes which checks are made."""
AT_ONCE = 12
"""Of parameters that nobody has objected to: others could hide one another (a RCn_MIN and its RCn_TRIM)."""
NAMES = FOLDER / "arming-names.json"
MOST = {INT8: 127.0, INT16: 32767.0}
OF_THE_FILTER = ("EKF ", "AHRS: EKF3 ", "GPS and AHRS differ")
NUMBER = re.compile(r" *\d+(\.\d+)?")
COMMANDS = {"RUN_PREARM_CHECKS": (401, 0.0), "COMPONENT_ARM_DISARM": (400, 1.0)}
CASES: tuple[Mapping[str, float], ...] = (
    {"FS_THR_VALUE": 900}, {"ANGLE_MAX": 500}, {"SERVO1_FUNCTION": 0}, {"SERVO3_FUNCTION": -1}, {"ATC_ANG_RLL_P": 0},
    {"MOT_SPIN_MIN": 0.05}, {"PSC_NE_POS_P": -1}, {"RC5_OPTION": 153}, {"RC5_OPTION": 32, "RC6_OPTION": 31},
    {"RC6_OPTION": 9, "RC7_OPTION": 9}, {"COMPASS_OFFS_MAX": 10}, {"SERVO1_FUNCTION": 73}, {"WP_SPEED": 0},
    {"COMPASS_OFS_X": 0, "COMPASS_OFS_Y": 0, "COMPASS_OFS_Z": 0}, {"BATT_LOW_VOLT": 13}, {"BATT_CRT_VOLT": 11},
    {"EK3_SRC2_YAW": 9}, {"RNGFND2_TYPE": 1}, {"BATT2_MONITOR": 4}, {"MNT1_TYPE": 1}, {"FRAME_CLASS": 0},
    {"FS_GCS_ENABLE": 2}, {"SERVO1_FUNCTION": 0, "SERVO3_FUNCTION": 0}, {"FS_THR_VALUE": 1600}, {"ARMING_NEED_LOC": 1},
)  # fmt: skip
"""Parameters together, or with values that are no bounds; tried by arming, too."""


def values_of(kind: str) -> dict[str, list[float]]:
    """What each parameter is set to."""
    found = {}
    for p in KINDS[kind].firmware.table:
        if p.read_only or p.name.startswith(SKIPPED):
            continue
        bounds = [b for b in (p.low, p.high) if p.has_effect and abs(b) < 1e6 and -p.low != p.high]
        values = (0.0, -1.0, *bounds, *(2.0 * b for b in bounds))
        most = MOST.get(p.kind, float("inf"))
        found[p.name] = [value for value in dict.fromkeys(values) if abs(value) <= most]
    return found


def agrees(ours: str | None, theirs: str | None) -> bool:
    """Whether two rows say the same; numbers in texts may differ, and what the filter says of a disturbance."""
    return _said(ours) == _said(theirs)


def _said(row: str | None) -> set[str]:
    texts = [text for text in (row or "").split("; ") if text and not text.startswith(OF_THE_FILTER)]
    return {NUMBER.sub("#", text) for text in texts}


class Asked:
    """A program that is asked again and again; a new one where the old one does not get well."""

    def __init__(self, programs: Programs) -> None:
        self.programs = programs
        self._begin()

    def _begin(self) -> None:
        self._context = self.programs.started()
        self.program: Program = self._context.__enter__()
        self.program.be_ready()
        self.program.set_mode("GUIDED")
        self.program.delay(25.0)
        self.usual = {name: self.program.params[name] for name in self.program.params}

    def close(self) -> None:
        """End the program."""
        self._context.__exit__(None, None, None)

    def texts(self, command: str = "RUN_PREARM_CHECKS", prefix: str = "PreArm: ") -> list[str]:
        """What is said of the parameters now."""
        program = self.program
        said = len(program.texts)
        number, first = COMMANDS[command]
        program.send("COMMAND_LONG", command=number, param1=first, target_system=1, target_component=1)
        program.delay(0.03 if program.is_ours else 0.5)
        new = {text.text for text in program.texts[said:] if text.text.startswith(prefix)}
        return sorted(text.removeprefix(prefix) for text in new)

    def of(self, params: Mapping[str, float], arming: bool = False) -> list[str]:
        """What is said of these parameters; they are set back."""
        params = {name: value for name, value in params.items() if name in self.usual}
        if not params:
            return []
        self._set(params)
        self.program.delay(0.2 if self.program.is_ours else 1.0)
        said = self.texts("COMPONENT_ARM_DISARM", "Arm: ") if arming else self.texts()
        if arming:
            self.program.delay(0.3)  # the HEARTBEAT that says so
            if self.program.armed:
                self.program.disarm()
        self._set({name: self.usual[name] for name in params})
        if said and not self._is_well():
            self.close()
            self._begin()
        return said

    def _set(self, params: Mapping[str, float]) -> None:
        simulation = self.program.connection.simulation
        for name, value in params.items():
            if simulation is None:
                self.program.params[name] = value
            else:  # without waiting for echoes
                simulation.bridge.get(ParameterService).set(name, value)

    def _is_well(self) -> bool:
        for _ in range(12):
            self.program.delay(0.2 if self.program.is_ours else 1.0)
            if not self.texts():
                return True
        return False


def batches(kind: str, pattern: str) -> Iterator[list[tuple[str, float]]]:
    """Parameters and values that are tried together: each parameter once."""
    at_once = 1 if pattern == "*" else AT_ONCE
    if pattern == "*":
        chosen = frozenset(json.loads(NAMES.read_text(encoding="utf-8"))[kind])
    else:
        chosen = frozenset(name for name in values_of(kind) if fnmatchcase(name, pattern.split(" ")[0]))
    wanted = {name: values for name, values in values_of(kind).items() if name in chosen}
    for k in range(max(map(len, wanted.values()), default=0)):
        row = [(name, values[k]) for name, values in wanted.items() if k < len(values)]
        for at in range(0, len(row), at_once):
            yield row[at : at + at_once]


def try_all(asked: Asked, items: Sequence[tuple[str, float]]) -> dict[str, str]:
    """Rows of the items that somebody objects to."""
    items = [item for item in items if item[0] in asked.usual and asked.usual[item[0]] != item[1]]
    if not items:
        return {}
    try:
        said = asked.of(dict(items))
    except SitlError:  # it is gone
        asked.close()
        asked._begin()
        said = ["-"]
        if len(items) == 1:
            return {}
    if not said:
        return {}
    if len(items) == 1:
        ((name, value),) = items
        return {f"{name} {value:g}": "; ".join(said)}
    half = len(items) // 2
    return {**try_all(asked, items[:half]), **try_all(asked, items[half:])}


def scan(programs: Programs) -> dict[str, str]:
    """Rows "NAME VALUE" and "arm NAME VALUE ..."."""
    asked = Asked(programs)
    rows: dict[str, str] = {}
    try:
        for batch in batches(programs.kind, programs.rows):
            rows.update(try_all(asked, batch))
        for case in CASES:
            name = "arm " + " ".join(f"{name} {value:g}" for name, value in case.items())
            if fnmatchcase(name, programs.rows) and (said := asked.of(case, arming=True)):
                rows[name] = "; ".join(said)
    finally:
        asked.close()
    return rows
