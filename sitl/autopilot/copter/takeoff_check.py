# SPDX-License-Identifier: BSD-3-Clause
"""Take-off check: motors that turn too slowly or too fast keep the vehicle on the ground (TKOFF_RPM_MIN,
TKOFF_RPM_MAX)."""

from __future__ import annotations

from ...core.kernels import law
from ...core.mavlink import MavSeverity
from ..events import Event, emit
from ..state import Sensors
from .parameters.flight_modes import TakeOff
from .state import Vehicle

STALE_US = 1_000_000
"""Older telemetry counts as none."""
WARNING_US = 5_000_000
NO_TELEMETRY, OUT_OF_RANGE = 0, 1
"""Why it is blocked."""
_BLOCKED = {
    NO_TELEMETRY: "Takeoff blocked: waiting for ESC RPM",
    OUT_OF_RANGE: "Takeoff blocked: ESC RPM out of range",
}
TAKEOFF_BLOCKED = Event(41, MavSeverity.CRITICAL, _BLOCKED)


@law
def has_telemetry(sensors: Sensors, motors: int, time_us: int) -> bool:
    """Whether the speed controllers of all motors have reported their speeds lately."""
    return sensors.esc_motors >= motors and time_us - sensors.esc_time_us < STALE_US and sensors.esc_count > 0


@law
def turn_well(sensors: Sensors, motors: int, p: TakeOff) -> bool:
    """Whether all motors turn within TKOFF_RPM_MIN .. TKOFF_RPM_MAX (0: no upper limit)."""
    for k in range(motors):
        rpm = float(sensors.esc_rpm[k])
        if rpm < p.RPM_MIN or (p.RPM_MAX > 0.0 and rpm > p.RPM_MAX):
            return False
    return True


@law
def check(v: Vehicle) -> None:
    """Ten times a second: block the take-off until all motors turn well, once since arming; say why every 5 s."""
    ap = v.autopilot
    motors, p = ap.control.motors, ap.params.TKOFF
    if not ap.arming.armed:
        motors.blocked = p.RPM_MIN > 0.0
        motors.warned_us = v.time_us
        return
    if not motors.blocked:
        return
    reported = has_telemetry(v.sensors, motors.count, v.time_us)
    if p.RPM_MIN <= 0.0 or (reported and turn_well(v.sensors, motors.count, p)):
        motors.blocked = False
    elif v.time_us - motors.warned_us > WARNING_US:
        motors.warned_us = v.time_us
        emit(ap.events, v.time_us, TAKEOFF_BLOCKED, float(OUT_OF_RANGE if reported else NO_TELEMETRY), 0.0)
