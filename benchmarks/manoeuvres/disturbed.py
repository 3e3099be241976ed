# SPDX-License-Identifier: BSD-3-Clause
"""Manoeuvres of a copter that something disturbs: a motor, the GPS, wind; and what it does with its sticks at rest."""

from __future__ import annotations

import math

import numpy as np

from .copter import HEIGHT, PITCH, ROLL, THROTTLE, YAW
from .flyer import Flyer
from .track import Track

LOW_HEIGHT = 7.0
"""At which a landing is timed [m]."""


def _deviation(f: Flyer, name: str, t: Track) -> None:
    """How far it is pushed away, when it is back, and how it then leans."""
    away = t.distance(float(t.x[0]), float(t.y[0]))
    f.note(f"{name}: farthest", "m", float(away.max()))
    f.note(f"{name}: farthest after", "s", float(t.t[away.argmax()]))
    f.note(f"{name}: greatest lean", "deg", float(t.lean.max()))
    f.note(f"{name}: height changes", "m", float(np.ptp(t.height)))


def lost_motor(f: Flyer) -> None:
    """LOITER at 40 m: motor 1 stops."""
    f.airborne(40.0)
    f.sticks({})
    f.set_mode("LOITER")
    f.delay(3.0)
    f.params.update(SIM_ENGINE_MUL=0.0, SIM_ENGINE_FAIL=1)
    t = f.fly(2.5)
    f.note("motor 1 lost: 30 deg of lean", "s", t.crossing(t.lean, 30.0))
    f.note("motor 1 lost: greatest lean", "deg", float(t.lean.max()))
    f.note("motor 1 lost: turn rate after 0.5 s", "deg/s", t.at(t.r, 0.5))
    f.note("motor 1 lost: fastest turn", "deg/s", float(np.abs(t.r).max()))
    f.note("motor 1 lost: fastest roll", "deg/s", float(np.abs(t.p).max()))
    f.note("motor 1 lost: sinks in 2 s", "m", float(t.height[0] - t.at(t.height, 2.0)))
    f.note("motor 1 lost: speed of sinking after 2 s", "m/s", -t.at(t.climb, 2.0))


def weak_motor(f: Flyer) -> None:
    """LOITER: motor 1 has 0.8 and then 0.6 of its control, and is whole again."""
    f.airborne(HEIGHT)
    f.sticks({})
    f.set_mode("LOITER")
    f.delay(3.0)
    for share in (0.8, 0.6):
        f.params.update(SIM_ENGINE_MUL=share, SIM_ENGINE_FAIL=1)
        t = f.fly(10.0)
        name = f"motor 1 at {share:g}"
        _deviation(f, name, t)
        f.note(f"{name}: fastest turn", "deg/s", float(np.abs(t.r).max()))
        f.note(f"{name}: turned", "deg", float(t.yaw[-1]))
        f.params["SIM_ENGINE_FAIL"] = 0
        t = f.fly(10.0)
        f.note(f"motor 1 whole after {share:g}: fastest turn", "deg/s", float(np.abs(t.r).max()))
        f.note(f"motor 1 whole after {share:g}: turned", "deg", float(t.yaw[-1]))


def lost_gps(f: Flyer) -> None:
    """GPS lost at rest in LOITER."""
    f.airborne(10.0)
    f.sticks({})
    f.set_mode("LOITER")
    f.delay(5.0)
    _without_gps(f, "GPS lost in LOITER")


def lost_gps_moving(f: Flyer) -> None:
    """GPS lost at 4 m/s in GUIDED."""
    f.airborne(10.0)
    f.sticks({})
    f.set_velocity(4.0, 0.0)
    f.delay(6.0)
    _without_gps(f, "GPS lost at 4 m/s")


def _without_gps(f: Flyer, name: str) -> None:
    mode = f.mode
    f.params["SIM_GPS1_ENABLE"] = 0
    start = f.now
    t = f.fly(30.0, lambda: f.mode != mode)
    f.note(f"{name}: changes its mode", "s", f.now - start if f.mode != mode else math.nan)
    f.note(f"{name}: covered until then", "m", t.covered)
    if mode == "GUIDED":
        f.note(f"{name}: speed then", "m/s", float(t.speed[-1]))
    changed = f.now
    t = f.fly(20.0, lambda: f.altitude < LOW_HEIGHT)
    f.note(f"{name}: {LOW_HEIGHT:g} m high", "s", f.now - changed if f.altitude < LOW_HEIGHT else math.nan)
    f.note(f"{name}: its position is told until", "s", float(t.t[-1]))
    f.note(f"{name}: covered while it is told", "m", t.covered)
    f.passes(lambda: not f.armed, 60.0)
    f.note(f"{name}: disarmed", "s", f.now - changed if not f.armed else math.nan)


