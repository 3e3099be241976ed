# SPDX-License-Identifier: BSD-3-Clause
"""Flight at heights above the ground: what the ground below is taken from, and how a path follows it.

A path over the ground (``nav.over_ground``) is planned as over a plain; ``nav.ground_d``, which is added to its
heights, follows the ground within the limits of climbs and descents.
"""

from __future__ import annotations

from ...core.kernels import law
from ..control.shaping import Motion, shape_pos_vel_accel
from ..terrain.ground import Ground, by_grid, by_range, note_missing
from .control.altitude import shaping_limits_d
from .control.state import DT, AltitudeState
from .navigation.state import CopterNav
from .state import Vehicle


@law
def has_range(v: Vehicle) -> bool:
    """Whether heights above the ground are by a range-finder (WPNAV_RFND_USE)."""
    return v.sensors.rangefinder_count > 0 and v.autopilot.params.WPNAV.RFND_USE > 0.0


@law
def ground_below(v: Vehicle) -> Ground:
    """The ground below the vehicle."""
    ap = v.autopilot
    if has_range(v):
        return by_range(float(v.sensors.rangefinder_range[0]), ap.control.attitude.cos_lean, ap.estimate.pos.z)
    if ap.params.TERRAIN.ENABLE <= 0.0:
        return Ground(False, 0.0)
    if not (ap.terrain.asked or ap.terrain.was_known):
        return Ground(True, ap.home.pos.z)
    return by_grid(ap.terrain, ap.estimate.pos, ap.home.pos.z)


@law
def is_flat(v: Vehicle) -> bool:
    """Whether the ground is taken to be a plain at home's height: nobody is there who could tell its heights."""
    ap = v.autopilot
    grid = ap.terrain.asked or ap.terrain.was_known or ap.params.TERRAIN.ENABLE <= 0.0
    return not (grid or has_range(v))


@law
def height_over_ground(v: Vehicle) -> float:
    """Height above the ground below as landings take it [m]: by the grid where it is known, else above home."""
    ap = v.autopilot
    if ap.terrain.was_known and ap.params.TERRAIN.ENABLE > 0.0:
        return by_grid(ap.terrain, ap.estimate.pos, ap.home.pos.z).d - ap.estimate.pos.z
    return ap.home.pos.z - ap.estimate.pos.z


@law
def begin(nav: CopterNav, ground: Ground) -> None:
    """Heights of legs and targets are above the ground from now on."""
    nav.over_ground, nav.ground_lost = True, not ground.is_known
    nav.ground_d, nav.ground_vel, nav.ground_acc = ground.d, 0.0, 0.0


@law
def follow(v: Vehicle) -> None:
    """One tick, while heights are above the ground: follow it. Where its height is not known the path waits."""
    ap = v.autopilot
    nav, ground = ap.modes.nav, ground_below(v)
    nav.ground_lost = not ground.is_known
    if ground.is_known:
        move_to(nav, ground.d, ap.control.pos_d)
    else:
        note_missing(ap.terrain, v.time_us)


@law
def move_to(nav: CopterNav, d: float, limits: AltitudeState) -> None:
    """One tick of what is added to heights towards the ground at ``d`` (down [m])."""
    nav.ground_d += (nav.ground_vel + 0.5 * nav.ground_acc * DT) * DT
    nav.ground_vel += nav.ground_acc * DT
    now = Motion(nav.ground_d, nav.ground_vel, nav.ground_acc)
    speeds = shaping_limits_d(limits, limits.speed_up, limits.speed_down)
    nav.ground_acc = shape_pos_vel_accel(Motion(d, 0.0, 0.0), now, speeds, DT)
