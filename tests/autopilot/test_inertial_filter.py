# SPDX-License-Identifier: BSD-3-Clause
"""Low-pass filters between the sensors and the controllers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.recorded.pilot import Pilot
from sitl.autopilot.inertial_filter import LowPass, filtered
from sitl.core.vectors import Vec3
from sitl.simulation import Core, Simulation, load_core
from sitl.vehicle.kinds import KINDS
from tests.flights.aviator import ALT_HOLD, Aviator

DT = 0.0025
MANUAL = 0


def answer(cutoff: float, signal: list[float]) -> list[float]:
    """What comes out of a filter, along one axis."""
    f = LowPass()
    return [filtered(f, Vec3(0.0, x, 0.0), cutoff).y for x in signal]


@pytest.mark.parametrize("cutoff", [4.0, 20.0])
def test_gain_at_the_cutoff_is_that_of_butterworth(cutoff: float) -> None:
    for frequency, gain in ((0.1 * cutoff, 1.0), (cutoff, math.sqrt(0.5)), (2.0 * cutoff, 1.0 / math.sqrt(17.0))):
        out = answer(cutoff, [math.sin(2.0 * math.pi * frequency * k * DT) for k in range(4000)])
        rms = math.sqrt(2.0) * float(np.std(out[2000:]))
        assert rms == pytest.approx(gain, abs=0.02)


@pytest.mark.parametrize("cutoff", [4.0, 20.0, 180.0, 256.0])
def test_a_ramp_is_late_by_the_delay_of_the_analogue_filter(cutoff: float) -> None:
    out = answer(cutoff, [k * DT for k in range(4000)])
    assert 3999 * DT - out[-1] == pytest.approx(math.sqrt(2.0) / (2.0 * math.pi * cutoff), rel=1e-6)


def test_zero_is_no_filter() -> None:
    signal = [0.3, -0.7, 12.0]
    assert answer(0.0, signal) == signal


def test_another_cutoff_makes_no_step() -> None:
    f, x = LowPass(), Vec3(0.1, -2.0, 9.81)
    for cutoff in (20.0, 20.0, 4.0, 0.0, 50.0, 50.0):
        assert np.allclose(tuple(filtered(f, x, cutoff)), tuple(x), rtol=0.0, atol=1e-12)


def test_what_is_no_number_passes_and_leaves_nothing_behind() -> None:
    f, bad, good = LowPass(), Vec3(0.0, math.nan, 0.0), Vec3(0.0, 1.0, 0.0)
    filtered(f, good, 20.0)
    assert math.isnan(filtered(f, bad, 20.0).y)
    for _ in range(400):
        out = filtered(f, good, 20.0)
    assert out.y == pytest.approx(1.0)


def delay(true: list[float], shown: list[float]) -> float:
    """By which one signal follows another, sampled every tick [s]."""
    a, b = np.array(true), np.array(shown)
    return DT * float(np.argmax([np.corrcoef(a[: len(a) - k], b[k:])[0, 1] for k in range(60)]))


def rates(p: Pilot, seconds: float, axis: str) -> tuple[list[float], list[float]]:
    """True and estimated rate in each tick."""
    true, shown = [], []
    for _ in range(round(seconds / DT)):
        p.fly(DT)
        true.append(getattr(p.simulation.v.physics.body.rates, axis))
        shown.append(getattr(p.simulation.v.autopilot.estimate.rates, axis))
    return true, shown


@pytest.mark.parametrize(("cutoff", "expected"), [(20, 0.012), (100, 0.002)])
def test_the_copters_rates_are_as_late_as_a_real_ones(core: Core, cutoff: int, expected: float) -> None:
    p = Aviator(core, "ardupilot_quad", INS_GYRO_FILTER=cutoff, RC_OVERRIDE_TIME=-1).hover()
    p.hold()
    assert p.set_mode(ALT_HOLD)
    p.fly(1.0)
    true, shown = [], []
    for pulse in (1900, 1100, 1500):
        p.hold(roll=pulse)
        p.fly(0.04)
        for old, new in zip((true, shown), rates(p, 0.5, "x"), strict=True):
            old += new
    assert delay(true, shown) == pytest.approx(expected, abs=0.0026)  # measured on a real one to 2 ms


def test_the_rovers_rates_are_as_late_as_a_real_ones() -> None:
    p = Pilot(Simulation("ardupilot_rover", core=load_core(KINDS["rover"])))
    p.boot()
    p.arm()
    p.send_command("DO_SET_MODE", 1, MANUAL)
    true, shown = [], []
    for steering in (1500, 1540, 1460, 1540, 1460):
        p.send("RC_CHANNELS_OVERRIDE", chan1_raw=steering, chan3_raw=1700)
        for old, new in zip((true, shown), rates(p, 1.0, "z"), strict=True):
            old += new
    assert delay(true[400:], shown[400:]) == pytest.approx(0.056, abs=0.005)
