# SPDX-License-Identifier: BSD-3-Clause
"""The record of the ground's heights: one square of a grid, around the vehicle; the grid is in the shell
(``bridge.services.terrain_protocol``).
"""

from __future__ import annotations

from ...core.mavlink import MavSeverity
from ...core.records import Float32, Floats, Int32, Record, array
from ..events import Event

# What TERRAIN_DID says
FAILSAFE, RTL_BEGINS_ANEW, RTL_WITHOUT = 1, 2, 3
_TEXTS = {
    FAILSAFE: "Failsafe: Terrain data missing",
    RTL_BEGINS_ANEW: "Restarting RTL - Terrain data missing",
    RTL_WITHOUT: "RTL: no terrain data, using alt-above-home",
}
TERRAIN_DID = Event(70, MavSeverity.CRITICAL, _TEXTS)


class Terrain(Record):
    """What is known of the ground. Heights are above mean sea level."""

    asked: bool  # somebody is asked for heights: without heights nothing is known. Else the ground is flat, at home's
    has_square: bool  # the vehicle is in the square below, as far as it has looked
    is_known: bool  # the heights of its corners are known
    was_known: bool  # heights have been known, and that at home: ``difference`` is good
    shapes: bool  # the simulated ground follows the heights (SIM_TERRAIN)
    spacing: Int32  # of the grid [m]
    north: float  # south-west corner of the square, from the origin [m]
    east: float
    corners: Floats = array(4, stored="f4")  # heights: south-west, south-east, north-west, north-east [m]
    home: Float32  # height at home [m]
    difference: Float32  # of the ground below to that at home, as it was known last [m]
    offset: Float32  # home was so much higher than the ground there, when it was armed [m]
    start: Float32  # height where the simulation began [m]
    pending: Int32  # parts of the grid that are missing
    loaded: Int32  # parts that are known
    missing_us: int  # since when a height was needed and not known
    missed_us: int  # when that was last so; 0 not
