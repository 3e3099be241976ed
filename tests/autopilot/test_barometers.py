# SPDX-License-Identifier: BSD-3-Clause
"""Which of two barometers gives the height."""

from __future__ import annotations

import pytest

from sitl.autopilot.barometers import Barometers, are_healthy, choose, uses_second
from sitl.core.border import BAROS_DIFFER, Sensors


def after(seconds: float, primary: int = 0, frozen: tuple[int, ...] = (), silent: tuple[int, ...] = ()) -> Barometers:
    """What is chosen when the barometers have differed for so long, of which some are frozen or silent."""
    baros, s = Barometers(), Sensors()
    s.baro_state = BAROS_DIFFER
    s.abs_pressure = s.abs_pressure2 = 950.0
    for tick in range(1, round(400 * seconds) + 1):
        if tick % 8 == 1:
            s.baro_count += 0 not in silent
            s.baro2_count += 1 not in silent
            s.abs_pressure += 0.0 if 0 in frozen else 0.01
            s.abs_pressure2 += 0.0 if 1 in frozen else 0.01
        choose(baros, s, primary, 10_000_000 + 2500 * tick)
    assert uses_second(baros, s) == (baros.primary == 1)
    assert are_healthy(baros, s, 10_000_000 + 2500 * round(400 * seconds)) == (not (frozen or silent) or seconds < 0.5)
    s.baro_state = 0
    assert not uses_second(baros, s)
    return baros


@pytest.mark.parametrize("primary", [-1, 0, 1, 2])
def test_baro_primary_counts_while_both_are_healthy(primary: int) -> None:
    assert after(5.0, primary).primary == (primary == 1)


def test_a_frozen_barometer_is_left_after_two_seconds() -> None:
    assert after(0.4, frozen=(0,)).primary == 0
    assert after(2.1, frozen=(0,)).primary == 1
    assert after(2.1, primary=1, frozen=(1,)).primary == 0


def test_a_silent_barometer_is_left_after_half_a_second() -> None:
    assert after(0.49, silent=(0,)).primary == 0
    assert after(0.6, silent=(0,)).primary == 1
    assert after(5.0, silent=(0, 1)).primary == 0, "none is better"
