# SPDX-License-Identifier: BSD-3-Clause
"""The rover's mission commands (https://ardupilot.org/rover/docs/mission-command-list.html)."""

from __future__ import annotations

import math

from ...core.mavlink import MavCmd, MavSeverity
from ...core.vectors import Vec3
from ..mission import item as commands
from ..mission.item import MissionItem
from ..mission.item_runners import Commands, is_speed, turns, whole_seconds
from ..mission.location import point
from ..mission.notes import Note
from ..navigation import command
from ..navigation import state as kinds
from ..navigation.planner import end
from ..notes import Text
from .modes import guided_setpoints, set_mode
from .modes.auto import AUTO, LEGS
from .navigation import waypoint
from .navigation.planner import PLANNER
from .state import Vehicle

RADIUS_MAX = 2550.0
"""Greatest radius of circles that ArduPilot's mission storage holds [m]."""

KINDS: dict[int, int] = {
    MavCmd.NAV_WAYPOINT: kinds.WAYPOINT,
    MavCmd.NAV_LOITER_UNLIM: kinds.LOITER_UNLIMITED,
    MavCmd.NAV_LOITER_TURNS: kinds.LOITER_TURNS,
    MavCmd.NAV_LOITER_TIME: kinds.LOITER_TIME,
    MavCmd.NAV_RETURN_TO_LAUNCH: kinds.RTL,
    MavCmd.NAV_DELAY: kinds.DELAY,
    MavCmd.NAV_GUIDED_ENABLE: kinds.GUIDED,
    MavCmd.NAV_SET_YAW_SPEED: kinds.YAW_SPEED,
}
OTHERS = (*commands.COMMON, MavCmd.DO_SET_REVERSE)


class RoverCommands(Commands[Vehicle]):
    """Legs, circles, return, guided driving and turns to a heading; reverse."""

    auto = AUTO
    taken = frozenset((*KINDS, *OTHERS))
    said_invalid = frozenset(
        (MavCmd.DO_RETURN_PATH_START, MavCmd.DO_LAND_START, MavCmd.DO_MOUNT_CONTROL, MavCmd.DO_WINCH)
    )
    planner = PLANNER
    goes_on_disarmed = True

    def enter(self, v: Vehicle) -> None:
        """The parameters' speed, forwards, no legs."""
        waypoint.start(v.autopilot.modes.nav, v.autopilot.control.position, v.autopilot.params)

    def reset(self, v: Vehicle) -> None:
        """Forget the legs."""
        waypoint.stop(v.autopilot.modes.nav)

    def give(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """Make ``item`` the command under way; without a position it is where the vehicle is."""
        ap = v.autopilot
        nav = ap.modes.nav
        kind = KINDS[item.command]
        if kind == kinds.GUIDED and not item.p1 > 0.0:
            kind = kinds.PASSED_OVER  # it would end guided driving, which has ended
        position = flat(point(ap, item, flat(ap.estimate.pos)))
        if kind in LEGS:
            PLANNER.begin(ap, v.time_us, position)
        elif kind in (kinds.LOITER_TURNS, kinds.GUIDED):
            nav.target = position
        command.give(nav, kind, seq)
        nav.has_target = not item.no_location
        if kind in LEGS:
            nav.delay = 0.0 if kind == kinds.LOITER_UNLIMITED else whole_seconds(item)
        elif kind == kinds.LOITER_TURNS:
            nav.turns = turns(item)
            nav.circle_radius = min(max(item.p3, -RADIUS_MAX), RADIUS_MAX)
        elif kind == kinds.YAW_SPEED:
            nav.heading = math.radians(item.p1) + (ap.estimate.yaw if item.p3 > 0.0 else 0.0)
            nav.heading_speed = item.p2
        elif kind == kinds.DELAY:
            nav.delay = max(item.p1, 0.0)
            return [Text(MavSeverity.INFO, f"Delaying {int(nav.delay)} sec")]
        return []

    def look_ahead(self, v: Vehicle, item: MissionItem | None, after: MissionItem | None) -> None:
        """Plan the leg to the following position when the current command is a waypoint without delay."""
        ap = v.autopilot
        nav = ap.modes.nav
        if nav.command_kind != kinds.WAYPOINT or nav.delay > 0.0:
            return
        through = item is not None and KINDS.get(item.command) in (*LEGS, kinds.LOITER_TURNS)
        corner = end(nav.current)
        PLANNER.look_ahead(ap, flat(point(ap, item, corner)) if item is not None and through else None)

    def arrived(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """Said at once, with the time that it waits."""
        wait = int(v.autopilot.modes.nav.delay)
        return [
            Text(MavSeverity.INFO, f"Reached waypoint #{seq}" + (f". Loiter for {wait} seconds" if wait > 0 else ""))
        ]

    def completed(self, v: Vehicle, seq: int, item: MissionItem) -> list[Note]:
        """Only the end of a stay is said."""
        return [Text(MavSeverity.WARNING, "Finished active loiter")] if item.command == MavCmd.NAV_LOITER_TIME else []

    def finish(self, v: Vehicle) -> list[Note]:
        """AUTO does what MIS_DONE_BEHAVE says."""
        command.give_none(v.autopilot.modes.nav)
        return [Text(MavSeverity.NOTICE, "Mission Complete")]

    def run(self, v: Vehicle, item: MissionItem) -> list[Note]:
        """Speed, reverse and guided limits; the rest is common."""
        if item.command == MavCmd.DO_CHANGE_SPEED and self.change_speed(v, int(item.p1), item.p2):
            return [Text(MavSeverity.INFO, f"speed: {item.p2:.1f} m/s")]
        if item.command == MavCmd.DO_SET_REVERSE:
            ap = v.autopilot
            waypoint.set_reversed(ap.modes.nav, ap.estimate, item.p1 == 1.0, ap.params)
        elif item.command == MavCmd.DO_GUIDED_LIMITS:
            guided_setpoints.set_limits(v.autopilot.modes.guided, max(item.p1, 0.0), max(item.p4, 0.0))
        return super().run(v, item)

    def change_speed(self, v: Vehicle, kind: int, speed: float) -> bool:
        """Of what AUTO is doing [m/s]; all kinds of speed are the same."""
        return is_speed(speed) and set_mode.change_speed(v, speed)


def flat(position: Vec3) -> Vec3:
    """The point of the plane in which a rover's paths lie, NED [m]."""
    return Vec3(position.x, position.y, 0.0)


COMMANDS = RoverCommands()
