# SPDX-License-Identifier: BSD-3-Clause
"""Manoeuvres of a copter; each begins with a vehicle that has just been started."""

from __future__ import annotations

import numpy as np

from .flyer import Flyer
from .track import Track

ROLL, PITCH, THROTTLE, YAW = 1, 2, 3, 4
HEIGHT = 20.0
"""Of manoeuvres by sticks [m]."""


def step_metrics(f: Flyer, name: str, track: Track, column: np.ndarray, size: float, unit: str) -> None:
    """Half and 95 % of a step in a column, and its greatest value."""
    for share in (0.5, 0.95):
        f.note(f"{name}: {share:.0%}", "s", track.crossing(column - column[0], share * size))
    f.note(f"{name}: greatest", unit, float((column - column[0]).max() if size > 0.0 else (column - column[0]).min()))


def stop_metrics(f: Flyer, name: str, track: Track) -> None:
    """How long and how far it takes to stop."""
    f.note(f"{name}: below 0.5 m/s", "s", track.below(track.speed, 0.5))
    f.note(f"{name}: distance", "m", track.covered)
    f.note(f"{name}: greatest lean", "deg", float(track.lean.max()))


def slowest(speeds: np.ndarray) -> float:
    """The least speed [m/s]; NaN without one."""
    return float(speeds.min()) if len(speeds) else float("nan")


def fastest(speeds: np.ndarray) -> float:
    """The greatest speed [m/s]; NaN without one."""
    return float(speeds.max()) if len(speeds) else float("nan")


def arrivals(f: Flyer, start: float, told_with_next: tuple[int, ...]) -> dict[int, float]:
    """Times [s] since the start at which mission items were reached.

    ``told_with_next``: items after which the next is done at once; of the two, ArduPilot tells the second alone.
    """
    reached = {seq: time - start for time, seq in f.telemetry.reached}
    for seq in told_with_next:
        if seq not in reached and seq + 1 in reached:
            reached[seq] = reached[seq + 1]
    return reached


def take_off_and_land(f: Flyer) -> None:
    """GUIDED take-off to 10 m; a higher and a lower place; LAND."""
    f.be_ready()
    f.arm()
    f.delay(2.0)
    f.send_command("NAV_TAKEOFF", altitude=10.0)
    t = f.fly(16.0)
    for height in (1.0, 5.0, 9.5):
        f.note(f"take-off: {height:g} m", "s", t.crossing(t.height, height))
    f.note("take-off: greatest height", "m", float(t.height.max()))
    f.note("take-off: fastest climb", "m/s", float(t.climb.max()))
    f.go_to(0.0, 0.0, 20.0)
    t = f.fly(14.0)
    step_metrics(f, "up 10 m", t, t.height, 10.0, "m")
    f.note("up 10 m: fastest climb", "m/s", float(t.climb.max()))
    f.go_to(0.0, 0.0, 12.0)
    t = f.fly(14.0)
    step_metrics(f, "down 8 m", t, t.height, -8.0, "m")
    f.note("down 8 m: fastest descent", "m/s", float(t.climb.min()))
    f.change_mode("LAND")
    t = f.fly(60.0, lambda: not f.armed)
    for height in (10.0, 5.0, 0.5):
        f.note(f"LAND: {height:g} m", "s", t.crossing(t.height, height))
    f.note("LAND: fastest descent", "m/s", float(t.climb.min()))
    f.note("LAND: final descent", "m/s", t.at(t.climb, t.crossing(t.height, 2.0)))
    f.note("LAND: disarmed", "s", float(t.t[-1]))
    f.note("LAND: drift", "m", t.covered)


def positions(f: Flyer) -> None:
    """GUIDED places: 20 m north, back while turning, 30 m aside and up."""
    f.airborne(10.0)
    f.go_to(20.0, 0.0, 10.0)
    t = f.fly(15.0)
    step_metrics(f, "20 m north", t, t.x, 20.0, "m")
    f.note("20 m north: peak speed", "m/s", float(t.speed.max()))
    f.note("20 m north: greatest lean", "deg", float(t.lean.max()))
    f.note("20 m north: loses height", "m", float(t.height[0] - t.height.min()))
    f.go_to(0.0, 0.0, 10.0, yaw=180.0)
    t = f.fly(15.0)
    step_metrics(f, "20 m back, turning", t, t.x, -20.0, "m")
    f.note("20 m back, turning: 90 deg", "s", t.crossing(np.abs(t.yaw), 90.0))
    f.note("20 m back, turning: heading at the end", "deg", t.heading)
    f.go_to(0.0, 30.0, 20.0)
    t = f.fly(18.0)
    step_metrics(f, "30 m aside and 10 m up", t, t.y, 30.0, "m")
    f.note("30 m aside and 10 m up: fastest climb", "m/s", float(t.climb.max()))
    f.note("30 m aside and 10 m up: peak speed", "m/s", float(t.speed.max()))
    f.go_to(30.0, 30.0, 20.0)
    f.delay(2.0)
    f.go_to(30.0, 0.0, 20.0)
    t = f.fly(15.0)
    f.note("a new place on the way: reaches 95 % west", "s", t.crossing(t.y, 1.5))
    f.note("a new place on the way: within 1 m", "s", t.below(t.distance(30.0, 0.0), 1.0))
    f.note("a new place on the way: peak speed", "m/s", float(t.speed.max()))


