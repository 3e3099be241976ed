# SPDX-License-Identifier: BSD-3-Clause
"""What all firmwares keep is put elsewhere with the vehicle: estimate, home, the legs under way."""

from __future__ import annotations

import math

from ..core.algebra import vector_at
from ..core.displacement import Displacement, faster, moved, on_the_ground, turned
from ..core.geodesy import add_offset
from ..core.kernels import law
from .avoidance import objects
from .control.pid import Pid
from .estimation.displaced_filter import move_ekf, move_estimate
from .landing_target.estimator import forget
from .navigation.path import set_position
from .navigation.state import Leg, Nav
from .smart_rtl_path import point, set_point
from .state import Autopilot, Estimate, HomeState, PathState


@law
def _nearest(x: float) -> int:
    return math.floor(x + 0.5)


@law
def move_home(home: HomeState, e: Estimate, d: Displacement) -> None:
    """Home, on the ground; the origin of the estimate has been moved."""
    if not home.is_set:
        return
    home.pos = moved(on_the_ground(d), home.pos)
    location = add_offset(e.origin_lat, e.origin_lon, home.pos.x, home.pos.y)
    home.lat, home.lon = _nearest(location.lat), _nearest(location.lon)


@law
def move_leg(leg: Leg, d: Displacement) -> None:
    """A planned leg."""
    leg.origin, leg.unit = moved(d, leg.origin), turned(d, leg.unit)


@law
def move_nav(nav: Nav, d: Displacement) -> None:
    """The command under way and its legs."""
    nav.target = moved(d, nav.target)
    move_leg(nav.previous, d)
    move_leg(nav.current, d)
    move_leg(nav.next, d)
    nav.pos, nav.vel, nav.acc = moved(d, nav.pos), faster(d, nav.vel), turned(d, nav.acc)
    for k in range(nav.detour.left):
        set_position(nav.detour, k, moved(d, vector_at(nav.detour.waypoints, 3 * k)))
    nav.detour.bent_target = moved(d, nav.detour.bent_target)
    nav.request, nav.request_next = moved(d, nav.request), moved(d, nav.request_next)


@law
def move_path(path: PathState, d: Displacement) -> None:
    """The way back of SMART_RTL; its heights stay, as home's does."""
    for k in range(path.points):
        set_point(path, k, moved(on_the_ground(d), point(path, k)))


@law
def add_to_target(pid: Pid, change: float) -> None:
    """The loop's target and its measurement have changed alike."""
    pid.target += change


@law
def move_autopilot(ap: Autopilot, d: Displacement) -> None:
    """Put what all firmwares share elsewhere; the origin of the estimate has been moved."""
    if not ap.ekf.use_external:
        move_ekf(ap.ekf, d)
    if ap.second_lane.runs != 0:
        move_ekf(ap.second_lane.ekf, d)
        move_estimate(ap.second_lane.estimate, d)
    move_estimate(ap.estimate, d)
    ap.yaw_bank.runs = False
    acc = ap.inertial_filter.acc
    acc.first, acc.second = turned(d, acc.first), turned(d, acc.second)
    move_home(ap.home, ap.estimate, d)
    move_nav(ap.modes.nav, d)
    ap.avoid.limited_us = 0
    objects.forget(ap.objects)
    forget(ap.landing_target)
    ap.modes.follow.is_known, ap.modes.follow.update_us = False, 0  # reports count from where the origin was
