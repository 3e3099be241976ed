# SPDX-License-Identifier: BSD-3-Clause
"""LANDING_TARGET: what a companion computer sees of a target (PLND_TYPE 1)."""

from __future__ import annotations

from ...autopilot.events import emit
from ...autopilot.landing_target.measurement import take
from ...autopilot.landing_target.state import LANDING_TARGET_DID, LEVEL_SENSOR, REPORTED_FRAME, SAID_NO_FRAME, SENSOR
from ...core.elementary import tan
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.scalars import PI, finite
from ...core.vectors import Vec3
from ...vehicle.landing_beacon import BY_MESSAGE
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive

_SIDEWAYS = 0.5 * PI
"""The angle of what is not before the sensor [rad]."""


class LandingTargetMessage(Message, name="LANDING_TARGET"):
    """Angles [rad], or (``position_valid``) a position [m]; distance [m]."""

    frame: int
    angle_x: float
    angle_y: float
    distance: float
    pos: Vec3 = consecutive("x", "y", "z")
    position_valid: int


@law
def landing_target(m: LandingTargetMessage, v: Vehicle, sender: int) -> None:
    """Note the direction of the target, and its distance where there is one."""
    ap = v.autopilot
    t, p = ap.landing_target, ap.params.PLND
    if p.ENABLED == 0.0 or int(p.TYPE) != BY_MESSAGE:
        return
    if m.frame != MavFrame.BODY_FRD and m.frame != MavFrame.LOCAL_FRD:
        if (t.reported & REPORTED_FRAME) == 0:
            emit(ap.events, v.time_us, LANDING_TARGET_DID, float(SAID_NO_FRAME), 0.0)
        t.reported |= REPORTED_FRAME
        return
    line = m.pos
    if m.position_valid == 0:
        if not (abs(m.angle_x) < _SIDEWAYS and abs(m.angle_y) < _SIDEWAYS):
            return
        line = Vec3(-tan(m.angle_y), tan(m.angle_x), 1.0)
    if finite(line.x + line.y + line.z + m.distance):
        take(t, line, SENSOR if m.frame == MavFrame.BODY_FRD else LEVEL_SENSOR, m.distance, v.time_us)
