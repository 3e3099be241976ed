# SPDX-License-Identifier: BSD-3-Clause
"""The record of the landing target. NED from the vehicle, or from the origin where it says so."""

from __future__ import annotations

from ...core.mavlink import MavSeverity
from ...core.records import Floats, Record, array
from ...core.vectors import Vec2, Vec3
from ..events import Event

BODY, SENSOR, LEVEL_SENSOR = 0, 1, 2
"""Frames of a line of sight: the body's FRD; that of a sensor that looks down until it is mounted (``orientation``);
the same, held level."""

NEVER_SEEN, OUT_OF_RANGE, LOST, FOUND = 0, 1, 2, 3
"""Status."""

# What LANDING_TARGET_DID says
SAID_FOUND, SAID_READY, SAID_FAILED, SAID_LOST, SAID_RETRY, SAID_RETRIED, SAID_FAILSAFE = range(7)
SAID_NO_BEACON, SAID_NO_FRAME = 7, 8
_TEXTS: dict[int, str | tuple[int, str]] = {
    SAID_FOUND: "PrecLand: Target Found",
    SAID_READY: "PrecLand: Init Complete",
    SAID_FAILED: (MavSeverity.CRITICAL, "PrecLand: Init Failed"),
    SAID_LOST: (MavSeverity.CRITICAL, "PrecLand: Target Lost"),
    SAID_RETRY: "PrecLand: Retrying",
    SAID_RETRIED: "PrecLand: Retry Completed",
    SAID_FAILSAFE: "PrecLand: Failsafe Measures",
    SAID_NO_BEACON: "Set SIM_PLD_LAT, SIM_PLD_LON and SIM_PLD_ALT",
    SAID_NO_FRAME: "Plnd: Frame not supported",
}
LANDING_TARGET_DID = Event(61, MavSeverity.INFO, _TEXTS)

REPORTED_BEACON, REPORTED_FRAME = 1, 2
"""Bits of what is said once."""


class LandingTarget(Record):
    """What is known of the target."""

    # the last measurement
    line: Vec3  # unit vector to the target
    frame: int  # of it
    distance: float  # [m]; 0 unknown
    line_us: int  # when it came; 0 never
    used_us: int  # ``line_us`` of the last one that gave a position
    measured_pos: Vec3  # that position [m]
    sees: bool  # the sensor is well, and a beacon in its view
    reported: int  # TOLD_BEACON, TOLD_FRAME
    # the estimate, as of PLND_LAG ago
    running: bool  # measurements come
    since_us: int  # when the first of them did
    update_us: int  # when the last one was taken in
    outliers: int  # left out since then
    pos: Vec2  # [m]
    vel: Vec2  # [m/s]
    covariance: Floats = array(2, 3)  # north, east: of the position, of both, of the velocity
    # as of now
    acquired: bool  # good for landing
    away: Vec2  # the position to land at [m]
    closing: Vec2  # its velocity [m/s]
    status: int  # NEVER_SEEN, ...
    lost_us: int  # when it was lost
    last_pos: Vec3  # where it was last measured, from the origin [m]
    seen_from: Vec3  # where the vehicle was then [m]
