# SPDX-License-Identifier: BSD-3-Clause
"""The heading of ArduPilot's frames errs as that of a real ArduPilot (heading.json)."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import heading
from sitl.autopilot.estimation.state import BG, THETA, VEL, Ekf, N
from sitl.physics.native import truth
from sitl.simulation import Core, load_core
from sitl.vehicle.kinds import KINDS
from tests.drives.rover_driver import Driver
from tests.flights.aviator import Aviator
from tests.pilots.witness import Witness

KEPT = json.loads(Path(__file__).with_name("heading.json").read_text(encoding="utf-8"))
CLOSE, AFTER_JUMP = 0.5, 0.6
"""Ours may be so far from the kept error [deg]; a copter in the air unlearns it more slowly."""
STEEP = 1.0
"""While the error changes by 5 degrees a second: 0.2 s."""
AHEAD = 0xDC7


def error(p: Witness) -> float:
    """Estimated less true heading [deg]."""
    wrong = p.ap.estimate.euler.yaw - truth.read(p.simulation.v).euler[2]
    return math.degrees(math.remainder(wrong, 2.0 * math.pi))


def start(kind: str, core: Core, **params: float) -> Witness:
    if kind == "copter":
        return Aviator(core, "ardupilot_quad", **params)
    return Driver(load_core(KINDS["rover"]), "ardupilot_rover", **params)


def check(p: Witness, rows: list[list[float]], close: float = CLOSE, drive: bool = False) -> None:
    """Compare the errors at their times."""
    ours = []
    for time, _ in rows:
        while p.now < time - 1e-3:
            if drive:
                p.target(AHEAD, vx=2.0)
            p.fly(min(time - p.now, 0.2 if drive else 60.0))
        ours.append(error(p))
    for (time, kept), value in zip(rows, ours, strict=True):
        assert value == pytest.approx(kept, abs=STEEP if 10.0 < time < 13.0 else close), f"after {time} s"


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_at_rest_the_declination_swings_in(core: Core, kind: str) -> None:
    check(start(kind, core), KEPT[kind]["at rest"])


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_so_it_goes_on_in_motion(core: Core, kind: str) -> None:
    """Armed after 45 s: a take-off, on which yaw is aligned once more, or 2 m/s ahead."""
    p = start(kind, core)
    p.fly(45.0 - p.now)
    jumps = p.ap.estimate.reset_yaw_count
    assert p.set_mode(4 if kind == "copter" else 15), p.texts
    p.arm()
    if kind == "copter":
        assert p.ask(22, 0, 0, 0, 0, 0, 0, 10.0) == 0
    check(p, KEPT[kind]["moving"], AFTER_JUMP if kind == "copter" else CLOSE, drive=kind == "rover")
    assert p.ap.estimate.reset_yaw_count == jumps + (1 if kind == "copter" else 0)
    assert p.said("in-flight yaw alignment") == (kind == "copter")


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_mag_cal_4_turns_at_once(core: Core, kind: str) -> None:
    """As the Erle airframes have it."""
    p = start(kind, core, EK3_MAG_CAL=4)
    p.fly(9.0)
    assert error(p) == pytest.approx(-12.7, abs=0.2)
    p.fly(2.0)
    assert abs(error(p)) < 0.1
    p.fly(20.0)
    assert abs(error(p)) < 0.1


@given(st.integers(0, 10000))
@settings(max_examples=20, deadline=None)
def test_loosening_keeps_a_covariance_one(seed: int) -> None:
    """Of any covariance, also of one that knows some sum of states exactly: no combination of states gets a variance
    below zero, and variances stay."""
    ekf, root = Ekf(), np.random.default_rng(seed).normal(size=(N, N // 2))
    ekf.P[:] = root @ root.T
    before = np.array(ekf.P)
    for _ in range(5):
        heading.loosen(ekf)
        P = np.array(ekf.P)
        assert np.array_equal(P, P.T) and np.array_equal(np.diag(P), np.diag(before))
        assert np.linalg.eigvalsh(P)[0] > -1e-12 * np.trace(P)
    assert abs(P[THETA + 2, VEL]) < 0.4 * abs(before[THETA + 2, VEL])
    assert P[THETA + 2, BG + 2] == before[THETA + 2, BG + 2] and P[THETA, VEL] == before[THETA, VEL]
