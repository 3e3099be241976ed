# SPDX-License-Identifier: BSD-3-Clause
"""The copter's mission commands (https://ardupilot.org/copter/docs/mission-command-list.html)."""

from __future__ import annotations

import math

from ...core.elementary import cos, hypot, sin
from ...core.mavlink import MavCmd, MavSeverity
from ...core.vectors import Vec3
from ..mission import item as commands
from ..mission.item import TERRAIN_FRAMES, MissionItem
from ..mission.item_runners import Commands, is_speed, turns, whole_seconds
from ..mission.location import down, point
from ..mission.notes import Note, OutputItem
from ..navigation import command
from ..navigation import state as kinds
from ..navigation.path import clear_legs
from ..navigation.planner import end
from ..notes import Text
from ..terrain.ground import lose_ground
from .modes import auto, auto_yaw
from .modes.auto import AUTO, AUTO_RTL
from .modes.state import GuidedState
from .navigation import waypoint
from .navigation.planner import PLANNER, Following
from .navigation.state import CopterNav
from .state import Autopilot, Vehicle
from .terrain_following import ground_below, is_flat

EDGE = 3.0
"""A vehicle this near to the circle starts it where it is [m]."""
WIDEST = 2550.0
"""Greatest radius of circles that ArduPilot's mission storage holds [m]."""
DEEPEST = 655.35
"""Greatest limit of PAYLOAD_PLACE's descent that the storage holds [m]."""
GRIPPER_RELEASE = 0.0
"""GRIPPER_ACTIONS"""
FOREVER_S = 1e9
LEAST_CLIMB = 1.0
"""Of a take-off from the ground [m]."""
CLIMB_SPEED, DESCENT_SPEED = 2, 3
"""SPEED_TYPE of DO_CHANGE_SPEED; 0 and 1 are both horizontal."""

KINDS: dict[int, int] = {
    MavCmd.NAV_TAKEOFF: kinds.TAKEOFF,
    MavCmd.NAV_WAYPOINT: kinds.WAYPOINT,
    MavCmd.NAV_SPLINE_WAYPOINT: kinds.WAYPOINT,
    MavCmd.NAV_LOITER_UNLIM: kinds.LOITER_UNLIMITED,
    MavCmd.NAV_LOITER_TURNS: kinds.LOITER_TURNS,
    MavCmd.NAV_LOITER_TIME: kinds.LOITER_TIME,
    MavCmd.NAV_RETURN_TO_LAUNCH: kinds.RTL,
    MavCmd.NAV_LAND: kinds.LAND,
    MavCmd.NAV_DELAY: kinds.DELAY,
    MavCmd.NAV_LOITER_TO_ALT: kinds.LOITER_TO_ALT,
    MavCmd.NAV_VTOL_TAKEOFF: kinds.TAKEOFF,
    MavCmd.NAV_VTOL_LAND: kinds.LAND,
    MavCmd.NAV_GUIDED_ENABLE: kinds.GUIDED,
    MavCmd.NAV_PAYLOAD_PLACE: kinds.PAYLOAD_PLACE,
    MavCmd.NAV_ARC_WAYPOINT: kinds.WAYPOINT,
    MavCmd.NAV_SCRIPT_TIME: kinds.DELAY,
    MavCmd.NAV_ATTITUDE_TIME: kinds.DELAY,
}
FLOWN_AS: dict[int, str] = {
    MavCmd.NAV_ARC_WAYPOINT: "a straight line",
    MavCmd.NAV_SCRIPT_TIME: "a delay",
    MavCmd.NAV_ATTITUDE_TIME: "a delay",
}
"""What is flown of commands that are carried out in part."""
OTHERS = (*commands.COMMON, MavCmd.CONDITION_YAW, MavCmd.DO_PARACHUTE)
LEGS = (kinds.WAYPOINT, kinds.LOITER_UNLIMITED, kinds.LOITER_TIME)
SAYS_REACHED = (
    MavCmd.NAV_WAYPOINT,
    MavCmd.NAV_SPLINE_WAYPOINT,
    MavCmd.NAV_ARC_WAYPOINT,
    MavCmd.NAV_LOITER_TIME,
)


