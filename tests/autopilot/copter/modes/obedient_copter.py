# SPDX-License-Identifier: BSD-3-Clause
"""A copter whose body does at once what its controllers ask: modes fly in plain Python, without physics."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.modes.mode_list import MODES
from sitl.core.algebra import euler_of, quat_from_euler
from sitl.core.vectors import Euler, Vec3
from tests.autopilot.copter.steady_copter import fly, make

MODE = {mode.name: mode for mode in MODES}
STICKS_MIDDLE = 1500
TICK_US = 2500


def hovering(name: str, height: float = 10.0, direct: bool = True) -> Any:
    """A vehicle that hovers in a mode, with its motors at full power.

    ``direct``: attitudes are given outright (ATC_RATE_FF_ENAB 0), so that one tick shows the lean that a mode asks for.
    """
    v = fly(make(), MODE[name].number, height)
    motors, attitude = v.autopilot.control.motors, v.autopilot.control.attitude
    motors.thrust_max, motors.desired_spool = 1.0, DesiredSpoolState.THROTTLE_UNLIMITED
    attitude.lean_max, attitude.cos_lean, attitude.throttle_in = 1.2, 1.0, v.autopilot.params.MOT.THST_HOVER
    attitude.target_q = v.autopilot.estimate.q
    v.autopilot.params.ATC.RATE_FF_ENAB = 0.0 if direct else 1.0
    throttle(v, 0.5)
    return v


def standing(name: str, spool: int = SpoolState.GROUND_IDLE, direct: bool = True) -> Any:
    """A vehicle that stands armed on the ground in a mode; ``spool``: what its motors do."""
    v = hovering(name, 0.0, direct)
    arming = v.autopilot.arming
    arming.auto_armed = arming.landed = arming.landed_maybe = 1
    v.autopilot.control.motors.spool_state = spool
    v.autopilot.control.attitude.throttle_in = 0.0
    return v


def throttle(v: Any, stick: float) -> None:
    """The throttle stick, 0 .. 1."""
    sticks = v.autopilot.modes.pilot
    sticks.throttle = sticks.throttle_filtered = stick
    sticks.throttle_zero = int(stick == 0.0)
    v.autopilot.rc.channels[2] = round(1000 + 1000 * stick)


def turn_body(v: Any, roll: float, pitch: float, yaw: float) -> None:
    """An attitude [rad], and the target there."""
    est = v.autopilot.estimate
    est.q = quat_from_euler(Euler(roll, pitch, yaw))
    est.euler = euler_of(est.q)
    v.autopilot.control.attitude.target_q = est.q


def move(v: Any, north: float, east: float, down: float) -> None:
    """A velocity [m/s]."""
    v.autopilot.estimate.vel = Vec3(north, east, down)


def ticks(v: Any, run: Callable[[Any], Any], count: int = 1) -> Any:
    """Ticks of a mode's law; after each, the body is where and as the controllers want it; what the last returned."""
    ap, result = v.autopilot, None
    for _ in range(count):
        v.time_us += TICK_US
        v.tick += 1
        ap.control.tick += 1
        result = run(v)
        obey(v)
    return result


def obey(v: Any) -> None:
    """The body follows the paths of the position controllers and the target of the attitude controller."""
    control, est = v.autopilot.control, v.autopilot.estimate
    ne, d = control.pos_ne, control.pos_d
    if ne.last_tick == control.tick:
        est.pos = est.pos.replace(x=ne.pos_desired.x, y=ne.pos_desired.y)
        est.vel = est.vel.replace(x=ne.vel_desired.x, y=ne.vel_desired.y)
    if d.last_tick == control.tick:
        est.pos, est.vel = est.pos.replace(z=d.pos_desired), est.vel.replace(z=d.vel_desired)
    est.q = control.attitude.target_q
    est.euler = euler_of(est.q)
