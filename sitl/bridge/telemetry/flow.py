# SPDX-License-Identifier: BSD-3-Clause
"""OPTICAL_FLOW: what the sensor shows, and what a companion reports (FLOW_TYPE 5)."""

from __future__ import annotations

from ...autopilot.estimation.flow import knows_height
from ...autopilot.optical_flow import MAVLINK, is_healthy, take
from ...core.kernels import law
from ...core.scalars import finite
from ...core.vectors import Vec2
from ...vehicle.record import Vehicle
from ..wire.message import Message

UNKNOWN_DISTANCE = -1.0


class OpticalFlow(Message, name="OPTICAL_FLOW"):
    time_usec: int
    flow_x: int
    flow_y: int
    flow_comp_m_x: float
    flow_comp_m_y: float
    ground_distance: float
    quality: int
    flow_rate_x: float
    flow_rate_y: float


@law
def optical_flow(m: OpticalFlow, v: Vehicle) -> bool:
    """OPTICAL_FLOW: rates of the ground about the body's x and y axes, without (comp_m) and with body rates [rad/s],
    and the height over the ground [m], -1 unknown; nothing without a healthy sensor.
    """
    flow, ekf = v.autopilot.flow, v.autopilot.ekf
    shown = flow.rate - flow.body
    m.time_usec = flow.time_us
    m.flow_comp_m_x, m.flow_comp_m_y = shown.x, shown.y
    m.flow_rate_x, m.flow_rate_y = flow.rate.x, flow.rate.y
    m.quality = flow.quality
    m.ground_distance = ekf.terrain_d - ekf.pos.z if knows_height(ekf) else UNKNOWN_DISTANCE
    return is_healthy(flow, v.time_us)


@law
def take_flow(m: OpticalFlow, v: Vehicle, sender: int) -> None:
    """OPTICAL_FLOW of a companion; the body's rates are the gyro's.

    flow_x and flow_y times the time since the last message count as rad/s, as in ArduPilot; both 0: flow_rate_x, _y.
    """
    ap = v.autopilot
    if ap.flow.kind == MAVLINK and finite(m.flow_rate_x) and finite(m.flow_rate_y):
        period, rates = 1e-6 * (v.time_us - ap.flow.time_us), ap.estimate.rates
        counts = m.flow_x != 0 or m.flow_y != 0
        rate = Vec2(m.flow_x * period, m.flow_y * period) if counts else Vec2(m.flow_rate_x, m.flow_rate_y)
        take(ap.flow, rate, Vec2(rates.x, rates.y), m.quality, v.time_us, ap.params.FLOW)


MESSAGES = (optical_flow,)
