# SPDX-License-Identifier: BSD-3-Clause
"""Yaw imbalance: what the yaw rate loop must add all the time to keep the heading shows a weak motor or a bent arm.

It is reported, every ten seconds, and nothing is done (FLIGHT_OPTIONS 2 switches that off). While thrust is lost
nothing is reported: the heading suffers anyway.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.mavlink import MavSeverity
from ..events import Event, emit
from ..notes import Text
from .state import Vehicle

PERIOD = 0.1
"""Between two calls of ``check`` [s]."""
SMOOTHED = PERIOD / (PERIOD + 1.0 / (2.0 * math.pi * 0.05))
"""Share of the low-pass of 0.05 Hz that one call takes up."""
SHARE = 0.75
"""Of ATC_RAT_YAW_IMAX."""
REPORT_INTERVAL_US = 10_000_000
_OFF = 2

YAW_IMBALANCE = Event(64, says=lambda v, a, b: [Text(MavSeverity.EMERGENCY, f"Yaw Imbalance {a * 100.0:.0f}%")])
"""a: the integrator of the yaw rate loop"""


@law
def check(v: Vehicle) -> None:
    """Ten times a second."""
    ap = v.autopilot
    motors, most = ap.control.motors, ap.params.ATC.RAT_YAW.IMAX
    if not ap.arming.armed or ap.arming.landed or motors.boosting:
        motors.yaw_trim = 0.0
        return
    motors.yaw_trim += (abs(ap.control.rate.yaw.integrator) - motors.yaw_trim) * SMOOTHED
    if motors.yaw_trim <= SHARE * most or most <= 0.0 or int(ap.params.FLIGHT_OPTIONS) & _OFF:
        return
    if motors.yaw_trim_reported_us == 0 or v.time_us - motors.yaw_trim_reported_us >= REPORT_INTERVAL_US:
        motors.yaw_trim_reported_us = v.time_us
        emit(ap.events, v.time_us, YAW_IMBALANCE, motors.yaw_trim, 0.0)
