# SPDX-License-Identifier: BSD-3-Clause
"""Which boot an episode begins with, and what else of its start is drawn: all by the episode's seed alone."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from sitl.scenario import Scenario
from sitl.vehicles import Airframe

from ..noise import standard_normal
from ..options import EnvOptionError

MOST = 1024
"""Prepared boots: they are kept with what makes them ready for an action, some 200 kB each."""
SINGLE = 0
"""Number of the boot with seed 0, as every episode had it before there were others."""
_STREAM, _COMPASS = 0xB007, 0xC0


class Drawn(NamedTuple):
    """The start of an episode."""

    boot: int
    """Number of the prepared boot."""
    walks: tuple[float, float] | None
    """Slow error of the receiver, north and east, in standard deviations; None: that of the boot."""


def check_boots(boots: int) -> None:
    """Refuse a number of boots that there cannot be."""
    if isinstance(boots, bool) or not isinstance(boots, int | np.integer) or not 1 <= boots <= MOST:
        raise EnvOptionError(f"boots = {boots!r}; a whole number, 1 .. {MOST}, is needed")


def draw(boots: int, seed: int) -> Drawn:
    """What an episode with this seed begins with, of so many boots."""
    if boots == 1:
        return Drawn(SINGLE, None)
    random = np.random.default_rng((_STREAM, seed & 0xFFFF_FFFF_FFFF_FFFF))
    north, east = standard_normal(random, 2).tolist()
    return Drawn(1 + int(random.integers(boots)), (north, east))


def booted(scenario: Scenario, airframe: Airframe, seed: int) -> tuple[Scenario, Airframe]:
    """Scenario and airframe of a boot with this seed: the compass has the hard iron that another calibration left."""
    if seed == SINGLE:
        return scenario, airframe
    if airframe.has("mag_offset"):
        random = np.random.default_rng((_COMPASS, seed & 0xFFFF_FFFF_FFFF_FFFF))
        x, y, z = airframe.value("mag_offset") or (0.0, 0.0, 0.0)
        size = math.sqrt((x * x + y * y + z * z) / 3.0)
        airframe = airframe.changed(mag_offset=tuple((size * standard_normal(random, 3)).tolist()))
    return replace(scenario, seed=seed), airframe