class CopterCommands(Commands[Vehicle]):
    """Take-off, legs, circles, return and landing; heading and region of interest."""

    auto, auto_return = AUTO, AUTO_RTL
    taken = frozenset((*KINDS, *OTHERS))
    planner = PLANNER

    def enter(self, v: Vehicle) -> None:
        """Speeds are the parameters' again."""
        nav = v.autopilot.modes.nav
        nav.speed_ne = nav.speed_up = nav.speed_down = 0.0
        waypoint.stop(v.autopilot.modes.nav)

    def reset(self, v: Vehicle) -> None:
        """Forget the legs."""
        waypoint.stop(v.autopilot.modes.nav)

    def give(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """Make ``item`` the command under way."""
        if item.command in FLOWN_AS:
            said = Text(MavSeverity.WARNING, f"Mission: {seq} {item.name} is flown as {FLOWN_AS[item.command]}")
            self.give(v, seq, _simpler(item))
            return [said]
        ap, time_us = v.autopilot, v.time_us
        nav = ap.modes.nav
        kind = KINDS[item.command]
        if kind == kinds.GUIDED and not int(item.p1) > 0:
            kind = kinds.PASSED_OVER  # it would end guided flight, which has ended
        if nav.condition_kind != kinds.CONDITION_YAW:  # a turn asked for on the way to this command goes on
            auto.choose_heading(ap.modes.auto_yaw, kind, ap.params.WP, ap.control.attitude, ap.estimate)
        _choose_heights(v, item, kind)
        here, _ = PLANNER.origin_of_next(ap, time_us)
        if item.command == MavCmd.NAV_SPLINE_WAYPOINT:
            PLANNER.begin_spline(ap, time_us, _end_of_leg(ap, item, here))
        elif kind in (*LEGS, kinds.LOITER_TO_ALT):
            PLANNER.begin(ap, time_us, _end_of_leg(ap, item, here))
        elif kind == kinds.DELAY:
            PLANNER.begin(ap, time_us, here)
        elif kind == kinds.LOITER_TURNS:
            _circle(ap, time_us, item, here)
        elif kind in (kinds.LAND, kinds.PAYLOAD_PLACE) and not item.no_location:
            PLANNER.begin(ap, time_us, point(ap, item, here).replace(z=here.z))  # at the present height
        else:
            _end_path(nav)
            nav.target = here.replace(z=_take_off_to(v, item)) if kind == kinds.TAKEOFF else here
        command.give(nav, kind, seq)
        nav.circle_running = False
        nav.has_target = not item.no_location
        if kind in (kinds.WAYPOINT, kinds.LOITER_TIME):
            nav.delay = whole_seconds(item)
        elif kind == kinds.DELAY:
            nav.delay = max(item.p1, 0.0)
            return [Text(MavSeverity.INFO, f"Delaying {int(nav.delay)} sec")]
        elif kind == kinds.LOITER_TURNS:
            nav.turns = turns(item)
        elif kind == kinds.PAYLOAD_PLACE:
            ap.modes.payload_place.limit = int(min(max(item.p1, 0.0), DEEPEST) * 100.0) * 0.01
        return []

    def look_ahead(self, v: Vehicle, item: MissionItem | None, after: MissionItem | None) -> None:
        """Plan the leg to the following command when the vehicle flies through without a stop.

        The current one must be a waypoint without delay, the next one a leg to a position.
        """
        ap = v.autopilot
        nav = ap.modes.nav
        if nav.command_kind != kinds.WAYPOINT or nav.delay > 0.0:
            return
        if item is not None and _is_over_ground(v, item) != nav.over_ground:
            item = None
        if after is not None and _is_over_ground(v, after) != nav.over_ground:
            after = None
        following = _following(ap, item and _simpler(item), after and _simpler(after))
        if nav.spline.active:
            PLANNER.aim_spline(ap, following)
        elif following.is_spline:
            PLANNER.look_ahead_spline(ap, following)
        else:
            PLANNER.look_ahead(ap, following.position)

    def arrived(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """A load that stands is let go."""
        return [OutputItem(MissionItem(MavCmd.DO_GRIPPER, p2=GRIPPER_RELEASE))]

    def completed(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """Some say so."""
        return [Text(MavSeverity.INFO, f"Reached command #{seq}")] if item.command in SAYS_REACHED else []

    def finish(self, v: Vehicle) -> list[Note]:
        """AUTO disarms on the ground and stays where it would come to rest in the air."""
        ap, time_us = v.autopilot, v.time_us
        nav = ap.modes.nav
        if ap.arming.landed:
            command.give_none(nav)
        else:
            PLANNER.begin(ap, time_us, PLANNER.origin_of_next(ap, time_us)[0])
            command.give(nav, kinds.LOITER_UNLIMITED, nav.command_seq)
        nav.circle_running = False
        return []

    def run(self, v: Vehicle, item: MissionItem) -> list[Note]:
        """Speeds and where to look; the rest is common."""
        ap = v.autopilot
        if item.command == MavCmd.DO_CHANGE_SPEED:
            self.change_speed(v, int(item.p1), item.p2)
        elif item.command == MavCmd.CONDITION_YAW:
            direction = int(math.copysign(1.0, item.p3)) if item.p3 else 0
            turn = auto_yaw.Turn(math.radians(item.p1), math.radians(item.p2), direction, item.p4 > 0.0)
            start = ap.control.attitude.target_euler.yaw
            auto_yaw.turn_to(ap.modes.auto_yaw, turn, start, auto_yaw.slew_max(ap.params.ATC))
            ap.modes.nav.condition_kind = kinds.CONDITION_YAW
        elif item.command in (MavCmd.DO_SET_ROI, MavCmd.DO_SET_ROI_LOCATION):
            set_roi(v, item)
        elif item.command == MavCmd.DO_SET_ROI_NONE:
            _look_ahead(ap)
        elif item.command == MavCmd.DO_GUIDED_LIMITS:
            _limit_guided(ap.modes.guided, item)
        return super().run(v, item)

    def change_speed(self, v: Vehicle, kind: int, speed: float) -> bool:
        """Limits [m/s] of the legs from now on, until AUTO is left."""
        if not is_speed(speed):
            return False
        nav = v.autopilot.modes.nav
        if kind == CLIMB_SPEED:
            nav.speed_up = speed
        elif kind == DESCENT_SPEED:
            nav.speed_down = speed
        else:
            nav.speed_ne = speed
        PLANNER.change_speed(v.autopilot)
        return True


def _simpler(item: MissionItem) -> MissionItem:
    """What is flown of a command that is carried out in part: an arc's end, so long a stay."""
    if item.command == MavCmd.NAV_ARC_WAYPOINT:
        return item._replace(command=MavCmd.NAV_WAYPOINT, p1=0.0)
    if item.command == MavCmd.NAV_SCRIPT_TIME:  # of no time: until another is told to be next
        return item._replace(command=MavCmd.NAV_DELAY, p1=item.p2 or FOREVER_S, x=0, y=0)
    if item.command == MavCmd.NAV_ATTITUDE_TIME:
        return item._replace(command=MavCmd.NAV_DELAY, x=0, y=0)
    return item


def _following(ap: Autopilot, item: MissionItem | None, after: MissionItem | None) -> Following:
    """What the command under way goes over into without a stop."""
    if item is None or KINDS.get(item.command) not in LEGS:  # ArduPilot stops before what it skips, too
        return Following()
    corner = _end_of_leg(ap, item, end(ap.modes.nav.current))
    is_spline = item.command == MavCmd.NAV_SPLINE_WAYPOINT
    if after is None or KINDS.get(after.command) not in LEGS or whole_seconds(item) > 0.0:
        return Following(corner, is_spline)
    return Following(corner, is_spline, _end_of_leg(ap, after, corner), after.command == MavCmd.NAV_SPLINE_WAYPOINT)


def _is_over_ground(v: Vehicle, item: MissionItem) -> bool:
    """Whether the path to an item is above the ground, which is no plain."""
    return item.frame in TERRAIN_FRAMES and not is_flat(v)


def _choose_heights(v: Vehicle, item: MissionItem, kind: int) -> None:
    """Count heights from the origin, or from the ground. A ground of which nothing is known is a failsafe at once."""
    if kind in (kinds.DELAY, kinds.PASSED_OVER):
        return
    if kind not in (*LEGS, kinds.LOITER_TURNS) or not _is_over_ground(v, item):
        PLANNER.count_from(v.autopilot, None)
        return
    ground = ground_below(v)
    PLANNER.count_from(v.autopilot, ground)
    if not ground.is_known:
        lose_ground(v.autopilot.terrain, v.time_us)


def _end_of_leg(ap: Autopilot, item: MissionItem, default: Vec3) -> Vec3:
    """As ``point``, with the height as the path under way counts it."""
    target = point(ap, item, default)
    return target.replace(z=-item.z) if ap.modes.nav.over_ground and item.z != 0.0 else target


def _take_off_to(v: Vehicle, item: MissionItem) -> float:
    """Down coordinate of a take-off's end [m]: never below the vehicle, from the ground at least a metre up."""
    ap = v.autopilot
    least = LEAST_CLIMB if ap.arming.landed else 0.0
    ground = ground_below(v)
    to = ground.d - item.z if _is_over_ground(v, item) and ground.is_known else down(ap, item)
    return min(to, ap.estimate.pos.z - least)


def set_roi(v: Vehicle, item: MissionItem) -> None:
    """Keep the nose on a position; a position of zeros ends that."""
    if item.no_location and item.z == 0.0:
        _look_ahead(v.autopilot)
        return
    ap = v.autopilot
    auto_yaw.look_at(ap.modes.auto_yaw, point(ap, item, ap.estimate.pos), ap.control.attitude, ap.estimate)


def _limit_guided(guided: GuidedState, item: MissionItem) -> None:
    """Whole seconds, heights over the origin and distance from where guided flight begins [m]; 0: no limit."""
    guided.limit_us = int(whole_seconds(item) * 1e6)
    guided.limit_low, guided.limit_high, guided.limit_distance = item.p2, item.p3, item.p4


def _look_ahead(ap: Autopilot) -> None:
    """Leave the heading to WP_YAW_BEHAVIOR."""
    auto_yaw.set_default(ap.modes.auto_yaw, ap.params.WP, False, ap.control.attitude, ap.estimate)


def _circle(ap: Autopilot, time_us: int, item: MissionItem, here: Vec3) -> None:
    """The leg to the nearest point of the circle, none when it is near."""
    nav = ap.modes.nav
    centre = _end_of_leg(ap, item, here)
    radius = item.p3 if item.p3 != 0.0 else 0.01 * ap.params.CIRCLE.RADIUS
    radius = min(max(radius, -WIDEST), WIDEST)
    n, e = ap.estimate.pos.x - centre.x, ap.estimate.pos.y - centre.y
    away = hypot(n, e)
    if away < 0.01:  # from the centre straight back, so that it looks ahead
        yaw = ap.estimate.yaw + math.pi
        n, e, away = cos(yaw), sin(yaw), 1.0
        distance = abs(radius)
    else:
        distance = abs(away - abs(radius))
    edge = Vec3(centre.x + n / away * abs(radius), centre.y + e / away * abs(radius), centre.z)
    if max(distance, abs(centre.z - here.z)) > EDGE:
        PLANNER.begin(ap, time_us, edge)
    else:
        PLANNER.begin(ap, time_us, here)
        nav.reached = True
    nav.circle_radius = radius
    nav.circle_centre = centre
    nav.target = centre


COMMANDS = CopterCommands()


def _end_path(nav: CopterNav) -> None:
    """Forget the legs: the next one starts where the vehicle would come to rest."""
    clear_legs(nav)
    nav.spline.active = False
    nav.reached = nav.fresh = False
    nav.active_us = 0