def velocities(f: Flyer) -> None:
    """GUIDED velocities: 3 m/s, 8 m/s, a reversal, up and down, and stops."""
    f.airborne(HEIGHT)
    for name, north, east, seconds in (("3 m/s east", 0.0, 3.0, 8.0), ("8 m/s north", 8.0, 0.0, 9.0)):
        f.set_velocity(north, east)
        t = f.fly(seconds)
        step_metrics(f, name, t, t.vy if east else t.vx, max(north, east), "m/s")
        f.note(f"{name}: greatest lean", "deg", float(t.lean.max()))
        f.note(f"{name}: covered", "m", t.covered)
        f.set_velocity(0.0, 0.0)
        stop_metrics(f, f"stop from {name}", f.fly(8.0))
    f.set_velocity(4.0, 0.0)
    f.delay(6.0)
    f.set_velocity(-4.0, 0.0)
    t = f.fly(7.0)
    step_metrics(f, "4 m/s reversed", t, t.vx, -8.0, "m/s")
    f.set_velocity(0.0, 4.0)
    t = f.fly(7.0)
    step_metrics(f, "4 m/s round a corner", t, t.vy, 4.0, "m/s")
    f.set_velocity(0.0, 0.0)
    f.delay(5.0)
    for name, down in (("climb 2 m/s", -2.0), ("descend 1 m/s", 1.0)):
        f.set_velocity(0.0, 0.0, down)
        t = f.fly(6.0)
        step_metrics(f, name, t, t.climb, -down, "m/s")
        f.set_velocity(0.0, 0.0)
        t = f.fly(4.0)
        f.note(f"stop from {name}: height", "m", float(t.height[-1] - t.height[0]))


def yaws(f: Flyer) -> None:
    """GUIDED headings: CONDITION_YAW and turn rates of set-points, slow and fast senders."""
    f.airborne(10.0)
    f.send_command("CONDITION_YAW", 90, 0, 1, 0)
    t = f.fly(8.0)
    step_metrics(f, "yaw to 90 deg", t, t.yaw, 90.0, "deg")
    f.note("yaw to 90 deg: fastest", "deg/s", float(t.r.max()))
    f.send_command("CONDITION_YAW", 45, 30, -1, 1)
    t = f.fly(6.0)
    step_metrics(f, "yaw -45 deg at 30 deg/s", t, t.yaw, -45.0, "deg")
    f.note("yaw -45 deg at 30 deg/s: fastest", "deg/s", float(t.r.min()))
    for name, interval, rate in (("20 deg/s sent twice a second", 0.5, 20.0), ("40 deg/s sent at 10 Hz", 0.1, -40.0)):
        t = f.velocity_at(6.0, interval, rate)
        step_metrics(f, name, t, t.r, rate, "deg/s")
        f.note(f"{name}: turned", "deg", float(t.yaw[-1]))
    f.go_to(0.0, 0.0, 10.0)
    f.delay(6.0)
    f.go_to(0.0, 0.0, 10.0, yaw=170.0)
    t = f.fly(8.0)
    f.note("yaw of a place: turns", "deg", float(t.yaw[-1]))
    f.note("yaw of a place: half", "s", t.crossing(t.yaw, 0.5 * float(t.yaw[-1])))
    f.note("yaw of a place: fastest", "deg/s", float(np.abs(t.r).max()))


def _turn(f: Flyer, mode: str) -> None:
    """Yaw stick, full and half, and its release."""
    for name, pulse, seconds in (("full", 1900, 4.0), ("half", 1300, 4.0)):
        f.sticks({YAW: pulse})
        t = f.fly(seconds)
        steady = t.mean(t.r, seconds - 1.5)
        f.note(f"{mode}, {name} yaw stick: rate", "deg/s", steady)
        f.note(f"{mode}, {name} yaw stick: 90 %", "s", t.crossing(t.r, 0.9 * steady))
        f.sticks({})
        t = f.fly(3.0)
        f.note(f"{mode}, {name} yaw stick released: turns on", "deg", float(t.yaw[-1]))


