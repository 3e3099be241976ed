# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks of parameters, as they were set: a table of what each looks at, and the texts of those that fail.

They are made in Python, whenever a parameter is set and before clients arm: the core knows only whether one failed
(``Calibrated.state``: PARAMETERS_BAD). Texts and their order are those that ArduPilot's users know.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ..core.algebra import by_component, norm, rotate
from ..core.border import RC_INPUTS
from ..core.vectors import Vec3
from .arming_checks import (
    CHECK_BATTERY,
    CHECK_CAMERA,
    CHECK_COMPASS,
    CHECK_INS,
    CHECK_MISSION,
    CHECK_PARAMETERS,
    CHECK_RANGEFINDER,
    CHECK_RC,
    GYRO_DIFFERENCE,
    battery_checks,
    compass_checks,
    wants,
)
from .params.table import Values
from .radio_checks import WORD
from .sensor_calibration import field_of

ALWAYS, ANY = -1, 0
"""In place of a bit of ARMING_CHECK: the check counts even when that is 0, or unless it is 0."""


class Subject(NamedTuple):
    """What is checked."""

    values: Values
    """As they were set, in range or not."""
    boot: Mapping[str, float]
    """Values at power-on of what counts from there on."""
    v: Any
    """The vehicle's record."""
    commands: frozenset[int]
    """Numbers of the commands in the mission."""


class Check(NamedTuple):
    """A check."""

    bit: int
    """Of ARMING_CHECK, or ALWAYS, ANY."""
    find: Callable[[Subject], Iterable[str]]
    """Texts of what is wrong."""
    when_arming: bool = False
    """It counts at the moment of arming only, while there is a receiver."""
    forbids: bool = True
    """Else it is only reported."""


class Found(NamedTuple):
    """What is wrong."""

    text: str
    when_arming: bool
    forbids: bool


def look(subject: Subject, checks: Sequence[Check]) -> list[Found]:
    """All that is wrong with the parameters."""
    arming = subject.v.autopilot.params.ARMING
    found = []
    for check in checks:
        if check.bit == ALWAYS or (arming.CHECK != 0.0 if check.bit == ANY else wants(arming, check.bit)):
            found += [Found(text, check.when_arming, check.forbids) for text in check.find(subject)]
    return found


# ---------------------------------------------------------------------- what vehicles share

OUTPUTS = 16
WITH_CURRENT = 4
"""BATT_MONITOR of a monitor that measures the current, too."""
COMPASS_LEAST, COMPASS_MOST = 185.0, 875.0
"""Field that a compass can show on the earth [mGauss]."""
_COMPASSES = ("", "2", "3")
_BATTERIES, _RANGEFINDERS = "23456789", "123456789A"
_SOURCES_OF_YAW = (0, 1, 2, 3, 6, 8)
_SENSORS_OF_YAW = {3: "Compass", 8: "GPS", 6: "VisualOdom"}
"""What each of them needs, in the order in which a missing one is reported; the first compass may be missing (1)."""
_ITEMS = {
    1: (21, "land"), 2: (85, "vtol land"), 4: (189, "do land start"), 8: (22, "takeoff"), 16: (84, "vtol takeoff"),
    64: (20, "RTL"),
}  # fmt: skip
"""Bit of ARMING_MIS_ITEMS -> command, and what it is called."""
BOOT_NAMES = tuple(f"COMPASS_PRIO{k}_ID" for k in (1, 2, 3))
"""What counts from power-on."""


def outputs(s: Subject) -> Iterable[str]:
    """Rests of outputs outside of their ends."""
    values = s.values
    for k in range(1, OUTPUTS + 1):
        if values[f"SERVO{k}_FUNCTION"] <= 0.0:
            continue
        low, high, rest = (values[f"SERVO{k}_{of}"] % WORD for of in ("MIN", "MAX", "TRIM"))  # read without their signs
        if low > rest:
            yield f"SERVO{k}_MIN is greater than SERVO{k}_TRIM"
        if high < rest:
            yield f"SERVO{k}_MAX is less than SERVO{k}_TRIM"


