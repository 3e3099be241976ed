# SPDX-License-Identifier: BSD-3-Clause
"""A rover autopilot's record without modes, and ArduPilot's SITL rover to drive with it, in plain Python.

The model: forward acceleration 10 (20 throttle - v) / 20 m/s^2; turning-circle diameter at full lock 1.8 m,
d = 1.8 sin 35 deg / sin(35 deg steering); no slip, no lag. The estimate is the truth.
"""

from __future__ import annotations

import math
from typing import Any

from sitl.autopilot.rover.control import control_step, forward_speed
from sitl.autopilot.rover.control.state import DT, PERIOD_US, Control, SpeedState
from sitl.autopilot.rover.parameters import TABLE, Parameters
from sitl.autopilot.state import Autopilot
from sitl.core.border import Actuators, Sensors
from sitl.core.records import Record


class CarAutopilot(Autopilot):
    """A firmware without modes."""

    params: Parameters
    control: Control


class CarRecord(Record):
    """A vehicle without physics."""

    time_us: int
    sensors: Sensors
    actuators: Actuators
    autopilot: CarAutopilot


HORIZONTAL = 1 | 2 | 8 | 16  # EKF_STATUS_FLAGS: attitude, velocity, position
STEPS = 24  # of physics in a period: 1200 Hz, as recorded
RECORDED = {
    "CRUISE_SPEED": 5.0,
    "CRUISE_THROTTLE": 30.0,
    "ATC_STR_RAT_FF": 0.75,
    "ATC_SPEED_P": 0.1,
    "SERVO1_MIN": 1000.0,
    "SERVO1_MAX": 2000.0,
    "SERVO3_MIN": 1000.0,
    "SERVO3_MAX": 2000.0,
}
"""Settings of the recorded drives (ArduPilot's autotest)."""


def make_vehicle(**params: float) -> Any:
    """One vehicle's view: at the origin, facing north, estimate valid, disarmed; ``params`` over the defaults."""
    v = CarRecord()
    TABLE.set_defaults(v.autopilot.params)
    for name, value in params.items():
        setattr(v.autopilot.params, name, value)
    v.autopilot.estimate.status_flags = HORIZONTAL
    v.autopilot.estimate.position_ok = 1
    set_motion(v, 0.0, 0.0, 0.0)
    control_step.init(v.autopilot.control, v.autopilot.params)
    return v


def arm(v: Any) -> Any:
    """The same vehicle, armed, one period later."""
    v.autopilot.arming.armed = 1
    finish(v)
    return v


def sense(v: Any) -> SpeedState:
    """What a period begins with; the record of the speed along the nose."""
    s: SpeedState = v.autopilot.control.speed
    forward_speed.sense(s, v.autopilot.estimate, v.sensors, v.time_us)
    return s


def set_motion(v: Any, heading: float, speed: float, turn_rate: float) -> None:
    """What the estimate says of a level car."""
    est = v.autopilot.estimate
    est.euler = (0.0, 0.0, heading)
    est.q = (math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2))
    est.vel = (speed * math.cos(heading), speed * math.sin(heading), 0.0)
    est.rates = (0.0, 0.0, turn_rate)


def finish(v: Any) -> None:
    """The end of a period, after the mode: ``control.control_step``, with the speed that was sensed at its start; time
    goes on."""
    sense(v)
    control_step.update([v], 0)
    v.time_us += PERIOD_US


class Car:
    """The vehicle's body: drives by ``actuators``, writes the estimate."""

    def __init__(self, v: Any, heading: float = 0.0, speed: float = 0.0) -> None:
        self.v = v
        self.heading, self.speed = heading, speed
        set_motion(v, heading, speed, 0.0)

    @property
    def position(self) -> tuple[float, float]:
        """North and east of the start [m]."""
        return float(self.v.autopilot.estimate.pos[0]), float(self.v.autopilot.estimate.pos[1])

    def move(self) -> None:
        """One period, after its control."""
        est = self.v.autopilot.estimate
        steering, throttle = float(self.v.actuators.controls[0]), float(self.v.actuators.controls[2])
        curvature = 2.0 * math.sin(math.radians(35.0) * steering) / (1.8 * math.sin(math.radians(35.0)))
        dt = DT / STEPS
        for _ in range(STEPS):
            rate = curvature * self.speed
            self.heading += rate * dt
            self.speed += 10.0 * (20.0 * throttle - self.speed) / 20.0 * dt
            est.pos = est.pos.replace(x=est.pos.x + self.speed * math.cos(self.heading) * dt)
            est.pos = est.pos.replace(y=est.pos.y + self.speed * math.sin(self.heading) * dt)
        set_motion(self.v, self.heading, self.speed, curvature * self.speed)
