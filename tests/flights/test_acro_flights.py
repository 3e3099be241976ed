# SPDX-License-Identifier: BSD-3-Clause
"""ACRO flown with a ground station's sticks."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.physics.native import truth
from sitl.simulation import Core
from tests.flights.aviator import ACRO, ALT_HOLD, Aviator


def rates(p: Aviator) -> np.ndarray:
    """True body rates [deg/s]."""
    return np.degrees(truth.read(p.simulation.v).rates)


def in_acro(core: Core, trainer: int, frame: str = "erle_copter", **params: float) -> Aviator:
    """Hovering in ALT_HOLD high up, then in ACRO with centred sticks."""
    p = Aviator(core, frame, ACRO_TRAINER=trainer, **params).hover(50.0)
    p.sticks(0.5)
    assert p.set_mode(ALT_HOLD)
    p.sticks(2.0)
    assert p.set_mode(ACRO)
    p.sticks(0.2)
    return p


def test_without_trainer_sticks_are_rates_and_the_attitude_stays(core: Core) -> None:
    p = in_acro(core, 0, ACRO_RP_EXPO=0.0, ACRO_RP_RATE=90.0, ACRO_Y_RATE=90.0)
    p.sticks(0.6, roll=1750)
    assert rates(p)[0] == pytest.approx(90.0 * 0.625, abs=3.0), "less the dead zone of the stick"
    p.sticks(1.0)
    lean = p.euler[0]
    assert 20.0 < lean < 50.0 and np.abs(rates(p)).max() < 2.0
    p.sticks(0.5)
    assert p.euler[0] == pytest.approx(lean, abs=1.5)
    p.sticks(0.8, yaw=1750)
    assert rates(p)[2] == pytest.approx(90.0 * 0.625, abs=4.0)


def test_the_trainer_levels(core: Core) -> None:
    p = in_acro(core, 1)
    p.sticks(0.4, pitch=1700)
    p.hold()
    assert p.fly(10.0, lambda: 20.0 < p.euler[1] < 25.0 and rates(p)[1] < -15.0)
    lean = p.euler[1]
    p.sticks(2.0)
    assert p.euler[1] == pytest.approx(lean * np.exp(-2.0), abs=1.0), "a time constant of 1 s"


@pytest.mark.parametrize(("pulse", "lean"), [(1600, 30.5), (2000, 79.9)])
def test_the_trainer_limits_the_lean(core: Core, pulse: int, lean: float) -> None:
    p = in_acro(core, 2, "ardupilot_quad")
    p.sticks(1.5, roll=pulse)
    assert p.euler[0] == pytest.approx(lean, abs=2.0), "as a real ArduPilot with ANGLE_MAX 3000"
    p.sticks(6.0, throttle=1600)
    assert np.abs(p.euler[:2]).max() < 2.0


def test_without_trainer_it_rolls_over(core: Core) -> None:
    p = in_acro(core, 0)
    start = p.now
    p.sticks(1.6, roll=2000, throttle=1700)
    p.set_mode(ALT_HOLD)
    p.sticks(3.0)
    assert np.abs(p.since(start)[:, 7]).max() > 170.0
    assert abs(p.euler[0]) < 3.0 and p.height > 10.0


def test_arms_and_lands_as_stabilize_does(core: Core) -> None:
    p = Aviator(core)
    p.boot()
    assert p.set_mode(ACRO)
    p.sticks(1.0, throttle=1000)
    p.arm(3.0)
    p.sticks(1.5, throttle=1600)
    assert p.height > 1.0
    p.sticks(0.5, throttle=1450)
    p.hold(throttle=1400)
    assert p.fly(20.0, lambda: p.on_ground)
    p.hold(throttle=1000)
    p.wait_disarmed(15.0)
