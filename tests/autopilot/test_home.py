# SPDX-License-Identifier: BSD-3-Clause
"""Home, on the records of home and estimate alone."""

from __future__ import annotations

import pytest

from sitl.autopilot import home
from sitl.autopilot.state import Estimate, HomeState

ORIGIN = (-353632620, 1491652370)


def located() -> Estimate:
    est = Estimate()
    est.origin_lat, est.origin_lon = ORIGIN
    est.origin_alt, est.origin_set, est.pos = 584.0, True, (30.0, -40.0, -10.0)
    return est


def test_home_here_and_by_its_place_are_the_same() -> None:
    est, here, there = located(), HomeState(), HomeState()
    assert home.set_here(here, est)
    assert here.alt == 594.0 and here.pos == est.pos and not here.locked
    assert home.set_location(there, est, here.lat, here.lon, here.alt)
    assert there.pos == pytest.approx(here.pos, abs=0.02) and there.locked


@pytest.mark.parametrize("place", [(900000001, 0, 0.0), (0, -1800000001, 0.0), (0, 0, float("nan"))])
def test_a_place_off_the_globe_is_refused(place: tuple[int, int, float]) -> None:
    state = HomeState()
    assert not home.set_location(state, located(), *place) and not state.is_set


def test_there_is_no_home_without_an_origin() -> None:
    state = HomeState()
    home.set_first(state, Estimate())
    assert not state.is_set and not home.set_location(state, Estimate(), *ORIGIN, 0.0)
