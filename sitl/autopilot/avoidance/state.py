# SPDX-License-Identifier: BSD-3-Clause
"""The records of avoidance."""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array
from ...core.vectors import Vec2


class Avoidance(Record):
    """What is avoided, and how velocities were limited last."""

    obstacles: bool  # what the proximity sensor sees is avoided (AVOID_ENABLE, the switch, AVOID_ALT_MIN)
    fences: int  # bits of the fences that are (``fence.state``)
    switched_off: bool  # a switch says that obstacles are not to be avoided
    limited_us: int  # when a velocity was last changed
    vel: Vec2  # to what, NE [m/s]
    back_max: Vec2  # velocities that margins ask for, of one tick: the greatest and the least of each axis [m/s]
    back_min: Vec2


OBJECTS = 32
"""Objects that fit."""


class Objects(Record):
    """What was seen, and where (``avoidance.objects``)."""

    north: Floats = array(OBJECTS, stored="f4")  # from the estimator's origin [m]
    east: Floats = array(OBJECTS, stored="f4")
    down: Floats = array(OBJECTS, stored="f4")
    radius: Floats = array(OBJECTS, stored="f4")  # [m]
    until_ms: Ints = array(OBJECTS, stored="i4")  # it counts until then [ms]
