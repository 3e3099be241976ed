# SPDX-License-Identifier: BSD-3-Clause
"""Manoeuvres of a rover; each begins with a vehicle that has just been started, facing north."""

from __future__ import annotations

import numpy as np

from .copter import arrivals, fastest, slowest, step_metrics
from .flyer import Flyer

STEERING, THROTTLE = 1, 3


def _stop(f: Flyer, name: str, seconds: float = 8.0) -> None:
    """How long and how far it takes to stop."""
    t = f.fly(seconds)
    f.note(f"{name}: below 0.5 m/s", "s", t.below(t.speed, 0.5))
    f.note(f"{name}: distance", "m", t.covered)


def _ready(f: Flyer, mode: str = "GUIDED") -> None:
    f.sticks({})
    f.be_ready(mode)
    f.arm()
    f.delay(2.0)


def velocities(f: Flyer) -> None:
    """GUIDED velocities: steps of speed, a corner, a stop, and silence."""
    _ready(f)
    for name, north in (("2 m/s", 2.0), ("4 m/s", 4.0)):
        f.set_velocity(north, 0.0)
        t = f.fly(8.0)
        f.note(f"{name}: 1.8 m/s", "s", t.crossing(t.speed, 1.8))
        f.note(f"{name}: greatest", "m/s", float(t.speed.max()))
        f.note(f"{name}: steady", "m/s", t.mean(t.speed, 6.0))
        f.note(f"{name}: covered", "m", t.covered)
    f.set_velocity(0.0, 3.0)
    t = f.fly(8.0)
    step_metrics(f, "3 m/s round a corner", t, t.yaw, 90.0, "deg")
    f.note("3 m/s round a corner: fastest turn", "deg/s", float(t.r.max()))
    f.note("3 m/s round a corner: speed at the end", "m/s", float(t.speed[-1]))
    f.set_velocity(0.0, 0.0)
    _stop(f, "stop from 3 m/s")
    f.set_velocity(0.0, 3.0)
    f.delay(6.0)
    f.set_velocity(0.0, 3.0)
    f._stop_sending("velocity")
    _stop(f, "silence at 3 m/s")


def positions(f: Flyer) -> None:
    """GUIDED places: ahead, aside, behind."""
    _ready(f)
    for name, north, east in (("20 m ahead", 20.0, 0.0), ("20 m aside", 20.0, 20.0), ("behind", 0.0, 0.0)):
        f.go_to(north, east, 0.0)
        t = f.fly(18.0)
        away = t.distance(north, east)
        f.note(f"{name}: half of the way", "s", t.crossing(away, 0.5 * float(away[0])))
        f.note(f"{name}: within 3 m", "s", t.crossing(away, 3.0))
        f.note(f"{name}: peak speed", "m/s", float(t.speed.max()))
        f.note(f"{name}: fastest turn", "deg/s", float(np.abs(t.r).max()))
        f.note(f"{name}: error at the end", "m", float(away[-1]))


def manual(f: Flyer) -> None:
    """MANUAL by sticks: throttle, steering, coasting, reverse."""
    _ready(f, "MANUAL")
    for name, pulse in (("1600 us", 1600), ("full", 1900)):
        f.sticks({THROTTLE: pulse})
        t = f.fly(3.0)
        f.note(f"MANUAL, throttle {name}: 2 m/s", "s", t.crossing(t.speed, 2.0))
        f.note(f"MANUAL, throttle {name}: speed after 3 s", "m/s", t.at(t.speed, 3.0))
        f.sticks({})
        t = f.fly(3.0)
        f.note(f"MANUAL, throttle {name} released: speed after 2 s", "m/s", t.at(t.speed, 2.0))
    f.delay(12.0)
    f.sticks({THROTTLE: 1350})
    t = f.fly(3.0)
    f.note("MANUAL, throttle 1350 us: speed backwards", "m/s", float(t.speed[-1]))
    f.sticks({})
    f.delay(10.0)
    f.sticks({THROTTLE: 1570})
    f.delay(3.0)
    f.sticks({THROTTLE: 1570, STEERING: 1600})
    t = f.fly(3.0)
    f.note("MANUAL, steering 1600 us: turn rate", "deg/s", t.mean(t.r, 1.0))
    f.note("MANUAL, steering 1600 us: radius", "m", t.mean(t.speed, 1.0) / np.radians(t.mean(t.r, 1.0)))


