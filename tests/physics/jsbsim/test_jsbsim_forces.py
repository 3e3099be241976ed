# SPDX-License-Identifier: BSD-3-Clause
"""What JSBSim works out for our aircraft, against the laws of native physics."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.core.algebra import rotate
from sitl.core.constants import TICK_S
from sitl.core.vectors import Quat, Vec3
from sitl.physics.engine import EngineError
from sitl.physics.jsbsim.model import FOOT, POUND, POUND_FOOT, SLUG_BY_FOOT3
from sitl.physics.native import atmosphere
from sitl.physics.native.atmosphere import density
from sitl.physics.native.copter.wrench import act
from sitl.vehicles.properties.multicopter import THRUST_MOMENTUM
from tests.physics.jsbsim.jsbsim_bench import Bench

SEEDS = st.integers(0, 2**32 - 1)
FRAMES = ("erle_copter", "ardupilot_quad")


@pytest.fixture(scope="module", params=FRAMES)
def flying(request: pytest.FixtureRequest) -> Any:
    return Bench(request.param)


def read(b: Any, *names: str) -> np.ndarray:
    return np.array([b.engine.executive.get_property_value(name) for name in names])


def anyhow(b: Any, seed: int) -> None:
    """Some motion, some wind, steady rotors of different speeds."""
    rng, p = np.random.default_rng(seed), b.p
    p.airframe.gyroscopic = 1  # JSBSim knows no bodies without
    is_flow = p.airframe.thrust_model == THRUST_MOMENTUM
    p.wind.steady = p.wind.vel = rng.normal(size=3) * 4.0
    p.rotors.command[:4] = rng.uniform(0.1, 0.9, 4)
    p.rotors.speed[:4] = p.rotors.command[:4] * (1.0 if is_flow else p.airframe.speed_max)
    q = rng.normal(size=4)
    b.put(
        pos=rng.normal(size=3) * 20.0 - (0.0, 0.0, 200.0),
        vel=rng.normal(size=3) * 6.0,
        rates=rng.normal(size=3) * 2.0,
        q=q / np.linalg.norm(q),
    )


@settings(max_examples=25)
@given(seed=SEEDS)
def test_forces_and_torques_are_those_of_native_physics(flying: Any, seed: int) -> None:
    """To the difference of the two atmospheres, 1e-5."""
    anyhow(flying, seed)
    force = read(flying, *(f"forces/fb{axis}-aero-lbs" for axis in "xyz")) * POUND
    torque = read(flying, *(f"moments/{axis}-aero-lbsft" for axis in "lmn")) * POUND_FOOT
    power = read(flying, "rotor/power")[0]
    atmosphere.set_air(flying.p.air, flying.p.origin.alt - flying.p.body.pos.z)
    wrench = act(flying.p)
    expected = np.array([*wrench.force, *wrench.torque])
    scale = np.abs(expected).max() + 10.0
    assert force == pytest.approx(expected[:3], abs=3e-5 * scale)
    assert torque == pytest.approx(expected[3:], abs=3e-5 * scale)
    assert power == pytest.approx(flying.p.rotors.power, rel=3e-5)


@settings(max_examples=10)
@given(seed=SEEDS)
def test_mass_inertia_and_gravity(flying: Any, seed: int) -> None:
    """Accelerations that follow: force by mass and gravity, torque by inertia with the gyroscopic part."""
    anyhow(flying, seed)
    a, rates = flying.p.airframe, np.array(flying.body.rates)
    force = read(flying, *(f"forces/fb{axis}-aero-lbs" for axis in "xyz")) * POUND
    torque = read(flying, *(f"moments/{axis}-aero-lbsft" for axis in "lmn")) * POUND_FOOT
    turned = rotate(Quat(*flying.body.q), Vec3(*force / a.mass))
    before = np.array(flying.body.vel)
    flying.engine.move()
    assert (np.array(flying.body.vel) - before) / TICK_S - turned == pytest.approx([0.0, 0.0, 9.80665], abs=2e-3)
    inertia = np.array(a.inertia)
    expected = rates + TICK_S * (torque - np.cross(rates, inertia * rates)) / inertia
    assert flying.body.rates == pytest.approx(expected, abs=1e-6)


def test_rotors_follow_their_commands() -> None:
    """With the airframe's two lags, and the torque of spinning up."""
    b = Bench("erle_copter")
    a = b.p.airframe
    b.put(pos=(0.0, 0.0, -50.0))
    b.p.rotors.command[:4] = 0.0
    b.run(0.0125, *(0.5 * a.control_max,) * 4)
    assert b.p.rotors.speed[:4] == pytest.approx(0.5 * a.speed_max * (1.0 - np.exp(-1.0)))
    b.run(0.3)
    assert b.p.rotors.speed[:4] == pytest.approx(0.5 * a.speed_max)
    b.run(0.025, *(0.0,) * 4)
    assert b.p.rotors.speed[:4] == pytest.approx(0.5 * a.speed_max * np.exp(-1.0))


def test_a_low_battery_limits_the_rotors() -> None:
    b = Bench("erle_copter")
    b.put(pos=(0.0, 0.0, -50.0))
    b.p.battery.charge = 0.0
    b.run(1.0, *(1.0,) * 4)
    limit = b.p.airframe.speed_max * b.p.battery.voltage / b.p.airframe.speed_voltage
    assert limit < 0.9 * b.p.airframe.speed_max
    assert b.p.rotors.speed[0] == pytest.approx(limit, rel=0.01)


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
