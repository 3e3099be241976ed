# SPDX-License-Identifier: BSD-3-Clause
"""How ``sitl exec`` keeps a script's clock and the vehicle's together."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from sitl.cli.execute import ScriptPace
from sitl.core.constants import TICK_US
from sitl.warp import ClockPage, Pacer


@pytest.mark.parametrize("speedup", [0.5, 1.0, 3.0, 17.0, 20.0])
def test_a_script_is_granted_what_the_vehicle_flies(speedup: float) -> None:
    """A vehicle flies whole ticks: a slice that is none would be flown faster than the wall clock pays for it."""
    with ClockPage() as page:
        pacer = Pacer(page, speedup)
        pace = ScriptPace(pacer)
        assert pace.slice_us == pacer.slice_us and pace.slice_us % TICK_US == 0
        pace.after_slice(SimpleNamespace(time_us=pace.slice_us))  # type: ignore[arg-type]
        assert page.now_us() <= 2 * pace.slice_us
