# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle record with parameters and a made-up estimate; no physics, no shell."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sitl.autopilot import home
from sitl.autopilot.copter.control.control_step import init as init_control
from sitl.autopilot.copter.control.frames import load_frame
from sitl.autopilot.copter.modes.decisions import init as init_modes
from sitl.autopilot.copter.parameters import TABLE
from sitl.vehicle.copter import Copter

READY_US = 60_000_000


def make() -> Any:
    """A healthy vehicle, disarmed at home a minute after boot, in STABILIZE."""
    v = Copter()
    ap = v.autopilot
    TABLE.set_defaults(ap.params)
    ap.params.FRAME_CLASS = 1.0
    v.time_us, v.tick = READY_US, READY_US // 2500
    est = ap.estimate
    est.q = est.q.replace(w=1.0)
    est.origin_set, est.origin_lat, est.origin_lon, est.origin_alt = 1, -353632620, 1491652370, 584.0
    est.attitude_ok = est.position_ok = 1
    v.sensors.gps_fix, v.sensors.mag_count, v.sensors.baro_count = 3, 1, 1
    init_modes(v)
    load_frame(ap.control.motors, ap.params)
    init_control(ap.control, ap.estimate, ap.params)
    ap.control.tick = v.tick
    ap.control.attitude.cos_lean = 1.0
    ap.rc.channels[:8] = (1500, 1500, 1000, 1500, 1800, 1000, 1000, 1800)
    ap.rc.receiver_ok = 1
    ap.rc.receiver_us = v.time_us
    home.set_here(v.autopilot.home, v.autopilot.estimate)
    return v


def fly(v: Any, mode: int = 4, height: float = 10.0) -> Any:
    """The same vehicle, armed and hovering."""
    ap = v.autopilot
    ap.arming.armed = ap.arming.auto_armed = 1
    ap.arming.landed = ap.arming.landed_maybe = 0
    ap.estimate.pos = ap.estimate.pos.replace(z=-height)
    ap.control.motors.spool_state = 3
    ap.modes.number = mode
    return v


def wait(v: Any, seconds: float) -> None:
    """Let time pass without running anything."""
    v.time_us += round(seconds * 1e6)


def codes(v: Any) -> list[int]:
    """Event codes so far."""
    ring = v.autopilot.events
    return [int(ring.code[k % 64]) for k in range(int(ring.count))]


def snapshot(v: Any) -> bytes:
    """All bytes of the record."""
    return np.asarray(v).tobytes()


def turn_to(v: Any, yaw: float) -> None:
    """Point the nose, and the target, to a heading [rad]."""
    est, target = v.autopilot.estimate, v.autopilot.control.attitude
    target.target_euler = target.target_euler.replace(yaw=yaw)
    est.euler = est.euler.replace(yaw=yaw)
    est.q = est.q.replace(w=math.cos(yaw / 2), z=math.sin(yaw / 2))
    target.target_q = target.target_q.replace(w=est.q.w, z=est.q.z)


def told(v: Any, event: Any) -> list[tuple[float, float]]:
    """(a, b) of each event of a kind so far."""
    ring = v.autopilot.events
    places = [k % 64 for k in range(int(ring.count))]
    return [(float(ring.a[k]), float(ring.b[k])) for k in places if ring.code[k] == int(event)]