def switches(s: Subject, mode_channel: str) -> Iterable[str]:
    """Channels that would do two things; ``mode_channel``: the parameter that names the one of the mode switch."""
    options = [int(s.values[f"RC{k}_OPTION"]) for k in range(1, RC_INPUTS + 1)]
    used = [option for option in options if option > 0]
    if len(set(used)) < len(used):
        yield "Duplicate Aux Switch Options"
    number = int(s.values[mode_channel])
    if 1 <= number <= RC_INPUTS and options[number - 1] > 0:
        yield f"Mode channel and RC{number}_OPTION conflict"


def _is_uncalibrated(values: Values, k: str) -> bool:
    offsets = (values[f"COMPASS_OFS{k}_{axis}"] for axis in "XYZ")
    device = f"COMPASS_DEV_ID{k}"
    return not any(offsets) or values[device] != values.table[device].default


def compasses(s: Subject) -> Iterable[str]:
    """The first thing that is wrong with the compasses."""
    values, v = s.values, s.v
    if values["COMPASS_USE"] == 0.0:
        return
    used = [k for k in _COMPASSES if values[f"COMPASS_USE{k}"] > 0.0]
    if any(values[name] != s.boot[name] for name in BOOT_NAMES):
        yield "Compass order change requires reboot"
        return
    if any(_is_uncalibrated(values, k) for k in used):
        yield "Compass not calibrated"
        return
    if norm(Vec3(*(values[f"COMPASS_OFS_{axis}"] for axis in "XYZ"))) > values["COMPASS_OFFS_MAX"] % WORD:
        yield "Compass offsets too high"
        return
    if norm(v.sensors.mag) > 0.0:  # there is one
        yield from _field(s)


def _field(s: Subject) -> Iterable[str]:
    """The first compass shows a field that cannot be here."""
    ap, limit = s.v.autopilot, s.values["ARMING_MAGTHRESH"]
    shown = 1e3 * field_of(0, s.v.sensors, ap.params)
    size = norm(shown)
    if not COMPASS_LEAST <= size <= COMPASS_MOST:
        yield f"Check mag field: {size:4.0f}, max {COMPASS_MOST:.0f}, min {COMPASS_LEAST:.0f}"
    elif (
        limit > 0.0
        and ap.estimate.position_ok
        and ap.ekf.declination != 0.0
        and not compass_checks(s.v.sensors, ap.params.COMPASS)
    ):
        apart = rotate(ap.estimate.q, shown) - 1e3 * ap.ekf.earth_field
        across, down = max(abs(apart.x), abs(apart.y)), abs(apart.z)
        if across > limit:
            yield f"Check mag field (xy diff:{across:.0f}>{limit:.0f})"
        elif down > 2.0 * limit:
            yield f"Check mag field (z diff:{down:.0f}>{2.0 * limit:.0f})"


def _axes(values: Values, name: str) -> Vec3:
    return Vec3(*(values[f"{name}_{axis}"] for axis in "XYZ"))


def _difference(s: Subject) -> str:
    """Two IMUs that show the same, corrected by parameters of their own: where these make them differ."""
    values, shown = s.values, s.v.sensors.acc
    first, second = (
        by_component(shown - _axes(values, f"INS_ACC{k}OFFS"), _axes(values, f"INS_ACC{k}SCAL")) for k in ("", "2")
    )
    apart, limit = first - second, values["ARMING_ACCTHRESH"]
    if limit <= 0.0 or norm(Vec3(apart.x, apart.y, 0.5 * apart.z)) > limit:  # downwards it matters less
        return "Accels inconsistent"
    drift = norm(_axes(values, "INS_GYROFFS") - _axes(values, "INS_GYR2OFFS"))
    return "Gyros inconsistent" if drift > GYRO_DIFFERENCE else ""