def _climbs(f: Flyer, mode: str) -> None:
    """Throttle stick: full, three quarters up, full down."""
    for name, pulse, seconds in (("full", 1900, 5.0), ("1700 us", 1700, 5.0), ("lowest", 1100, 4.0)):
        f.sticks({THROTTLE: pulse})
        t = f.fly(seconds)
        steady = t.mean(t.climb, seconds - 1.5)
        f.note(f"{mode}, throttle {name}: climb", "m/s", steady)
        f.note(f"{mode}, throttle {name}: 90 %", "s", t.crossing(t.climb, 0.9 * steady))
        f.sticks({})
        t = f.fly(4.0)
        f.note(f"{mode}, throttle {name} released: height", "m", float(t.height[-1] - t.height[0]))


def _in_mode(f: Flyer, mode: str) -> None:
    """At rest in a mode, sticks at rest."""
    f.airborne(HEIGHT)
    f.sticks({})
    f.delay(0.5)
    f.set_mode(mode)
    f.delay(3.0)


def _lean(f: Flyer, mode: str, stick: int, pulse: int, seconds: float) -> Track:
    """A stick of roll or pitch held, and released."""
    name = f"{mode}, {'roll' if stick == ROLL else 'pitch'} stick {pulse} us"
    f.sticks({stick: pulse})
    t = f.fly(seconds)
    lean = np.abs(t.roll if stick == ROLL else t.pitch)
    f.note(f"{name}: greatest lean", "deg", float(lean.max()))
    f.note(f"{name}: half of it", "s", t.crossing(lean, 0.5 * float(lean.max())))
    f.note(f"{name}: speed at the end", "m/s", float(t.speed[-1]))
    f.note(f"{name}: covered", "m", t.covered)
    f.sticks({})
    t = f.fly(6.0)
    f.note(f"{name} released: greatest lean back", "deg", float((np.abs(t.roll) if stick == ROLL else np.abs(t.pitch))[
        t.t > 0.5].max()))  # fmt: skip
    f.note(f"{name} released: speed after 2 s", "m/s", t.at(t.speed, 2.0))
    f.note(f"{name} released: covered", "m", t.covered)
    return t


def alt_hold(f: Flyer) -> None:
    """ALT_HOLD by sticks."""
    _in_mode(f, "ALT_HOLD")
    _climbs(f, "ALT_HOLD")
    _turn(f, "ALT_HOLD")
    _lean(f, "ALT_HOLD", ROLL, 1700, 3.0)


def loiter(f: Flyer) -> None:
    """LOITER by sticks."""
    _in_mode(f, "LOITER")
    _climbs(f, "LOITER")
    _turn(f, "LOITER")
    _lean(f, "LOITER", PITCH, 1100, 6.0)
    _lean(f, "LOITER", ROLL, 1600, 6.0)


def poshold(f: Flyer) -> None:
    """POSHOLD by sticks."""
    _in_mode(f, "POSHOLD")
    _climbs(f, "POSHOLD")
    _turn(f, "POSHOLD")
    _lean(f, "POSHOLD", PITCH, 1300, 4.0)
    _lean(f, "POSHOLD", ROLL, 1900, 3.0)


def stabilize(f: Flyer) -> None:
    """STABILIZE by sticks: leans, turns, and throttles above and below the hover."""
    _in_mode(f, "ALT_HOLD")
    f.set_mode("STABILIZE")
    f.sticks({THROTTLE: 1700})
    t = f.fly(2.0)
    f.note("STABILIZE, throttle 1700 us: climb after 2 s", "m/s", float(t.climb[-1]))
    f.note("STABILIZE, throttle 1700 us: height after 2 s", "m", float(t.height[-1] - t.height[0]))
    f.sticks({THROTTLE: 1400})
    t = f.fly(2.0)
    f.note("STABILIZE, throttle 1400 us: climb changes", "m/s", float(t.climb[-1] - t.climb[0]))
    f.set_mode("ALT_HOLD")
    f.sticks({})
    f.delay(8.0)
    for stick, name in ((ROLL, "roll"), (PITCH, "pitch")):
        f.set_mode("STABILIZE")
        f.sticks({stick: 1900, THROTTLE: 1600})
        t = f.fly(1.5)
        lean = t.roll if stick == ROLL else -t.pitch
        lean = lean * np.sign(lean[-1])
        f.note(f"STABILIZE, full {name} stick: lean", "deg", t.mean(lean, 1.0))
        f.note(f"STABILIZE, full {name} stick: 90 %", "s", t.crossing(lean, 0.9 * t.mean(lean, 1.0)))
        f.note(f"STABILIZE, full {name} stick: speed", "m/s", float(t.speed[-1]))
        f.sticks({THROTTLE: 1600})
        t = f.fly(1.0)
        f.note(f"STABILIZE, full {name} stick released: below 3 deg", "s", t.below(t.lean, 3.0))
        f.set_mode("LOITER")
        f.sticks({})
        f.delay(10.0)
    f.set_mode("STABILIZE")
    f.sticks({YAW: 1900, THROTTLE: 1570})
    t = f.fly(2.0)
    f.note("STABILIZE, full yaw stick: rate", "deg/s", t.mean(t.r, 1.2))
    f.note("STABILIZE, full yaw stick: turned", "deg", float(t.yaw[-1]))


