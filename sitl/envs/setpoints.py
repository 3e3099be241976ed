# SPDX-License-Identifier: BSD-3-Clause
"""Kinds of set-points: names and units of the numbers that an action gives to a robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Setpoint:
    """A kind of set-point; one set-point is a row of numbers."""

    name: str
    columns: tuple[str, ...]
    """Name and unit of each number."""

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)


DRIVE = Setpoint("drive", ("forward [m/s]", "turn [rad/s]"))
"""Speeds of a robot without autopilot; turn is counter-clockwise seen from above."""
RC_OVERRIDE = Setpoint("rc", tuple(f"channel {k} [us]" for k in range(1, 9)))
"""RC_CHANNELS_OVERRIDE; 0 releases a channel."""
VELOCITY = Setpoint("velocity", ("forward [m/s]", "left [m/s]", "up [m/s]", "turn [rad/s]"))
"""SET_POSITION_TARGET_LOCAL_NED, velocities along the body's heading; turn counter-clockwise."""
POSITION = Setpoint("position", ("x [m]", "y [m]", "z [m]", "yaw [rad]"))
"""SET_POSITION_TARGET_LOCAL_NED, a place in the frame of world files."""
ATTITUDE = Setpoint("attitude", ("roll [rad]", "pitch [rad]", "turn [rad/s]", "climb or throttle [-1, 1]"))
"""SET_ATTITUDE_TARGET; roll to the right, pitch up, turn counter-clockwise."""

SETPOINTS = {kind.name: kind for kind in (DRIVE, RC_OVERRIDE, VELOCITY, POSITION, ATTITUDE)}
