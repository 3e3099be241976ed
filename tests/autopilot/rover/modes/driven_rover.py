# SPDX-License-Identifier: BSD-3-Clause
"""A whole rover autopilot in plain Python, on a point that drives as ArduPilot's SITL rover; the estimate is the truth.

The model: forward acceleration 10 (20 throttle - v) / 20 m/s^2; turning-circle diameter at full lock 1.8 m,
d = 1.8 sin 35 deg / sin(35 deg steering); no slip, no lag.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

from sitl.autopilot.events import EVENT_RING
from sitl.autopilot.notes import ChecksFailed, Text
from sitl.autopilot.rover import arming
from sitl.autopilot.rover.control import control_step as control
from sitl.autopilot.rover.control.state import DT, PERIOD_US
from sitl.autopilot.rover.event_list import EVENTS
from sitl.autopilot.rover.firmware import power_on
from sitl.autopilot.rover.modes import decisions as modes
from sitl.autopilot.rover.modes import guided_setpoints
from sitl.autopilot.rover.navigation.planner import PLANNER
from sitl.autopilot.rover.parameters import TABLE
from sitl.autopilot.rover.state import Autopilot
from sitl.bridge.rover.autopilot import RoverAutopilot
from sitl.core.border import Actuators, Sensors
from sitl.core.records import Record
from sitl.core.vectors import Vec2


class DrivenRover(Record):
    """A rover without physics."""

    time_us: int
    tick: int
    sensors: Sensors
    actuators: Actuators
    autopilot: Autopilot


HORIZONTAL = 1 | 2 | 8 | 16  # EKF_STATUS_FLAGS: attitude, velocity, position
RECORDED = {
    "CRUISE_SPEED": 5.0,
    "CRUISE_THROTTLE": 30.0,
    "WP_SPEED": 5.0,
    "WP_RADIUS": 3.0,
    "ATC_STR_RAT_FF": 0.75,
    "ATC_SPEED_P": 0.1,
    "SERVO1_MIN": 1000.0,
    "SERVO1_MAX": 2000.0,
    "SERVO3_MIN": 1000.0,
    "SERVO3_MAX": 2000.0,
    "RC1_MIN": 1000.0,
    "RC1_MAX": 2000.0,
    "RC3_MIN": 1000.0,
    "RC3_MAX": 2000.0,
    "BATT_MONITOR": 4.0,
    "MODE3": 11.0,
    "MODE4": 10.0,
}
"""Settings of the recorded drives (ArduPilot's autotest)."""
BOOTED_US = 60_000_000


class Rover:
    """One vehicle: its record ``v``, and what happens to it."""

    def __init__(self, **params: float) -> None:
        self.v: Any = DrivenRover()
        self.ap: Any = self.v.autopilot
        TABLE.set_defaults(self.ap.params)
        for name, value in {**RECORDED, **params}.items():
            setattr(self.ap.params, name, value)
        power_on(self.v)
        self.v.time_us = BOOTED_US
        self.v.tick = BOOTED_US // 2500
        self.v.sensors.gps_fix = 3
        self.v.sensors.baro_count = self.v.sensors.mag_count = 1
        self.v.sensors.battery_voltage = 12.6
        self.heading = self.speed = 0.0
        self.heard = 0
        self.set_estimate(True)
        self.run(0.5)
        self.events()

    def set_estimate(self, good: bool) -> None:
        """Whether there is a position and a velocity."""
        est = self.ap.estimate
        est.origin_set = 1
        est.attitude_ok = 1
        est.position_ok = 1 if good else 0
        est.status_flags = HORIZONTAL if good else 1
        self.v.sensors.gps_fix = 3 if good else 1

    @property
    def position(self) -> tuple[float, float]:
        """North and east of the origin [m]."""
        return float(self.ap.estimate.pos[0]), float(self.ap.estimate.pos[1])

    def place(self, n: float, e: float, heading: float = 0.0, speed: float = 0.0) -> None:
        """Put the vehicle somewhere."""
        self.ap.estimate.pos = (n, e, 0.0)
        self.heading, self.speed = heading, speed
        self._sense(0.0)

    def sticks(self, steering: int | None = None, throttle: int | None = None, mode: int | None = None) -> None:
        """Pulses [us] of the ground station's overrides, renewed for ever."""
        self.ap.params.RC_OVERRIDE_TIME = -1.0
        for channel, pulse in ((0, steering), (2, throttle), (7, mode)):
            if pulse is not None:
                self.ap.rc.override[channel] = pulse

    def arm(self) -> Rover:
        """Arm by MAVLink."""
        assert arming.arm(self.v, 1, False) == (True, [])
        return self

    def run(self, seconds: float) -> Rover:
        """Drive on."""
        for _ in range(round(seconds / DT)):
            self.step()
        return self

    def step(self) -> None:
        """One period of modes and control, then of the body; legs that were asked for are there in the next."""
        modes.update([self.v], 0)
        control.update([self.v], 0)
        PLANNER.serve(self.ap, int(self.v.time_us))
        self._move()
        self.v.time_us += PERIOD_US
        self.v.tick += 8

    def _move(self) -> None:
        est = self.ap.estimate
        steering, throttle = float(self.v.actuators.controls[0]), float(self.v.actuators.controls[2])
        curvature = 2.0 * math.sin(math.radians(35.0) * steering) / (1.8 * math.sin(math.radians(35.0)))
        dt = DT / 8
        for _ in range(8):
            self.heading += curvature * self.speed * dt
            self.speed += 10.0 * (20.0 * throttle - self.speed) / 20.0 * dt
            est.pos = est.pos.replace(x=est.pos.x + self.speed * math.cos(self.heading) * dt)
            est.pos = est.pos.replace(y=est.pos.y + self.speed * math.sin(self.heading) * dt)
        self._sense(curvature * self.speed)

    def _sense(self, turn_rate: float) -> None:
        est = self.ap.estimate
        est.euler = (0.0, 0.0, math.remainder(self.heading, 2.0 * math.pi))
        est.q = (math.cos(self.heading / 2), 0.0, 0.0, math.sin(self.heading / 2))
        est.vel = (self.speed * math.cos(self.heading), self.speed * math.sin(self.heading), 0.0)
        est.rates = (0.0, 0.0, turn_rate)

    def events(self) -> list[tuple[int, float, float]]:
        """(code, a, b) of what happened since the last call."""
        ring = self.ap.events
        found = []
        for k in range(self.heard, int(ring.count)):
            at = k % EVENT_RING
            found.append((int(ring.code[at]), float(ring.a[at]), float(ring.b[at])))
        self.heard = int(ring.count)
        return found

    def texts(self) -> list[str]:
        """What was said since the last call."""
        pilot = RoverAutopilot.__new__(RoverAutopilot)  # it has no shell: why it is not armed takes the record only
        pilot._v = self.v
        pilot._vehicle = SimpleNamespace(parameters={"AHRS_GPS_USE": 1.0})  # type: ignore[assignment]
        said: list[str] = []
        for code, a, b in self.events():
            for note in EVENTS[code].notes(self.v, a, b):
                if isinstance(note, Text):
                    said.append(note.text)
                elif isinstance(note, ChecksFailed):
                    said += pilot.refusal_texts(note.failed)
        return said


def set_velocity(v: Any, north: float, east: float) -> int:
    """A velocity [m/s] as the bridge gives it to GUIDED: its direction is the heading, its length the speed."""
    speed = min(math.hypot(north, east), float(v.autopilot.params.WP_SPEED))
    return int(guided_setpoints.set_heading_and_speed(v.autopilot.modes, v.time_us, math.atan2(east, north), speed))


def set_heading(v: Any, heading: float, speed: float) -> int:
    """A heading [rad] and a speed [m/s] for GUIDED."""
    return guided_setpoints.set_heading_and_speed(v.autopilot.modes, v.time_us, heading, speed)


def set_turn_rate(v: Any, rate: float, speed: float) -> int:
    """A turn rate [rad/s] and a speed [m/s] for GUIDED."""
    return guided_setpoints.set_turn_rate_and_speed(v.autopilot.modes, v.time_us, rate, speed)


def drive_to(v: Any, north: float, east: float) -> int:
    """A position [m] for GUIDED."""
    return guided_setpoints.set_position(v, Vec2(north, east))