def _by_speed(f: Flyer, mode: str) -> None:
    """A mode in which the throttle stick is a speed."""
    _ready(f, mode)
    for name, pulse in (("1600 us", 1600), ("full", 1900)):
        f.sticks({THROTTLE: pulse})
        t = f.fly(8.0)
        steady = t.mean(t.speed, 6.0)
        f.note(f"{mode}, throttle {name}: speed", "m/s", steady)
        f.note(f"{mode}, throttle {name}: greatest", "m/s", float(t.speed.max()))
        f.note(f"{mode}, throttle {name}: 90 %", "s", t.crossing(t.speed, 0.9 * steady))
    f.sticks({})
    _stop(f, f"{mode}, sticks released")
    f.sticks({THROTTLE: 1650})
    f.delay(6.0)
    for name, pulse in (("1600 us", 1600), ("full left", 1100)):
        f.sticks({THROTTLE: 1650, STEERING: pulse})
        t = f.fly(4.0)
        f.note(f"{mode}, steering {name}: turn rate", "deg/s", t.mean(t.r, 1.5))
        f.note(f"{mode}, steering {name}: speed", "m/s", t.mean(t.speed, 1.5))
        f.sticks({THROTTLE: 1650})
        t = f.fly(3.0)
        f.note(f"{mode}, steering {name} released: turns on", "deg", float(t.yaw[-1]))
    f.sticks({})
    f.delay(6.0)
    f.sticks({THROTTLE: 1350})
    t = f.fly(6.0)
    f.note(f"{mode}, throttle 1350 us: speed backwards", "m/s", t.mean(t.speed, 4.0))


def acro(f: Flyer) -> None:
    """ACRO by sticks."""
    _by_speed(f, "ACRO")


def steering(f: Flyer) -> None:
    """STEERING by sticks."""
    _by_speed(f, "STEERING")


def mission(f: Flyer) -> None:
    """AUTO: a square with a delay, slower, and in reverse."""
    f.be_ready("HOLD")
    items = [
        f.item("NAV_WAYPOINT", 0.0, 0.0),
        f.item("NAV_WAYPOINT", 30.0, 0.0),
        f.item("NAV_WAYPOINT", 30.0, 30.0, param1=3.0),
        f.item("DO_CHANGE_SPEED", param1=1, param2=2.5, param3=-1),
        f.item("NAV_WAYPOINT", 0.0, 30.0),
        f.item("DO_SET_REVERSE", param1=1),
        f.item("NAV_WAYPOINT", 0.0, 10.0),
        f.item("DO_SET_REVERSE", param1=0),
        f.item("NAV_WAYPOINT", 10.0, 0.0),
    ]
    f.transfer(items)
    f.arm()
    f.delay(2.0)
    f.change_mode("AUTO")
    start = f.now
    t = f.fly(120.0, lambda: 8 in f.reached)
    reached = arrivals(f, start, (2, 4, 6))
    for seq in (1, 2, 4, 6, 8):
        f.note(f"AUTO: item {seq} reached", "s", reached.get(seq, float("nan")))
    f.note("AUTO: peak speed", "m/s", float(t.speed.max()))
    f.note("AUTO: passes the first corner at", "m", float(t.distance(30.0, 0.0).min()))
    early = t.t < reached.get(2, 0.0)
    f.note("AUTO: slowest at the first corner", "m/s", slowest(t.speed[early & (t.distance(30.0, 0.0) < 5.0)]))
    first = t.t < reached.get(4, 0.0)
    away = t.distance(30.0, 15.0)[first & (t.y > 14.0) & (t.y < 16.0) & (t.x > 20.0)]
    f.note("AUTO: off the line in the middle of the second leg", "m", slowest(away))
    slow = (t.t > reached.get(2, 0.0) + 5.0) & (t.t < reached.get(4, 0.0))
    f.note("AUTO: speed after DO_CHANGE_SPEED", "m/s", fastest(t.speed[slow]))
    back = (t.t > reached.get(4, 0.0) + 3.0) & (t.t < reached.get(6, 0.0))
    f.note("AUTO: speed in reverse", "m/s", fastest(t.speed[back]))
    stop = f.fly(6.0)
    f.note("AUTO: rolls on at the end", "m", stop.covered)


