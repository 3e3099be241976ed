# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a copter's legs, and where they start (shell)."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO, dot, norm, with_down
from ....core.constants import GRAVITY
from ....core.sums import separation
from ....core.vectors import Vec3
from ...navigation.leg import (
    SHORTEST,
    SLOWING_S,
    LegError,
    Limits,
    axis_limits,
    bounded,
    plan,
    plan_slower,
    speed_within,
    write,
)
from ...navigation.leg_motion import clear, evaluate
from ...navigation.phases import Phase, State
from ...navigation.planner import Planner, end
from ...navigation.state import LOITER_TURNS, TAKEOFF, Leg
from ...terrain.ground import Ground
from ..control.altitude_start import stopping_point_d
from ..control.position_start import stopping_point_ne
from ..parameters import Parameters
from ..state import Autopilot
from ..terrain_following import begin
from . import spline, spline_curve, waypoint
from .spline_curve import SplineLimits
from .state import Spline

_ALONG = 0.999
"""Cosine of the angle to the path under way within which a leg goes on with its speed."""
_AT_REST = 1e-9
"""Acceleration [m/s^2] and jerk that are rounding."""
_POINT = Limits(1.0, 1.0, 1.0)
"""Of a leg without length, which needs none."""


def end_speed(leg: Leg) -> float:
    """Speed [m/s] at the end of a leg, 0 for most."""
    return leg.v[leg.segments - 1] if leg.segments > 0 else 0.0


def jerk_limits(params: Parameters) -> tuple[float, float]:
    """(jerk [m/s^3], rise [s]) of legs.

    Leaning makes horizontal acceleration, so the lean rate limits jerk (ATC_RATE_*_MAX) and the lean rate's
    time constant (ATC_INPUT_TC) and acceleration (ATC_ACCEL_*_MAX) limit snap, half of which is used. Jerk
    that follows half a cosine needs pi/2 of jerk/snap to rise; the same time is taken here.
    """
    jerk = max(params.WPNAV.JERK, 0.1)
    lean_rate = math.radians(min(params.ATC.RATE_R_MAX, params.ATC.RATE_P_MAX))
    if lean_rate > 0.0:
        jerk = min(jerk, lean_rate * GRAVITY)
    snap = 0.5 * math.pi * jerk / max(params.ATC.INPUT_TC, 0.1)
    lean_acceleration = math.radians(0.01 * min(params.ATC.ACCEL_R_MAX, params.ATC.ACCEL_P_MAX))
    if lean_acceleration > 0.0:
        snap = min(snap, lean_acceleration * GRAVITY)
    return jerk, 0.5 * math.pi * jerk / (0.5 * snap)


def rest_of_rise(leg: Leg) -> list[Phase]:
    """What is left of a leg's speeding up; empty once that is over, and where it goes over into slowing down."""
    phases: list[Phase] = []
    for k in range(leg.segments - 1):
        if leg.t[k + 1] <= leg.elapsed:
            continue
        if leg.a[k] <= _AT_REST and leg.j[k] <= _AT_REST and leg.s[k] <= _AT_REST:
            return phases if abs(leg.a[k]) <= _AT_REST else []
        begin = max(leg.t[k], leg.elapsed)
        phases.append(Phase(leg.t[k + 1] - begin, leg.j[k] + leg.s[k] * (begin - leg.t[k]), leg.s[k]))
    return []


class Following(NamedTuple):
    """What comes after the path under way without a stop; ``position`` None: nothing."""

    position: Vec3 | None = None
    is_spline: bool = False
    after: Vec3 | None = None
    """Position after that one, likewise."""
    after_is_spline: bool = False

    def slope_from(self, origin: Vec3, corner: Vec3) -> Vec3:
        """Slope of a curve from ``origin`` at its end ``corner``: to what follows, or parallel to the line past it."""
        if self.position is None:
            return ZERO
        return self.position - (origin if self.is_spline else corner)

    def next_slope(self, corner: Vec3) -> Vec3:
        """Slope at the end of the curve from ``corner`` to ``position``."""
        return (
            ZERO
            if self.position is None
            else Following(self.after, self.after_is_spline).slope_from(corner, self.position)
        )


