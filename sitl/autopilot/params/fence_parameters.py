# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of fences and of rally points."""

from __future__ import annotations

from .parameter import BITS16, INT8, INT16, ParameterGroup, param

_FAR = 1e9


class Fence(ParameterGroup):
    """FENCE_: areas that the vehicle is to stay in, or out of."""

    ENABLE: float = param(0, 0, 1, "", "Set: switches all fences of FENCE_TYPE on (1) or off (0)", INT8)
    TYPE: float = param(7, 0, 15, "", "Bits: 1 greatest height, 2 circle around home, 4 areas, 8 least height", INT8)
    ACTION: float = param(1, -128, 127, "", "When breached: 0 nothing, 1 RTL or LAND, ...", INT8)
    RADIUS: float = param(300.0, -_FAR, _FAR, "m", "Of the circle around home")
    MARGIN: float = param(2.0, -_FAR, _FAR, "m", "Clearance that is kept to the fences")
    MARGIN_XY: float = param(0.0, -_FAR, _FAR, "m", "The same for the circle and areas; 0: as FENCE_MARGIN")
    TOTAL: float = param(0, -128, 127, "", "Points of areas that are loaded, as FENCE_POINT counts them", INT8)
    OPTIONS: float = param(
        0, *BITS16, "",
        "Bits: 1 no other mode while breached, 2 one of the areas to stay in is enough, 4 tells of a margin breached",
        INT16,
    )  # fmt: skip
    NTF_FREQ: float = param(1.0, 0.0, 10.0, "Hz", "How often it tells how far a fence is, once within its margin")


class Rally(ParameterGroup):
    """RALLY_: locations to return to, besides home."""

    TOTAL: float = param(0, 0, 127, "", "Rally points that are loaded", INT8)
    LIMIT_KM: float = param(
        0.3, 0.0, _FAR, "km", "Points further away than this, and than home, do not count; 0: all do"
    )
    INCL_HOME: float = param(1, 0, 1, "", "1: home is one of the points", INT8)
