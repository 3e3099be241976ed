# SPDX-License-Identifier: BSD-3-Clause
"""The estimator's events; ``a`` is the IMU of the filter, ``b`` the compass where there is one."""

from __future__ import annotations

from typing import Any

from ...core.mavlink import MavSeverity
from ..events import Event, ev
from ..log_events import LogEvent
from ..notes import Text

BY_FLOW, BY_OTHERS, YAW_BY_OTHERS = 1.0, 2.0, 3.0
"""What a filter uses from now on (EKF_USES)."""
_SOURCES = {BY_FLOW: "fusing optical flow", BY_OTHERS: "is using external nav data", YAW_BY_OTHERS: "yaw aligned"}


def _initialised(v: Any, a: float, b: float) -> list[Text]:
    return [Text(MavSeverity.INFO, f"EKF3 IMU{a:.0f} initialised"), Text(MavSeverity.INFO, "AHRS: EKF3 active")]


def _origin(v: Any, a: float, b: float) -> list[Text]:
    altitude = float(v.autopilot.estimate.origin_alt)
    return [
        Text(MavSeverity.INFO, f"EKF3 IMU{a:.0f} origin set"),
        Text(MavSeverity.INFO, f"Field Elevation Set: {altitude:.0f}m"),
    ]


def _switched(v: Any, a: float, b: float) -> list[Text]:
    return [
        Text(MavSeverity.CRITICAL, f"EKF3 lane switch {a:.0f}"),
        Text(MavSeverity.WARNING, f"EKF primary changed:{a:.0f}"),
    ]


def _source(v: Any, a: float, b: float) -> list[Text]:
    said, ekf = [Text(MavSeverity.INFO, f"EKF3 IMU{int(a)} {_SOURCES[b]}")], v.autopilot.ekf
    if b == BY_OTHERS:
        for name, unit, (north, east, down) in (("pos", "m", ekf.pos), ("vel", "m/s", ekf.vel)):
            position = f"{north:.1f},{east:.1f},{down:.1f} ({unit})"
            said.append(Text(MavSeverity.INFO, f"EKF3 IMU{int(a)} initial {name} NED = {position}"))
    return said


EKF_INITIALISED = Event(10, says=_initialised)
EKF_TILT_ALIGNED = Event(11, MavSeverity.INFO, "EKF3 IMU{a:.0f} tilt alignment complete")
EKF_YAW_ALIGNED = Event(12, MavSeverity.INFO, "EKF3 IMU{a:.0f} MAG{b:.0f} initial yaw alignment complete")
EKF_ORIGIN_SET = Event(13, says=_origin)
EKF_USES_GPS = Event(14, MavSeverity.INFO, "EKF3 IMU{a:.0f} is using GPS")
EKF_STOPPED_GPS = Event(15, MavSeverity.WARNING, "EKF3 IMU{a:.0f} stopped aiding", log=ev(LogEvent.LOST_GPS))
EKF_YAW_ALIGNED_IN_FLIGHT = Event(16, MavSeverity.INFO, "EKF3 IMU{a:.0f} MAG{b:.0f} in-flight yaw alignment complete")
EKF_RELATIVE = Event(
    65, MavSeverity.INFO, "EKF3 IMU{a:.0f} started relative aiding"
)  # its position is one from where it began
EKF_STOPPED_AIDING = Event(66, MavSeverity.WARNING, "EKF3 IMU{a:.0f} stopped aiding")
EKF_USES = Event(67, says=_source)  # b: what
EKF_LANE_SWITCHED = Event(68, says=_switched)  # a: IMU whose filter is flown by now
EKF_COMPASS_CHANGED = Event(69, MavSeverity.INFO, "EKF3 IMU{a:.0f} switching to compass {b:.0f}")
EKF_EMERGENCY_YAW = Event(76, MavSeverity.WARNING, "EKF3 IMU{a:.0f} emergency yaw reset")
