# SPDX-License-Identifier: BSD-3-Clause
"""The parts of a mission that bring the vehicle back: landing sequences (DO_LAND_START), return paths
(DO_RETURN_PATH_START).

A return path reaches to the next landing sequence, landing or return, or to the mission's end. Behaviour and texts:
ArduPilot's (https://ardupilot.org/copter/docs/auto-mode.html).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...core.algebra import dot, norm
from ...core.elementary import hypot
from ...core.mavlink import MavCmd, MavSeverity
from ...core.vectors import Vec3
from ..events import Event
from ..navigation.state import JUMPS, LANDING, RETURN_PATH
from ..state import Autopilot
from . import jumps
from .item import COMMANDS, MissionItem
from .location import point
from .mission import Mission

LANDINGS = (MavCmd.NAV_LAND, MavCmd.NAV_VTOL_LAND)
RETURN_WANTED = Event(50)  # AUTO_RTL; a: how (BEST, ...), b: 1 AUTO flies already
RETURN_ACTIVE = Event(51, MavSeverity.INFO, {RETURN_PATH: "Return path active", LANDING: "Landing sequence active"})
"""It flies a part that brings it back already; a: ``mission_part``"""


def marks(mission: Mission, command: int) -> list[int]:
    """Numbers of the items that mark the beginning of such a part, and have a navigation command behind them."""
    found = (k for k, item in enumerate(mission.items) if k > 0 and item.command == command)
    return [k for k in found if jumps.next_nav(mission, k + 1, {}, JUMPS) != 0]


def has_path(mission: Mission) -> bool:
    """Whether there is a return path with a location on it."""
    return any(next(_path(mission, mark), None) for mark in marks(mission, MavCmd.DO_RETURN_PATH_START))


def nearest_landing(mission: Mission, ap: Autopilot) -> int:
    """Number of the DO_LAND_START nearest to the vehicle (without a location: its first navigation command), 0 none."""
    here = ap.estimate.pos

    def away(k: int) -> float:
        item = mission.items[k]
        if item.no_location:
            item = mission.items[jumps.next_nav(mission, k + 1, {}, JUMPS)]
        position = point(ap, item, here)
        return hypot(position.x - here.x, position.y - here.y)

    return min(marks(mission, MavCmd.DO_LAND_START), key=away, default=0)


def nearest_leg(mission: Mission, ap: Autopilot) -> int:
    """Number of the item at the end of the leg of a return path that is nearest to the vehicle, 0 none."""
    here = ap.estimate.pos
    best, found = math.inf, 0
    for mark in marks(mission, MavCmd.DO_RETURN_PATH_START):
        before = None if mission.items[mark].no_location else point(ap, mission.items[mark], here)
        for k, item in _path(mission, mark):
            position = point(ap, item, here)
            away = _distance(here, position if before is None else before, position)
            if away < best:
                best, found = away, k
            before = position
    return found


def _path(mission: Mission, mark: int) -> Iterator[tuple[int, MissionItem]]:
    """Items with a location that follow a mark of a return path, up to its end."""
    seq, counts = mark + 1, dict[int, int]()
    for _ in range(len(mission) + jumps.LONGEST):
        seq = jumps.following(mission, seq, counts, JUMPS)
        item = mission.get(seq)
        if item is None or item.command == MavCmd.DO_LAND_START:
            return
        if item.is_nav and COMMANDS[item.command].has_location and not item.no_location:
            yield seq, item
        if item.command in LANDINGS:
            return
        seq += 1


def _distance(here: Vec3, start: Vec3, end: Vec3) -> float:
    """From a point to a stretch [m]."""
    along, away = end - start, here - start
    length2 = dot(along, along)
    share = min(max(dot(away, along) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    return norm(away - along * share)
