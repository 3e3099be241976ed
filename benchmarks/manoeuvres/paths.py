# SPDX-License-Identifier: BSD-3-Clause
"""Paths of a copter whose speed, height or goal changes while it flies them; splines, and pauses on them."""

from __future__ import annotations

from .copter import HEIGHT, arrivals, fastest
from .flyer import Flyer

PAUSE, CONTINUE = 0, 1


def _pause(f: Flyer, on: int) -> None:
    f.send_command("DO_PAUSE_CONTINUE", on)


def slower_on_the_way(f: Flyer) -> None:
    """GUIDED legs of 80 m: the speed is lowered while it accelerates, and raised again."""
    f.airborne(HEIGHT)
    for name, wait, changes in (
        ("lowered to 3 m/s after 2 s", 2.0, (3.0,)),
        ("lowered to 2 m/s after 1 s, 6 m/s 5 s later", 1.0, (2.0, 6.0)),
    ):
        f.send_command("DO_CHANGE_SPEED", 1, 8.0, -1)
        f.delay(0.5)
        north = 80.0 if f.position.north < 40.0 else 0.0
        f.go_to(north, 0.0, HEIGHT)
        f.delay(wait)
        for speed in changes:
            f.send_command("DO_CHANGE_SPEED", 1, speed, -1)
            t = f.fly(5.0)
            f.note(f"80 m, {name}: speed 5 s after {speed:g} m/s was asked", "m/s", float(t.speed[-1]))
            f.note(f"80 m, {name}: fastest after {speed:g} m/s was asked", "m/s", float(t.speed.max()))

        def is_there(goal: float = north) -> bool:
            return abs(f.position.north - goal) < 1.0

        t = f.fly(60.0, is_there)
        f.note(f"80 m, {name}: within 1 m", "s", float(t.t[-1]))
        f.delay(6.0)


def slower_in_auto(f: Flyer) -> None:
    """AUTO: a leg of 80 m whose speed is lowered while it accelerates."""
    f.be_ready()
    items = [
        f.item("NAV_WAYPOINT", 0.0, 0.0),
        f.item("NAV_TAKEOFF", altitude=10.0),
        f.item("NAV_WAYPOINT", 80.0, 0.0, 10.0, param1=1.0),
    ]
    f.begin_mission(items)
    f.fly(60.0, lambda: 1 in f.reached)
    begun = f.now
    f.delay(2.5)
    f.send_command("DO_CHANGE_SPEED", 1, 3.0, -1)
    t = f.fly(6.0)
    f.note("AUTO, 80 m, lowered to 3 m/s: speed 6 s later", "m/s", float(t.speed[-1]))
    f.note("AUTO, 80 m, lowered to 3 m/s: fastest", "m/s", float(t.speed.max()))
    f.note("AUTO, 80 m, lowered to 3 m/s: covered in 6 s", "m", t.covered)
    f.fly(60.0, lambda: 2 in f.reached)
    f.note("AUTO, 80 m, lowered to 3 m/s: reached", "s", arrivals(f, begun, ()).get(2, float("nan")))


def reversed_heights(f: Flyer) -> None:
    """GUIDED: a climb that becomes a descent on the way, and the reverse; the same with a way along."""
    f.airborne(HEIGHT)
    for name, north, first, wait, second in (
        ("up, then down", 0.0, 40.0, 3.0, 15.0),
        ("down, then up", 0.0, 5.0, 3.0, 25.0),
        ("along and up, then back and down", 30.0, 45.0, 4.0, 20.0),
    ):
        f.go_to(north, 0.0, first)
        f.delay(wait)
        f.go_to(0.0, 0.0, second)
        t = f.fly(18.0)
        f.note(f"{name}: highest", "m", float(t.height.max()))
        f.note(f"{name}: lowest", "m", float(t.height.min()))
        f.note(f"{name}: turns", "s", t.crossing(t.climb, 0.0))
        f.note(f"{name}: fastest climb", "m/s", float(t.climb.max()))
        f.note(f"{name}: fastest descent", "m/s", float(t.climb.min()))
        f.note(f"{name}: within 0.5 m of the height", "s", t.below(abs(t.height - second), 0.5))


