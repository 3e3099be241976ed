# SPDX-License-Identifier: BSD-3-Clause
"""Rally points: locations besides home that RTL returns to (RALLY_TOTAL, RALLY_LIMIT_KM, RALLY_INCL_HOME).

https://ardupilot.org/copter/docs/common-rally-points.html
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..core.algebra import horizontal, norm2, with_down
from ..core.geodesy import offset_ne
from ..core.kernels import law
from ..core.vectors import Vec3
from .events import Event, Row
from .fence.checks import allows
from .fence.state import POINTS, FenceState, RallyState
from .params.firmware_parameters import Parameters
from .state import Estimate, HomeState

_FROM_HOME, _FROM_SEA = 12, 4
"""Flags of RALY: its height is one above home, or above mean sea level."""


def rows(v: Any, a: float = 0.0, b: float = 0.0) -> list[Row]:
    """RALY of each point that counts."""
    points, total = v.autopilot.rally, min(int(v.autopilot.params.RALLY.TOTAL), len(v.autopilot.rally.lat))
    return [
        ("RALY", (total, k, int(points.lat[k]), int(points.lon[k]), min(max(int(points.alt[k]), -32768), 32767),
                  _FROM_SEA if points.is_amsl[k] else _FROM_HOME))
        for k in range(total)
    ]  # fmt: skip


RALLY_LOADED = Event(74, log=rows)


@law
def position(rally: RallyState, k: int, estimate: Estimate, home: HomeState) -> Vec3:
    """Location of a point, NED from the origin [m]."""
    flat = offset_ne(estimate.origin_lat, estimate.origin_lon, int(rally.lat[k]), int(rally.lon[k]))
    height = float(rally.alt[k])
    if rally.is_amsl[k] != 0:
        height -= home.alt
    return with_down(flat, home.pos.z - height)


@law
def best(
    rally: RallyState, estimate: Estimate, home: HomeState, fence: FenceState, params: Parameters, heights: Vec3
) -> Vec3:
    """Where to return to, NED from the origin [m]: the nearest rally point, or home.

    Args:
        rally, estimate, home, fence, params: the vehicle's.
        heights: greatest and least one that the fence allows [m above home], and whatever.
    """
    here, p = estimate.pos, params.RALLY
    found, nearest = home.pos, 1e12
    if estimate.origin_set:
        for k in range(min(int(p.TOTAL), POINTS)):
            point = position(rally, k, estimate, home)
            away = norm2(horizontal(point) - horizontal(here))
            if away < nearest and allows(fence, home, point, params.FENCE, heights.x, heights.y):
                found, nearest = point, away
    if nearest > 1e11 or (p.LIMIT_KM > 0.0 and nearest > p.LIMIT_KM * 1e3):
        return home.pos
    if p.INCL_HOME != 0.0 and nearest >= norm2(horizontal(home.pos) - horizontal(here)):
        return home.pos
    return found


def load(rally: RallyState, points: Sequence[tuple[int, int, int, bool]]) -> None:
    """Put points into the record (shell side): latitude, longitude [degE7], height [m], whether above sea level."""
    rally.zero(*rally.fields)
    for k, (lat, lon, alt, is_amsl) in enumerate(points[:POINTS]):
        rally.lat[k], rally.lon[k], rally.alt[k], rally.is_amsl[k] = lat, lon, alt, is_amsl
