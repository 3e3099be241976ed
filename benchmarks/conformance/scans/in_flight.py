# SPDX-License-Identifier: BSD-3-Clause
"""When a parameter acts that is set while a vehicle moves: at once, on the next leg, when the mode is entered again.

A row is a parameter and a manoeuvre. Its metric (a speed, a rate, a lean) is read with the old value, some seconds
after the new one is set, after another order in the same mode, and after the mode was entered anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatchcase

from .program import Program, Programs

AT_ONCE, NEXT_ORDER, MODE_ANEW, NEVER = "at once", "next order", "mode entered again", "never"
SEEN = 0.5
"""Share of the whole change that counts."""
LEAST = 0.08
"""A metric that changes by less, as a share of it, has not changed."""
FAR = 2000.0
LEG_S = 14.0
"""A leg has its speed by then: ArduCopter forgets a WPNAV_SPEED that is set while it still speeds up [s]."""
Order = Callable[[Program, int], None]
Metric = Callable[[Program], float]


@dataclass(frozen=True)
class Manoeuvre:
    """What a vehicle does, and what of it is read."""

    mode: str
    order: Order
    """Begins it; its number, from 0, tells one from the next."""
    metric: Metric
    height_m: float = 30.0
    settle_s: float = 7.0
    between: str = "LOITER"
    """Mode in which it waits for the next entry."""


def speed(program: Program) -> float:
    """[m/s]."""
    return program.groundspeed


def climb(program: Program) -> float:
    """[m/s]."""
    return program.climb_rate


def lean(program: Program) -> float:
    """[deg]."""
    return max(abs(program.attitude.roll), abs(program.attitude.pitch))


def height(program: Program) -> float:
    """Above home [m]."""
    return program.altitude


def turn_rate(program: Program) -> float:
    """[deg/s], over a second."""
    before = program.heading
    program.delay(1.0)
    return abs((program.heading - before + 180.0) % 360.0 - 180.0)


def goes(north: float, east: float, up: float = 0.0) -> Order:
    """GUIDED set-points: each order the other way."""

    def order(program: Program, k: int) -> None:
        way = -1.0 if k % 2 else 1.0
        altitude = program.altitude + up if program.of == "copter" else None
        program.set_position(way * north, way * east, altitude)

    return order


def item(k: int) -> Order:
    """The mission from an item on; the next order is the item after it."""

    def order(program: Program, number: int) -> None:
        if k + number > LEG:  # AUTO itself begins at the first item
            program.command("DO_SET_MISSION_CURRENT", k + number)

    return order


def holds(**sticks: int) -> Order:
    """Sticks away from rest, after three seconds at rest."""

    def order(program: Program, number: int) -> None:
        names = ("roll", "pitch", "throttle", "yaw") if program.of == "copter" else ("steering", "throttle")
        rest = dict.fromkeys(names, 1500)
        if number:
            program.rc(None, **rest)
            program.delay(3.0)
        program.rc(None, **{**rest, **sticks})

    return order


def homeward(program: Program, number: int) -> None:
    """A way home: home is moved far away, and the mode is entered once more."""
    if number == 0:
        mode = program.mode
        lat, lon = program.location_of(FAR, 0.0)
        program.send(
            "COMMAND_INT", command=179, frame=0, x=lat, y=lon, z=program.home()[2], target_system=1, target_component=1
        )
        program.delay(1.0)
        program.set_mode("LOITER")
        program.set_mode(mode)


def turns(program: Program, number: int) -> None:
    """CONDITION_YAW: nearly a full turn."""
    program.command("CONDITION_YAW", 358.0, 0.0, 1.0, 1.0)


def nothing(program: Program, number: int) -> None:
    """The mode itself is the order."""


LEG, CLIMB, DESCENT = 1, 5, 9
"""Items of the mission at which its legs begin, each with three more of the same kind."""
COPTER = {
    "GUIDED": Manoeuvre("GUIDED", goes(FAR, 0.0), speed, settle_s=LEG_S),
    "GUIDED climb": Manoeuvre("GUIDED", goes(0.0, 0.0, 150.0), climb),
    "GUIDED descent": Manoeuvre("GUIDED", goes(0.0, 0.0, -70.0), climb, height_m=80.0),
    "AUTO": Manoeuvre("AUTO", item(LEG), speed, settle_s=LEG_S),
    "AUTO climb": Manoeuvre("AUTO", item(CLIMB), climb),
    "AUTO descent": Manoeuvre("AUTO", item(DESCENT), climb, height_m=80.0),
    "LOITER pitch": Manoeuvre("LOITER", holds(pitch=1000), speed, between="ALT_HOLD", settle_s=9.0),
    "LOITER throttle": Manoeuvre("LOITER", holds(throttle=2000), climb, between="ALT_HOLD", settle_s=5.0),
    "ALT_HOLD throttle": Manoeuvre("ALT_HOLD", holds(throttle=2000), climb, settle_s=5.0),
    "ALT_HOLD throttle down": Manoeuvre("ALT_HOLD", holds(throttle=1000), climb, height_m=80.0, settle_s=5.0),
    "ALT_HOLD yaw": Manoeuvre("ALT_HOLD", holds(yaw=2000), turn_rate, settle_s=3.0),
    "ALT_HOLD roll": Manoeuvre("ALT_HOLD", holds(roll=2000), lean, settle_s=2.0),
    "CIRCLE": Manoeuvre("CIRCLE", nothing, turn_rate, settle_s=10.0),
    "LAND": Manoeuvre("LAND", nothing, climb, height_m=9.0, settle_s=3.0),
    "LAND from above": Manoeuvre("LAND", nothing, climb, height_m=80.0, settle_s=5.0),
    "RTL": Manoeuvre("RTL", homeward, speed, settle_s=LEG_S),
    "RTL height": Manoeuvre("RTL", homeward, height, settle_s=LEG_S),
    "CIRCLE speed": Manoeuvre("CIRCLE", nothing, speed, settle_s=12.0),
    "GUIDED yaw": Manoeuvre("GUIDED", turns, turn_rate, settle_s=1.5),
    "ACRO yaw": Manoeuvre("ACRO", holds(yaw=2000), turn_rate, height_m=80.0, settle_s=2.0),
}
ROVER = {
    "GUIDED": Manoeuvre("GUIDED", goes(FAR, 0.0), speed, settle_s=LEG_S, between="HOLD"),
    "AUTO": Manoeuvre("AUTO", item(LEG), speed, settle_s=LEG_S, between="HOLD"),
    "MANUAL throttle": Manoeuvre("MANUAL", holds(throttle=2000), speed, between="HOLD"),
    "ACRO throttle": Manoeuvre("ACRO", holds(throttle=1700), speed, between="HOLD"),
    "ACRO roll": Manoeuvre("ACRO", holds(throttle=1600, steering=2000), turn_rate, between="HOLD"),
    "STEERING throttle": Manoeuvre("STEERING", holds(throttle=1700), speed, between="HOLD"),
    "STEERING roll": Manoeuvre("STEERING", holds(throttle=1700, steering=2000), turn_rate, between="HOLD"),
    "CIRCLE": Manoeuvre("CIRCLE", nothing, speed, between="HOLD", settle_s=12.0),
    "CIRCLE turn": Manoeuvre("CIRCLE", nothing, turn_rate, between="HOLD", settle_s=12.0),
    "RTL": Manoeuvre("RTL", homeward, speed, settle_s=LEG_S, between="HOLD"),
}
CASES: dict[str, tuple[tuple[str, str, float, float], ...]] = {
    "copter": (
        ("WPNAV_SPEED", "GUIDED", 1000, 400), ("WPNAV_SPEED", "AUTO", 1000, 400),
        ("WPNAV_SPEED_UP", "GUIDED climb", 250, 100), ("WPNAV_SPEED_UP", "AUTO climb", 250, 100),
        ("WPNAV_SPEED_DN", "GUIDED descent", 150, 60), ("WPNAV_SPEED_DN", "AUTO descent", 150, 60),
        ("LOIT_SPEED", "LOITER pitch", 1250, 400), ("LOIT_ANG_MAX", "LOITER pitch", 0, 5),
        ("PILOT_SPEED_UP", "LOITER throttle", 250, 100), ("PILOT_SPEED_UP", "ALT_HOLD throttle", 250, 100),
        ("PILOT_SPEED_DN", "ALT_HOLD throttle down", 150, 60), ("PILOT_Y_RATE", "ALT_HOLD yaw", 60, 20),
        ("ANGLE_MAX", "ALT_HOLD roll", 3000, 1000), ("CIRCLE_RATE", "CIRCLE", 20, 8), ("LAND_SPEED", "LAND", 50, 100),
        ("LAND_SPEED_HIGH", "LAND from above", 100, 50), ("WPNAV_SPEED_DN", "LAND from above", 150, 60),
        ("LAND_ALT_LOW", "LAND from above", 1000, 9000),
        ("RTL_SPEED", "RTL", 1000, 400), ("WPNAV_SPEED", "RTL", 1000, 400), ("RTL_ALT", "RTL height", 4000, 6000),
        ("CIRCLE_RADIUS", "CIRCLE speed", 1000, 500), ("ATC_SLEW_YAW", "GUIDED yaw", 6000, 2000),
        ("ANGLE_MAX", "LOITER pitch", 3000, 1000), ("ACRO_Y_RATE", "ACRO yaw", 80, 30),
    ),
    "rover": (
        ("WP_SPEED", "GUIDED", 5, 2), ("WP_SPEED", "AUTO", 5, 2), ("WP_SPEED", "CIRCLE", 2, 1),
        ("CIRC_SPEED", "CIRCLE", 2, 1), ("CRUISE_SPEED", "ACRO throttle", 5, 2),
        ("CRUISE_SPEED", "STEERING throttle", 5, 2), ("CRUISE_THROTTLE", "ACRO throttle", 30, 60),
        ("MOT_THR_MAX", "MANUAL throttle", 100, 30), ("ACRO_TURN_RATE", "ACRO roll", 60, 20),
        ("ATC_STR_RAT_MAX", "ACRO roll", 60, 20), ("SPEED_MAX", "ACRO throttle", 0, 2),
        ("RTL_SPEED", "RTL", 5, 2), ("WP_SPEED", "RTL", 5, 2), ("TURN_RADIUS", "STEERING roll", 1, 10),
        ("ATC_TURN_MAX_G", "STEERING roll", 0.6, 0.1), ("CIRC_RADIUS", "CIRCLE turn", 20, 10),
    ),
}  # fmt: skip
"""Parameter, manoeuvre, old and new value."""


def upload(program: Program) -> None:
    """The mission of the AUTO manoeuvres: legs, climbs, descents."""
    items = []
    for k in range(4):
        items.append(program.item("NAV_WAYPOINT", north=FAR * (-1) ** k, east=10.0 * k, altitude=30.0))
    for k in range(4):
        items.append(program.item("NAV_WAYPOINT", north=0.0, east=0.1 * k, altitude=300.0 + k))
    for k in range(4):
        items.append(program.item("NAV_WAYPOINT", north=0.0, east=0.1 * k, altitude=5.0 + 0.1 * k))
    program.upload(items)


def when(program: Program, name: str, m: Manoeuvre, old: float, new: float) -> str:
    """When the parameter acts."""
    program.params[name] = old
    program.set_mode(m.mode)
    m.order(program, 0)
    program.delay(m.settle_s)
    metrics = [m.metric(program)]
    program.params[name] = new
    program.delay(m.settle_s)
    metrics.append(m.metric(program))
    if m.order is not nothing:
        m.order(program, 1)
        program.delay(m.settle_s + 4.0)
    metrics.append(m.metric(program))
    program.set_mode(m.between)
    program.delay(5.0)
    program.set_mode(m.mode)
    m.order(program, 2)
    program.delay(m.settle_s + 4.0)
    metrics.append(m.metric(program))
    first, last = metrics[0], metrics[-1]
    if abs(last - first) <= LEAST * max(abs(first), abs(last)):
        return NEVER
    for metric, said in zip(metrics[1:], (AT_ONCE, NEXT_ORDER, MODE_ANEW), strict=True):
        if abs(metric - first) >= SEEN * abs(last - first) and not math.isclose(metric, first):
            return said
    return NEVER


def scan(programs: Programs) -> dict[str, str]:
    """Rows "PARAMETER in MANOEUVRE"."""
    rows = {}
    manoeuvres = COPTER if programs.kind == "copter" else ROVER
    for name, manoeuvre, old, new in CASES[programs.kind]:
        row = f"{name} in {manoeuvre}"
        if fnmatchcase(row, programs.rows):
            m = manoeuvres[manoeuvre]
            with programs.started() as program:
                program.be_ready()
                if m.mode == "AUTO":
                    upload(program)
                program.be_flying(m.height_m)
                rows[row] = when(program, name, m, old, new)
    return rows
