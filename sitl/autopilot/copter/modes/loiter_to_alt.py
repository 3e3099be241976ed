# SPDX-License-Identifier: BSD-3-Clause
"""AUTO's LOITER_TO_ALT: to the position, then up or down to its height, where the sticks may move it as in a
landing."""

from __future__ import annotations

from ....core.algebra import ZERO2
from ....core.kernels import law
from ....core.scalars import constrain
from ...control.shaping import sqrt_controller
from ...navigation.path import distance
from ..control import altitude, position
from ..control.spool import DesiredSpoolState
from ..control.state import DT
from ..navigation import waypoint
from ..state import Vehicle
from . import descent, ground

_NEAR = 0.05
"""So near to its height it is there [m]."""


@law
def run(v: Vehicle) -> bool:
    """One tick; whether the height is reached."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    nav = modes.nav
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return False
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if nav.since_us == 0 and distance(nav, est.pos) > waypoint.CM * p.WPNAV.RADIUS:
        waypoint.advance(nav, control, est, p, v.time_us)
        ground.fly(modes.auto_yaw, control, est, p)
        return False
    error = nav.target.z - est.pos.z
    if nav.since_us == 0:
        nav.since_us = v.time_us
        nav.height_error = error
    done = abs(error) < _NEAR or error * nav.height_error < 0.0
    nav.height_error = error
    limits = control.pos_d
    wanted = sqrt_controller(error, p.PSC.POSZ_P, limits.accel_max, DT)
    altitude.input_vel_accel_d(limits, constrain(wanted, -limits.speed_up, limits.speed_down), 0.0)
    position.input_vel_accel_ne(control.pos_ne, descent.stick_velocity(modes.pilot, est.yaw, p), ZERO2)
    ground.fly(modes.auto_yaw, control, est, p)
    return done