def acro(f: Flyer) -> None:
    """ACRO by sticks: body rates, and the trainer that levels."""
    _in_mode(f, "ALT_HOLD")
    f.set_mode("ACRO")
    for stick, name in ((ROLL, "roll"), (PITCH, "pitch")):
        f.sticks({stick: 1650, THROTTLE: 1600})
        t = f.fly(0.5)
        rate = t.p if stick == ROLL else t.q
        f.note(f"ACRO, {name} stick 1650 us: fastest", "deg/s", float(np.abs(rate).max()))
        f.note(f"ACRO, {name} stick 1650 us: lean after 0.5 s", "deg", float(t.lean[-1]))
        f.sticks({THROTTLE: 1600})
        t = f.fly(3.0)
        f.note(f"ACRO, {name} stick 1650 us released: lean after 1 s", "deg", t.at(t.lean, 1.0))
        f.set_mode("LOITER")
        f.sticks({})
        f.delay(10.0)
        f.set_mode("ACRO")
    f.sticks({YAW: 1900, THROTTLE: 1570})
    t = f.fly(2.0)
    f.note("ACRO, full yaw stick: rate", "deg/s", t.mean(t.r, 1.2))
    f.note("ACRO, full yaw stick: turned", "deg", float(t.yaw[-1]))


def brake_and_circle(f: Flyer) -> None:
    """BRAKE from 8 m/s, then CIRCLE."""
    f.airborne(HEIGHT)
    f.sticks({})
    f.set_velocity(8.0, 0.0)
    f.delay(8.0)
    f._stop_sending("velocity")
    f.change_mode("BRAKE")
    t = f.fly(8.0)
    stop_metrics(f, "BRAKE from 8 m/s", t)
    f.note("BRAKE from 8 m/s: loses height", "m", float(t.height[0] - t.height.min()))
    f.change_mode("CIRCLE")
    f.delay(8.0)
    t = f.fly(18.0)
    f.note("CIRCLE: speed", "m/s", float(t.speed.mean()))
    f.note("CIRCLE: turn rate", "deg/s", float(t.r.mean()))
    f.note("CIRCLE: diameter", "m", float(np.ptp(t.x)))
    f.note("CIRCLE: height changes", "m", float(np.ptp(t.height)))
    f.note("CIRCLE: turned in 18 s", "deg", float(t.yaw[-1]))


def come_home(f: Flyer) -> None:
    """RTL from 36 m away."""
    f.airborne(10.0)
    f.go_to(20.0, 30.0, 10.0)
    f.delay(15.0)
    f.change_mode("RTL")
    t = f.fly(90.0, lambda: not f.armed)
    f.note("RTL: climbs to", "m", float(t.height.max()))
    f.note("RTL: 14 m high", "s", t.crossing(t.height, 14.0))
    f.note("RTL: peak speed", "m/s", float(t.speed.max()))
    f.note("RTL: within 2 m of home", "s", t.crossing(t.distance(0.0, 0.0), 2.0))
    f.note("RTL: below 10 m", "s", t.below(t.height, 10.0))
    f.note("RTL: below 5 m", "s", t.below(t.height, 5.0))
    f.note("RTL: disarmed", "s", float(t.t[-1]))
    f.note("RTL: heading at the end", "deg", (t.heading + 180.0) % 360.0 - 180.0)
    f.note("RTL: lands off home", "m", float(t.distance(0.0, 0.0)[-1]))


