# SPDX-License-Identifier: BSD-3-Clause
"""Where the rover is going: NAV_CONTROLLER_OUTPUT, POSITION_TARGET_GLOBAL_INT."""

from __future__ import annotations

from ...autopilot.rover.modes.guided import GUIDED, HEADING_AND_SPEED
from ...autopilot.rover.modes.mode import END_OF_PATH, NO_DESTINATION
from ...autopilot.rover.modes.mode_list import destination, is_autonomous
from ...core.elementary import atan2, hypot
from ...core.geodesy import add_offset
from ...core.kernels import law
from ...vehicle.rover import Rover
from ..telemetry.own import NavControllerOutput, PositionTargetGlobalInt
from ..telemetry.units import DEG, boot_ms, int16, int32, uint16

POSITION_ALONE = 0xFDF8
"""type_mask of a location alone, as ArduRover sends it."""


@law
def nav_controller_output(m: NavControllerOutput, v: Rover) -> bool:
    """NAV_CONTROLLER_OUTPUT: bearings [deg], distance and cross-track error [m]; nothing in the pilot's modes.

    As in ArduRover, ``nav_bearing`` is 0 on the way to locations: what steers there is a turn rate.
    """
    modes, pos = v.autopilot.modes, v.autopilot.estimate.pos
    if not is_autonomous(modes.number):
        return False
    to = destination(modes.number, modes)
    if to.kind != NO_DESTINATION:
        m.wp_dist = uint16(hypot(to.position.x - pos.x, to.position.y - pos.y))
        m.target_bearing = int16(atan2(to.position.y - pos.y, to.position.x - pos.x) * DEG)
    elif modes.number == GUIDED and modes.guided.submode == HEADING_AND_SPEED and modes.guided.has_target:
        m.nav_bearing = int16(modes.guided.heading * DEG)
    if to.kind == END_OF_PATH:
        m.xtrack_error = modes.nav.drive.crosstrack
    return True


@law
def position_target_global(m: PositionTargetGlobalInt, v: Rover) -> bool:
    """POSITION_TARGET_GLOBAL_INT: where it drives to (degE7, m above sea level); nothing when it drives to no
    location."""
    estimate = v.autopilot.estimate
    to = destination(v.autopilot.modes.number, v.autopilot.modes)
    if to.kind == NO_DESTINATION or not estimate.origin_set:
        return False
    location = add_offset(estimate.origin_lat, estimate.origin_lon, to.position.x, to.position.y)
    m.time_boot_ms = boot_ms(v.time_us)
    m.lat_int = int32(location.lat)
    m.lon_int = int32(location.lon)
    m.alt = estimate.origin_alt
    m.type_mask = POSITION_ALONE
    return True


MESSAGES = (nav_controller_output, position_target_global)