class CopterPlanner(Planner[Autopilot]):
    """Plans a copter's legs."""

    active_us = 200_000

    def limits(self, ap: Autopilot, direction: Vec3) -> Limits:
        """Speed [m/s] and acceleration [m/s^2] of whichever axis is used up first."""
        nav, p = ap.modes.nav, ap.params.WPNAV
        vertical = max(waypoint.CM * p.ACCEL_Z, 0.1)
        horizontal = max(waypoint.CM * p.ACCEL, 0.1)
        jerk, rise = jerk_limits(ap.params)
        return Limits(
            axis_limits(direction, waypoint.speed_ne(nav, p), waypoint.speed_up(nav, p), waypoint.speed_down(nav, p)),
            axis_limits(direction, horizontal, vertical, vertical),
            jerk,
            rise,
        )

    def stopping_point(self, ap: Autopilot) -> Vec3:
        """Where the controllers would bring it to rest, NED [m]."""
        control, est, p = ap.control, ap.estimate, ap.params
        waypoint.set_limits(control, ap.modes.nav, p)
        down = stopping_point_d(control.pos_d, est, p.PSC)
        if ap.modes.nav.over_ground:
            down -= ap.modes.nav.ground_d
        return with_down(stopping_point_ne(control.pos_ne, est, p.PSC), down)

    def count_from(self, ap: Autopilot, ground: Ground | None) -> None:
        """Heights of the path are above the ground from now on, or (None) from the origin; it stays where it is."""
        nav = ap.modes.nav
        if nav.over_ground == (ground is not None):
            return
        if ground is not None:
            begin(nav, ground)
        shift = nav.ground_d if ground is None else -nav.ground_d
        for leg in (nav.previous, nav.current, nav.next):
            leg.origin = leg.origin.replace(z=leg.origin.z + shift)
        nav.target = nav.target.replace(z=nav.target.z + shift)
        nav.pos = nav.pos.replace(z=nav.pos.z + shift)
        nav.spline.origin = nav.spline.origin.replace(z=nav.spline.origin.z + shift)
        nav.spline.end = nav.spline.end.replace(z=nav.spline.end.z + shift)
        nav.over_ground = ground is not None

    def origin_of_next(self, ap: Autopilot, time_us: int) -> tuple[Vec3, bool]:
        """A circle under way is left from where the vehicle is; a take-off ends at its height."""
        nav = ap.modes.nav
        circling = nav.command_kind == LOITER_TURNS and nav.circle_running
        if self.continues(ap, time_us) and not circling:
            return super().origin_of_next(ap, time_us)
        rest = self.stopping_point(ap)
        if nav.command_kind == TAKEOFF and nav.completed:
            rest = rest.replace(z=nav.target.z)
        return rest, False

    def spline_limits(self, ap: Autopilot) -> SplineLimits:
        """Of curves."""
        nav, p = ap.modes.nav, ap.params.WPNAV
        speeds = waypoint.speed_ne(nav, p), waypoint.speed_up(nav, p), waypoint.speed_down(nav, p)
        part = spline.ACCEL_PART * waypoint.CM
        return SplineLimits(*speeds, max(part * p.ACCEL, 0.05), max(part * p.ACCEL_Z, 0.05))

    def carried(self, ap: Autopilot, time_us: int) -> Vec3:
        """Velocity with which the next command goes on from the end of the path under way, NED [m/s]."""
        nav = ap.modes.nav
        if not self.continues(ap, time_us) or nav.next.segments > 0:
            return ZERO
        if nav.spline.active:
            return spline.direction(nav.spline, 1.0) * (nav.spline.speed if nav.current.fast else 0.0)
        return nav.current.unit * end_speed(nav.current)

    def begin_leg(self, ap: Autopilot, time_us: int, target: Vec3) -> None:
        """A leg along the path under way goes on with its speed; across it, it begins where the vehicle would stop."""
        nav = ap.modes.nav
        carried = self.carried(ap, time_us)
        away = target - end(nav.current)
        speed, length = norm(carried), norm(away)
        along = speed > 0.0 and dot(carried, away) > _ALONG * speed * length
        if speed > 0.0 and not along:
            nav.reached = False
        super().begin_leg(ap, time_us, target)
        nav.spline.active = False
        if along:
            self.replan_between(ap, nav.current, speed, 0.0)

    def look_ahead(self, ap: Autopilot, target: Vec3 | None) -> None:
        """A leg that was to end at a speed, for a curve after it, ends at rest or in a corner."""
        current = ap.modes.nav.current
        if end_speed(current) > 0.0 and not current.started:
            self.replan_between(ap, current, current.v[0], 0.0)
        super().look_ahead(ap, target)

    def replan_between(self, ap: Autopilot, leg: Leg, first: float, last: float) -> None:
        """Plan a leg that has not begun from one speed to another [m/s], no faster in between than without these."""
        if leg.length < SHORTEST:
            return
        wanted = bounded(self.limits(ap, leg.unit))
        wanted = wanted._replace(speed=max(speed_within(0.5 * leg.length, wanted), first, last))
        write(leg, plan(leg.length, wanted, first, 0.0, last), leg.origin, leg.unit, leg.length)
        leg.top_speed = wanted.speed

    def begin_spline(self, ap: Autopilot, time_us: int, target: Vec3) -> None:
        """Make the curve to ``target`` (NED [m]) the current path; it ends at rest until ``aim_spline``."""
        nav = ap.modes.nav
        carried = self.carried(ap, time_us)
        leaving = ZERO
        if carried != ZERO:
            leaving = spline.slope(nav.spline, 1.0) if nav.spline.active else nav.current.unit * nav.current.length
        origin, continues = self.origin_of_next(ap, time_us)
        if continues and nav.next.started:  # the mission changed in the middle of a turn
            origin, continues = self.stopping_point(ap), False
        clear(nav.previous)
        clear(nav.next)
        write(nav.current, plan(0.0, _POINT), target, ZERO, 0.0)
        spline_curve.lay(nav.spline, origin, target, leaving, ZERO)
        spline_curve.set_limits(nav.spline, self.spline_limits(ap), 0.0)
        nav.spline.active, nav.spline.speed = True, norm(carried)
        nav.fresh, nav.joined, nav.reached = not continues, False, False
        nav.target = target

    def aim_spline(self, ap: Autopilot, following: Following) -> None:
        """Lead the curve, which has not begun, into what follows."""
        nav = ap.modes.nav
        s = nav.spline
        if s.u > 0.0:
            return
        spline_curve.lay(s, s.origin, s.end, s.slope, following.slope_from(s.origin, s.end))
        limits = self.spline_limits(ap)
        spline_curve.set_limits(s, limits, self.entry_speed(ap, s.end, spline.slope(s, 1.0), following))
        nav.current.fast = s.end_speed > 0.0

    def look_ahead_spline(self, ap: Autopilot, following: Following) -> None:
        """Plan the leg under way to go over into a curve at a speed, unless it has come too far for that."""
        nav = ap.modes.nav
        leg = nav.current
        if nav.detour.left > 0:
            return
        if nav.next.started or leg.elapsed >= leg.turn_out or leg.length < SHORTEST:
            return
        clear(nav.next)
        speed = self.entry_speed(ap, end(leg), leg.unit * leg.length, following)
        speed = min(speed, self.speed_at_ends(ap, leg.unit, leg.length))
        if leg.started:
            self.go_on_to(ap, leg, speed)
        else:
            self.replan_between(ap, leg, leg.v[0], speed)
        leg.fast = end_speed(leg) > 0.0

    def entry_speed(self, ap: Autopilot, corner: Vec3, leaving: Vec3, following: Following) -> float:
        """Greatest speed [m/s] at ``corner``, in the direction ``leaving``, with which what follows can be flown."""
        if following.position is None or norm(leaving) == 0.0 or separation(following.position, corner) < SHORTEST:
            return 0.0
        if following.is_spline:
            curve = Spline()
            spline_curve.lay(curve, corner, following.position, leaving, following.next_slope(corner))
            spline_curve.set_limits(curve, self.spline_limits(ap), 0.0)
            return curve.allowed[0]
        away = following.position - corner
        return self.speed_at_ends(ap, away / norm(away), norm(away))

    def speed_at_ends(self, ap: Autopilot, unit: Vec3, length: float) -> float:
        """Speed [m/s] in the middle of a leg from rest to rest, which the legs beside curves have at that end."""
        return speed_within(0.5 * length, bounded(self.limits(ap, unit)))

    def change_speed(self, ap: Autopilot) -> None:
        """The curve under way has other limits, too."""
        super().change_speed(ap)
        s = ap.modes.nav.spline
        if s.active:
            spline_curve.set_limits(s, self.spline_limits(ap), s.end_speed)

    def _replan(self, ap: Autopilot, leg: Leg) -> None:
        """A leg that still speeds up goes on with that before it slows down to a lower speed (``plan_slower``)."""
        wanted = bounded(self.limits(ap, leg.unit))
        now, rise = evaluate(leg, leg.elapsed), rest_of_rise(leg)
        if not (leg.started and rise and now.vel > 0.0 and wanted.speed < leg.top_speed):
            super()._replan(ap, leg)
            return
        if leg.turn_out - leg.turn_in < SLOWING_S and max(leg.a[: leg.segments]) < wanted.acceleration:
            return  # nothing can be cut short, and there is no space for slowing down
        left, last = leg.length - now.pos, min(end_speed(leg), wanted.speed)
        try:
            profile = plan_slower(left, wanted, State(0.0, now.vel, now.acc), rise, last)
        except LegError:
            return
        fast = leg.fast
        write(leg, profile, leg.origin + leg.unit * now.pos, leg.unit, left)
        leg.fast, leg.started, leg.top_speed = fast, True, wanted.speed

    def start(self, ap: Autopilot, time_us: int) -> None:
        """Hand the legs to the follower."""
        waypoint.start(ap.modes.nav, ap.control, ap.estimate, ap.params, time_us)


PLANNER = CopterPlanner()