def gusts(f: Flyer) -> None:
    """LOITER, GUIDED and ALT_HOLD in a wind that begins, turns and ends."""
    f.airborne(HEIGHT)
    f.sticks({})
    f.set_mode("LOITER")
    f.delay(4.0)
    for name, params in (
        ("wind of 8 m/s begins", {"SIM_WIND_DIR": 180.0, "SIM_WIND_SPD": 8.0}),
        ("wind turns by 90 deg", {"SIM_WIND_DIR": 90.0}),
        ("wind ends", {"SIM_WIND_SPD": 0.0}),
    ):
        f.params.update(params)
        t = f.fly(20.0)
        _deviation(f, f"LOITER, {name}", t)
        away = t.distance(float(t.x[0]), float(t.y[0]))
        f.note(f"LOITER, {name}: within 0.3 m", "s", t.below(away, 0.3))
        f.note(f"LOITER, {name}: lean", "deg", t.mean(t.lean, 15.0))
    f.set_mode("GUIDED")
    f.go_to(0.0, 0.0, HEIGHT)
    f.delay(4.0)
    f.params["SIM_WIND_SPD"] = 8.0
    t = f.fly(20.0)
    _deviation(f, "GUIDED, wind of 8 m/s begins", t)
    f.note("GUIDED, wind of 8 m/s begins: within 0.3 m", "s", t.below(t.distance(float(t.x[0]), float(t.y[0])), 0.3))
    for north in (15.0, 0.0):
        name = f"GUIDED {'down' if north else 'up'} the wind"
        f.go_to(0.0, north, HEIGHT)
        t = f.fly(12.0)
        away = t.distance(0.0, north)
        f.note(f"{name}: within 1 m", "s", t.below(away, 1.0))
        f.note(f"{name}: peak speed", "m/s", float(t.speed.max()))
        f.note(f"{name}: greatest lean", "deg", float(t.lean.max()))
    f.set_mode("ALT_HOLD")
    t = f.fly(6.0)
    f.note("ALT_HOLD in a wind of 8 m/s: covered in 6 s", "m", t.covered)
    f.note("ALT_HOLD in a wind of 8 m/s: speed after 6 s", "m/s", float(t.speed[-1]))
    f.params["SIM_WIND_SPD"] = 0.0


def at_rest(f: Flyer) -> None:
    """STABILIZE and ACRO for 6 s with sticks at rest or a little out."""
    f.airborne(HEIGHT)
    f.sticks({})
    for mode, sticks, what in (
        ("STABILIZE", {}, "sticks at rest"),
        ("STABILIZE", {ROLL: 1540}, "roll stick 1540 us"),
        ("STABILIZE", {PITCH: 1440, THROTTLE: 1520}, "pitch stick 1440 us"),
        ("ACRO", {}, "sticks at rest"),
        ("ACRO", {YAW: 1700}, "yaw stick 1700 us"),
    ):
        name = f"{mode}, {what}"
        f.set_mode(mode)
        f.sticks(sticks)
        t = f.fly(6.0)
        if ROLL in sticks or PITCH in sticks:
            f.note(f"{name}: speed after 6 s", "m/s", float(t.speed[-1]))
        f.note(f"{name}: covered in 6 s", "m", t.covered)
        f.note(f"{name}: climb after 6 s", "m/s", float(t.climb[-1]))
        f.note(f"{name}: height after 6 s", "m", float(t.height[-1] - t.height[0]))
        f.set_mode("LOITER")
        f.sticks({})
        f.delay(12.0)


def acro_turns(f: Flyer) -> None:
    """ACRO: rolls and pitches back and forth, and one flip, with the throttle where it is."""
    f.airborne(40.0)
    f.sticks({})
    for stick, name in ((ROLL, "roll"), (PITCH, "pitch")):
        f.set_mode("ACRO")
        start = f.fly(0.1)
        leans = []
        for pulse in (1700, 1300, 1300, 1700):
            f.sticks({stick: pulse})
            t = f.fly(0.6)
            leans.append(float(t.lean.max()))
        f.sticks({})
        t = f.fly(2.0)
        f.note(f"ACRO, {name} back and forth: greatest lean", "deg", max(leans))
        f.note(f"ACRO, {name} back and forth: height changes", "m", float(t.height[-1] - start.height[0]))
        f.note(f"ACRO, {name} back and forth: speed", "m/s", float(t.speed[-1]))
        f.note(f"ACRO, {name} back and forth: climb", "m/s", float(t.climb[-1]))
        f.set_mode("LOITER")
        f.delay(14.0)
    f.params["ACRO_TRAINER"] = 0
    f.set_mode("ACRO")
    f.sticks({ROLL: 1900})
    t = f.fly(1.0)
    f.note("ACRO, full roll: fastest", "deg/s", float(t.p.max()))
    f.note("ACRO, full roll: height after 1 s", "m", float(t.height[-1] - t.height[0]))
    f.set_mode("LOITER")
    f.sticks({})
    t = f.fly(10.0)
    f.note("ACRO, full roll: lowest after it", "m", float(t.height.min() - t.height[0]))
    f.note("ACRO, full roll: below 5 deg", "s", t.below(t.lean, 5.0))


FLIGHTS = {
    flight.__name__: flight
    for flight in (lost_motor, weak_motor, lost_gps, lost_gps_moving, gusts, at_rest, acro_turns)
}