def splines(f: Flyer) -> None:
    """AUTO: splines of changing height, paused and continued, and a change of speed on them."""
    f.be_ready()
    items = [
        f.item("NAV_WAYPOINT", 0.0, 0.0),
        f.item("NAV_TAKEOFF", altitude=15.0),
        f.item("NAV_SPLINE_WAYPOINT", 30.0, 0.0, 20.0),
        f.item("NAV_SPLINE_WAYPOINT", 50.0, 25.0, 15.0),
        f.item("DO_CHANGE_SPEED", param1=1, param2=3.0, param3=-1),
        f.item("NAV_SPLINE_WAYPOINT", 30.0, 50.0, 25.0),
        f.item("NAV_WAYPOINT", 0.0, 50.0, 15.0),
        f.item("NAV_WAYPOINT", 0.0, 0.0, 15.0),
    ]
    f.begin_mission(items)
    start = f.now
    first = f.fly(60.0, lambda: 2 in f.reached)
    begun = f.now
    f.delay(1.5)
    f.note("splines: item 2 reached", "s", begun - start)
    f.note("splines: fastest before it", "m/s", fastest(first.speed))
    _pause(f, PAUSE)
    t = f.fly(6.0)
    f.note("splines: paused, below 0.5 m/s", "s", t.below(t.speed, 0.5))
    f.note("splines: paused, distance", "m", t.covered)
    _pause(f, CONTINUE)
    begun = f.now
    t = f.fly(90.0, lambda: 7 in f.reached)
    reached = arrivals(f, begun, (3,))
    for seq in (3, 5, 6, 7):
        f.note(f"splines: item {seq} reached after the pause", "s", reached.get(seq, float("nan")))
    second = t.t < reached.get(3, 0.0)
    f.note("splines: fastest on the second", "m/s", fastest(t.speed[second]))
    third = (t.t > reached.get(3, 0.0) + 3.0) & (t.t < reached.get(5, 0.0))
    f.note("splines: fastest on the third", "m/s", fastest(t.speed[third]))
    f.note("splines: farthest north", "m", float(t.x.max()))
    f.note("splines: highest", "m", float(t.height.max()))
    f.note("splines: fastest climb of the third", "m/s", fastest(t.climb[third]))


def paused(f: Flyer) -> None:
    """AUTO: a leg paused while it accelerates and while it brakes."""
    f.be_ready()
    items = [
        f.item("NAV_WAYPOINT", 0.0, 0.0),
        f.item("NAV_TAKEOFF", altitude=10.0),
        f.item("NAV_WAYPOINT", 60.0, 0.0, 20.0),
        f.item("NAV_WAYPOINT", 60.0, 60.0, 10.0, param1=1.0),
    ]
    f.begin_mission(items)
    f.fly(60.0, lambda: 1 in f.reached)
    f.delay(2.0)
    for name in ("speeding up", "on the way"):
        _pause(f, PAUSE)
        t = f.fly(6.0)
        f.note(f"paused {name}: below 0.5 m/s", "s", t.below(t.speed, 0.5))
        f.note(f"paused {name}: distance", "m", t.covered)
        f.note(f"paused {name}: height changes", "m", float(t.height[-1] - t.height[0]))
        _pause(f, CONTINUE)
        t = f.fly(5.0)
        f.note(f"continued {name}: speed after 3 s", "m/s", t.at(t.speed, 3.0))
        f.note(f"continued {name}: covered in 5 s", "m", t.covered)
    begun = f.now
    f.fly(60.0, lambda: 3 in f.reached)
    reached = arrivals(f, begun, ())
    f.note("paused: last item reached", "s", reached.get(3, float("nan")))


FLIGHTS = {flight.__name__: flight for flight in (slower_on_the_way, slower_in_auto, reversed_heights, splines, paused)}
