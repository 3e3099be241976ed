# SPDX-License-Identifier: BSD-3-Clause
"""The optical flow sensor as the firmware has it (FLOW_*): simulated, or OPTICAL_FLOW messages of a companion."""

from __future__ import annotations

import math

from ..core.algebra import turned
from ..core.border import Sensors
from ..core.kernels import law
from ..core.records import Record
from ..core.vectors import Vec2
from .params.without_gps import Flow

MAVLINK, SIMULATED = 5, 10
"""FLOW_TYPE"""
SILENT_US = 500_000
"""A sensor that says nothing for so long has failed."""


class OpticalFlow(Record):
    """The last sample."""

    kind: int  # FLOW_TYPE at power-on, where there is such a sensor; 0 none
    seen: int  # sample of the simulated sensor that was read last
    count: int  # samples so far
    time_us: int  # when the last one came
    quality: int  # 0 .. 255
    rate: Vec2  # of the ground about the body's x and y axes, body rates included [rad/s]
    body: Vec2  # body rates of the same time [rad/s]


def power_on(flow: OpticalFlow, p: Flow) -> None:
    """FLOW_TYPE chooses the sensor now, and until the next power-on."""
    flow.kind = int(p.TYPE) if int(p.TYPE) in (MAVLINK, SIMULATED) else 0


@law
def is_healthy(flow: OpticalFlow, time_us: int) -> bool:
    """Whether there is a sensor that has said something of late."""
    return flow.kind != 0 and flow.count > 0 and time_us - flow.time_us < SILENT_US


@law
def take(flow: OpticalFlow, rate: Vec2, body: Vec2, quality: int, time_us: int, p: Flow) -> None:
    """Take a sample, scaled and turned as FLOW_FXSCALER, FLOW_FYSCALER and FLOW_ORIENT_YAW say."""
    scaled = Vec2(rate.x * (1.0 + 0.001 * p.FXSCALER), rate.y * (1.0 + 0.001 * p.FYSCALER))
    flow.rate = turned(scaled, math.radians(0.01 * p.ORIENT_YAW))
    flow.body = body
    flow.quality = quality
    flow.time_us = time_us
    flow.count += 1


@law
def read(flow: OpticalFlow, sensors: Sensors, time_us: int, p: Flow) -> None:
    """Take a new sample of the simulated sensor."""
    if flow.kind == SIMULATED and sensors.flow_count != flow.seen:
        flow.seen = sensors.flow_count
        take(flow, sensors.flow_rate, sensors.flow_body, sensors.flow_quality, time_us, p)