def within_fence(f: Flyer) -> None:
    """LOITER and GUIDED against a circle around home, sliding and stopping; a ceiling, and a lower one."""
    f.airborne(10.0)
    f.params.update(
        FENCE_TYPE=3, FENCE_RADIUS=20, FENCE_MARGIN=3, FENCE_ALT_MAX=30, FENCE_ACTION=0, AVOID_BEHAVE=0, FENCE_ENABLE=1
    )  # fmt: skip
    for behave, name in ((0, "slides"), (1, "stops")):
        f.params["AVOID_BEHAVE"] = behave
        f.change_mode("LOITER")
        f.sticks({PITCH: 1300, ROLL: 1600})
        t = f.fly(20.0)
        out = t.distance(0.0, 0.0)
        f.note(f"LOITER {name}: 15 m from home", "s", t.crossing(out, 15.0))
        f.note(f"LOITER {name}: farthest", "m", float(out.max()))
        f.note(f"LOITER {name}: at the end", "m", float(out[-1]))
        f.sticks({})
        f.change_mode("GUIDED")
        f.go_to(0.0, 0.0, 10.0)
        f.delay(14.0)
        f.set_velocity(4.0, 1.5)
        t = f.fly(14.0)
        out = t.distance(0.0, 0.0)
        f.note(f"GUIDED {name}: farthest", "m", float(out.max()))
        f.note(f"GUIDED {name}: at the end", "m", float(out[-1]))
        f.note(f"GUIDED {name}: east at the end", "m", float(t.y[-1]))
        f.go_to(0.0, 0.0, 10.0)
        f.delay(14.0)
    f.change_mode("LOITER")
    f.sticks({THROTTLE: 1900})
    t = f.fly(20.0)
    f.note("ceiling: 20 m high", "s", t.crossing(t.height, 20.0))
    f.note("ceiling: highest", "m", float(t.height.max()))
    f.params["FENCE_ALT_MAX"] = 20
    t = f.fly(20.0)
    f.note("lower ceiling: fastest sink", "m/s", float(-t.climb.min()))
    f.note("lower ceiling: below 18.5 m", "s", t.below(t.height, 18.5))
    f.note("lower ceiling: height at the end", "m", float(t.height[-1]))


def mission(f: Flyer) -> None:
    """AUTO: take-off, corners, a delay, a climb, a turn, a change of speed, circles, landing."""
    f.be_ready()
    items = [
        f.item("NAV_WAYPOINT", 0.0, 0.0),
        f.item("NAV_TAKEOFF", altitude=15.0),
        f.item("NAV_WAYPOINT", 40.0, 0.0, 15.0),
        f.item("NAV_WAYPOINT", 40.0, 40.0, 15.0, param1=4.0),
        f.item("DO_CHANGE_SPEED", param1=1, param2=4.0, param3=-1),
        f.item("NAV_WAYPOINT", 0.0, 40.0, 25.0),
        f.item("CONDITION_YAW", param1=90, param2=20, param3=1),
        f.item("NAV_LOITER_TURNS", 0.0, 20.0, 25.0, param1=1, param3=8),
        f.item("NAV_WAYPOINT", 0.0, 0.0, 15.0),
        f.item("NAV_LAND"),
    ]
    f.begin_mission(items)
    start = f.now
    t = f.fly(200.0, lambda: not f.armed)
    reached = arrivals(f, start, (3,))
    for seq in (1, 2, 3, 5, 7, 8):
        f.note(f"AUTO: item {seq} reached", "s", reached.get(seq, float("nan")))
    f.note("AUTO: disarmed", "s", float(t.t[-1]))
    f.note("AUTO: peak speed", "m/s", float(t.speed.max()))
    f.note("AUTO: passes the first corner at", "m", float(t.distance(40.0, 0.0).min()))
    early = t.t < reached.get(3, 0.0)
    f.note("AUTO: slowest at the first corner", "m/s", slowest(t.speed[early & (t.x > 38.0) & (t.y < 20.0)]))
    slow = (t.t > reached.get(3, 0.0) + 3.0) & (t.t < reached.get(5, 0.0) - 3.0)
    f.note("AUTO: speed after DO_CHANGE_SPEED", "m/s", fastest(t.speed[slow]))
    f.note("AUTO: fastest climb of the sloping leg", "m/s", fastest(t.climb[slow]))
    f.note("AUTO: lands off its place", "m", float(t.distance(0.0, 0.0)[-1]))


FLIGHTS = {
    flight.__name__: flight
    for flight in (
        take_off_and_land, positions, velocities, yaws, alt_hold, loiter, poshold, stabilize, acro, brake_and_circle,
        come_home, mission, within_fence,
    )
}  # fmt: skip