def inertial(s: Subject) -> Iterable[str]:
    """The first thing that is wrong with the calibration of IMUs, one of which is not there."""
    values = s.values
    third = [f"INS_ACC3{of}_{axis}" for of in ("OFFS", "SCAL") for axis in "XYZ"]
    if values["INS_GYR3_ID"] != 0.0:
        yield "Gyros not calibrated"
    elif values["INS_ACC3_ID"] != 0.0 or any(values[name] not in (0.0, values.table[name].default) for name in third):
        yield "3D Accel calibration needed"
    elif s.v.sensors.imu_state == 0 and (wrong := _difference(s)):
        yield wrong


def batteries(s: Subject) -> Iterable[str]:
    """The limits of the first battery in the wrong order; others that are not there."""
    ap, limits = s.v.autopilot, s.v.autopilot.params.BATT
    if ap.battery.driver != 0 and battery_checks(ap.battery, ap.modes.failsafe.battery, ap.params) == 0:
        if limits.LOW_MAH > 0.0 and limits.CRT_MAH >= limits.LOW_MAH:
            yield "Battery 1 capacity failsafe critical >= low"
        elif limits.LOW_VOLT > 0.0 and limits.CRT_VOLT >= limits.LOW_VOLT:
            yield "Battery 1 voltage failsafe critical >= low"
        elif ap.battery.driver == WITH_CURRENT and s.values["BATT_CURR_PIN"] == -1.0:
            yield "Battery 1 unhealthy"
    for k, name in enumerate(_BATTERIES, 2):
        if s.values[f"BATT{name}_MONITOR"] != 0.0:
            yield f"Battery {k} unhealthy"
            return


def rangefinders(s: Subject) -> Iterable[str]:
    """The first one that is asked for and not there."""
    for name in _RANGEFINDERS:
        kind = s.values[f"RNGFND{name}_TYPE"]
        if kind < 0.0 or (kind > 0.0 and name != "1"):
            yield f"Rangefinder {name}: Not Detected"
            return


def mounts(s: Subject) -> Iterable[str]:
    """A mount of a kind that there is not."""
    if s.values["MNT1_TYPE"] < 0.0 or s.values["MNT2_TYPE"] != 0.0:
        yield "Mount: check TYPE"


def sources(s: Subject) -> Iterable[str]:
    """Where the filter gets its heading from."""
    for k in (1, 2, 3):
        if int(s.values[f"EK3_SRC{k}_YAW"]) not in _SOURCES_OF_YAW:
            yield f"AHRS: Check EK3_SRC{k}_YAW"
            return
    yaws = {int(s.values[f"EK3_SRC{k}_YAW"]) for k in (1, 2, 3)}
    missing = [sensor for yaw, sensor in _SENSORS_OF_YAW.items() if yaw in yaws and not _is_there(s.values, sensor)]
    if missing:
        yield f"AHRS: EK3 sources require {missing[0]}"


def _is_there(values: Values, sensor: str) -> bool:
    """Whether parameters speak of a ``sensor`` that is there and in use."""
    if sensor == "Compass":
        return values["COMPASS_ENABLE"] != 0.0 and any(values[f"COMPASS_USE{k}"] != 0.0 for k in _COMPASSES)
    names = ("GPS1_TYPE", "GPS2_TYPE") if sensor == "GPS" else ("VISO_TYPE",)
    return any(values[name] != 0.0 for name in names)


def mission_items(s: Subject) -> Iterable[str]:
    """The first item that the mission must have and has not."""
    wanted = int(s.values["ARMING_MIS_ITEMS"])
    for bit, (command, name) in _ITEMS.items():
        if wanted & bit and command not in s.commands:
            yield f"Missing mission item: {name}"
            return


SHARED = (
    Check(CHECK_INS, inertial),
    Check(CHECK_COMPASS, compasses),
    Check(ANY, sources),
    Check(CHECK_BATTERY, batteries),
    Check(CHECK_MISSION, mission_items),
    Check(CHECK_RANGEFINDER, rangefinders),
    Check(ANY, outputs),
    Check(CHECK_CAMERA, mounts),
)
"""Those of every firmware."""
__all__ = [
    "ALWAYS",
    "ANY",
    "BOOT_NAMES",
    "CHECK_PARAMETERS",
    "CHECK_RC",
    "SHARED",
    "Check",
    "Found",
    "Subject",
    "look",
    "switches",
]
