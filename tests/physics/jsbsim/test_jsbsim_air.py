# SPDX-License-Identifier: BSD-3-Clause
"""JSBSim's air: density as native physics has it, turbulence as asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sitl.physics.engine import EngineError
from sitl.physics.jsbsim.model import FOOT, SLUG_BY_FOOT3
from sitl.physics.native.atmosphere import density
from tests.physics.jsbsim.jsbsim_bench import Bench


@pytest.mark.parametrize("altitude", [-50.0, 0.0, 584.0, 3000.0])
def test_density_at_every_home(altitude: float) -> None:
    b = Bench("erle_copter", home=(0.0, 0.0, altitude, 0.0))
    for height in (0.0, 120.0, 1000.0):
        b.put(pos=(0.0, 0.0, -height))
        rho = b.engine.executive.get_property_value("atmosphere/rho-slugs_ft3") * SLUG_BY_FOOT3
        assert rho == pytest.approx(density(altitude + height), rel=3e-5)


def turbulence(b: Any, seconds: float) -> np.ndarray:
    """NED [m/s] at each tick of a flight that is held at its height and 10 m/s."""
    read = b.engine.executive.get_property_value
    rows = []
    for _ in range(round(seconds)):
        b.put(pos=(0.0, 0.0, -20.0), vel=(10.0, 0.0, 0.0), q=(1.0, 0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0))
        b.run(1.0, 0.0, 0.0, 0.0, 0.0)
        rows.append([read(f"atmosphere/turb-{axis}-fps") * FOOT for axis in ("north", "east", "down")])
    return np.array(rows)


def stirred(deviation: float, seed: int = 0, altitude: float = 584.0) -> Any:
    home = (0.0, 0.0, altitude, 0.0)
    return Bench("erle_copter", home=home, seed=seed, params={"SIM_WIND_TURB": deviation})


def test_turbulence_is_as_strong_as_asked_for() -> None:
    """Vertical axis, at any altitude of the home; nothing when it is off."""
    assert np.abs(turbulence(stirred(0.0), 3.0)).max() == 0.0
    for altitude in (0.0, 3000.0):
        assert turbulence(stirred(0.5, altitude=altitude), 300.0)[:, 2].std() == pytest.approx(0.5, rel=0.25)


def test_turbulence_repeats_with_the_seed() -> None:
    first, same, other = (stirred(1.0, seed) for seed in (1, 1, 2))
    expected = turbulence(first, 2.0)
    assert np.array_equal(turbulence(same, 2.0), expected)
    assert not np.array_equal(turbulence(other, 2.0), expected)
    first.simulation.plant.power_on()
    assert np.array_equal(turbulence(first, 2.0), expected)


def test_turbulence_has_no_snapshots() -> None:
    b = stirred(1.0)
    with pytest.raises(EngineError, match="SIM_WIND_TURB"):
        b.engine.snapshot()