def stick_mixing(f: Flyer) -> None:
    """AUTO with the steering stick out, STICK_MIXING 1."""
    f.params["STICK_MIXING"] = 1
    f.sticks({})
    f.be_ready("HOLD")
    f.transfer([f.item("NAV_WAYPOINT", 0.0, 0.0), f.item("NAV_WAYPOINT", 400.0, 0.0)])
    f.arm()
    f.delay(2.0)
    f.change_mode("AUTO")
    f.delay(6.0)
    for pulse in (1420, 1300):
        f.sticks({STEERING: pulse})
        t = f.fly(8.0)
        f.note(f"steering stick {pulse} us in AUTO: turned", "deg", float(t.yaw[-1]))
        f.note(f"steering stick {pulse} us in AUTO: speed", "m/s", t.mean(t.speed, 4.0))


def away_and_home(f: Flyer, mode: str) -> None:
    """Out by two places, then home in a mode."""
    _ready(f)
    f.go_to(25.0, 0.0, 0.0)
    f.delay(12.0)
    f.go_to(25.0, 20.0, 0.0)
    f.delay(12.0)
    f.change_mode(mode)
    t = f.fly(60.0)
    home = t.distance(0.0, 0.0)
    f.note(f"{mode}: half of the way", "s", t.crossing(home, 0.5 * float(home[0])))
    f.note(f"{mode}: within 3 m of home", "s", t.crossing(home, 3.0))
    f.note(f"{mode}: peak speed", "m/s", float(t.speed.max()))
    f.note(f"{mode}: farthest from home", "m", float(home.max()))
    f.note(f"{mode}: error at the end", "m", float(home[-1]))


def rtl(f: Flyer) -> None:
    """RTL from 32 m away."""
    away_and_home(f, "RTL")


def smart_rtl(f: Flyer) -> None:
    """SMART_RTL round a corner."""
    away_and_home(f, "SMART_RTL")


def stops(f: Flyer) -> None:
    """HOLD, LOITER and CIRCLE from speed."""
    _ready(f)
    for mode in ("HOLD", "LOITER"):
        f.set_mode("GUIDED")
        f.set_velocity(4.0, 0.0)
        f.delay(7.0)
        f._stop_sending("velocity")
        f.change_mode(mode)
        _stop(f, f"{mode} from 4 m/s", 10.0)
    f.change_mode("CIRCLE")
    f.delay(15.0)
    t = f.fly(30.0)
    f.note("CIRCLE: speed", "m/s", float(t.speed.mean()))
    f.note("CIRCLE: turn rate", "deg/s", float(t.r.mean()))
    f.note("CIRCLE: diameter", "m", float(np.ptp(t.y)))


def within_fence(f: Flyer) -> None:
    """ACRO and GUIDED against a circle around home."""
    _ready(f)
    f.params.update(FENCE_TYPE=2, FENCE_RADIUS=25, FENCE_MARGIN=2, FENCE_ACTION=0, FENCE_ENABLE=1)
    f.set_mode("ACRO")
    f.sticks({3: 1700})
    t = f.fly(25.0)
    out = t.distance(0.0, 0.0)
    f.note("ACRO: 15 m from home", "s", t.crossing(out, 15.0))
    f.note("ACRO: peak speed", "m/s", float(t.speed.max()))
    f.note("ACRO: farthest", "m", float(out.max()))
    f.note("ACRO: at the end", "m", float(out[-1]))
    f.sticks({})
    f.set_mode("GUIDED")
    f.go_to(0.0, 0.0, 0.0)
    f.delay(25.0)
    f.go_to(0.0, 40.0, 0.0)
    t = f.fly(30.0)
    out = t.distance(0.0, 0.0)
    f.note("GUIDED to a place beyond: farthest", "m", float(out.max()))
    f.note("GUIDED to a place beyond: at the end", "m", float(out[-1]))


FLIGHTS = {
    flight.__name__: flight
    for flight in (
        velocities, positions, manual, acro, steering, mission, stick_mixing, rtl, smart_rtl, stops, within_fence,
    )
}  # fmt: skip
