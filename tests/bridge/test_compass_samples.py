# SPDX-License-Identifier: BSD-3-Clause
"""Calibration of compasses step by step, of readings that are written here: samples, verdicts, what is reported."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.calibration_fit import CompassFit
from sitl.autopilot.sensor_calibration import COMPASS_DONE, COMPASS_RUNNING
from sitl.bridge.services import compass_calibration as calibration
from sitl.bridge.services.compass_calibration import SECTIONS, CompassCalibrationService, State
from sitl.core.constants import NEVER
from sitl.core.mavlink import MavResult

WAITING, FIRST, SECOND, SUCCESS, FAILURE, BAD_RADIUS = 1, 2, 3, 4, 5, 7
"""MAG_CAL_STATUS"""
FIT = CompassFit((10.0, -20.0, 30.0), (1.1, 1.2, 1.3), (0.01, 0.02, 0.03), 5.0, 500.0)


class Bench:
    """The service without a vehicle: readings, clock and parameters are the test's."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.set: dict[str, float] = {}
        self.sent: list[tuple[Any, Any]] = []
        self.texts: list[str] = []
        self.reboots = 0
        self.is_armed = False
        self.now_us = 1_000_000
        self.v: Any = SimpleNamespace(autopilot=SimpleNamespace(
            estimate=SimpleNamespace(origin_set=False),
            params=SimpleNamespace(COMPASS=SimpleNamespace(CAL_FIT=16.0, OFFS_MAX=1800.0)),
            calibrated=SimpleNamespace(state=0),
        ))  # fmt: skip
        self.vehicle = SimpleNamespace(v=self.v, request_reboot=self._reboot)
        self.autopilot = SimpleNamespace(armed=lambda: self.is_armed)
        self.service: Any = object.__new__(CompassCalibrationService)
        self.service.bridge, self.service._states, self.service.due_us = self, {}, NEVER
        self.service._retries = self.service._saves = self.service._reboots = False
        self.service._start_us = self.service._report_us = 0
        self.reading = np.zeros(3)
        monkeypatch.setattr(CompassCalibrationService, "_shown", lambda service, k: self.reading)

    def _reboot(self) -> None:
        self.reboots += 1

    def get(self, kind: Any) -> Any:
        return SimpleNamespace(set=self.set.__setitem__, say=lambda severity, text: self.texts.append(text))

    def broadcast(self, kind: Any, payload: Any) -> None:
        self.sent.append((kind.name, kind.decode(payload)))

    @property
    def running(self) -> bool:
        return bool(self.v.autopilot.calibrated.state & COMPASS_RUNNING)


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(monkeypatch)


def directions(count: int, strength: float = 500.0) -> Any:
    """Spread evenly over a sphere (a Fibonacci lattice)."""
    k = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * k / count, math.pi * (1.0 + math.sqrt(5.0)) * k
    level = np.sqrt(1.0 - z * z)
    return strength * np.stack([level * np.cos(angle), level * np.sin(angle), z], 1)


# ---------------------------------------------------------------- directions


def test_the_mask_has_a_bit_for_each_of_eighty_directions() -> None:
    assert SECTIONS.shape == (80, 3)
    assert np.linalg.norm(SECTIONS, axis=1) == pytest.approx(1.0)
    apart = np.degrees(np.arccos(np.clip(SECTIONS @ SECTIONS.T, -1.0, 1.0)))[~np.eye(80, dtype=bool)].reshape(80, 79)
    assert apart.min() > 15.0 and apart.min(axis=1).max() < 25.0, "evenly"
    assert SECTIONS.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


@pytest.mark.parametrize(("count", "share"), [(0, 0.0), (49, 0.0), (50, 0.4), (300, 1.0)])
def test_directions_are_covered_from_fifty_samples_on(count: int, share: float) -> None:
    samples = tuple(map(tuple, directions(count) + (100.0, -50.0, 20.0))) if count else ()
    mask = CompassCalibrationService._covered(State(FIRST, samples=samples))
    assert len(mask) == 10
    bits = sum(bin(byte).count("1") for byte in mask)
    assert bits == 0 if share == 0.0 else bits >= 80 * share


def test_half_of_all_directions_are_half_of_the_bits() -> None:
    """Readings of a vehicle that was only turned about an axis do not fill the mask, whichever its offset."""
    up = np.array([row for row in directions(400) if row[2] > -10.0])
    down = directions(4)[-1:]
    samples = tuple(map(tuple, np.concatenate([up, down])))
    mask = CompassCalibrationService._covered(State(SECOND, samples=samples))
    assert 36 <= sum(bin(byte).count("1") for byte in mask) <= 60


# ---------------------------------------------------------------- asked


@pytest.mark.parametrize(
    ("mask", "chosen"),
    [(0.0, [0, 1, 2]), (1.0, [0]), (2.0, [1]), (4.0, [2]), (5.0, [0, 2]), (7.0, [0, 1, 2]), (8.0, None), (-1.0, None),
     (math.nan, None)],
)  # fmt: skip
def test_compasses_of_a_mask(mask: float, chosen: Any) -> None:
    assert CompassCalibrationService._chosen(mask) == chosen


def test_a_calibration_begins_after_its_delay(bench: Bench) -> None:
    service = bench.service
    assert service.start(3.0, False, False, 2.0, False) == MavResult.ACCEPTED and bench.running
    assert set(service._states) == {0, 1} and service.due_us == bench.now_us
    for now, count in ((2_999_999, 0), (3_000_000, 1)):
        service.service(now)
        assert [len(state.samples) for state in service._states.values()] == [count, count]
        assert service.due_us == now + 20_000
    assert service.start(4.0, False, False, 0.0, False) == MavResult.ACCEPTED and set(service._states) == {0, 1}


@pytest.mark.parametrize(
    ("armed", "mask", "texts"), [(True, 0.0, ["Disarm to allow compass calibration"]), (False, 8.0, [])]
)
def test_armed_or_of_compasses_that_are_not_there_none_begins(
    bench: Bench, armed: bool, mask: float, texts: list[str]
) -> None:
    bench.is_armed = armed
    assert bench.service.start(mask, False, False, 0.0, False) == MavResult.FAILED
    assert bench.texts == texts and not bench.running and bench.service.due_us == NEVER


def test_what_was_found_is_taken_over_when_all_have_success(bench: Bench) -> None:
    service = bench.service
    service._states = {0: State(SUCCESS, fit=FIT), 1: State(FAILURE, fit=FIT)}
    assert service.accept(0.0) == MavResult.FAILED == service.accept(2.0) == service.accept(9.0) and bench.set == {}
    assert service.accept(1.0) == MavResult.ACCEPTED and set(service._states) == {1}
    assert bench.set == {
        "COMPASS_OFS_X": 10.0, "COMPASS_OFS_Y": -20.0, "COMPASS_OFS_Z": 30.0, "COMPASS_DIA_X": 1.1,
        "COMPASS_DIA_Y": 1.2, "COMPASS_DIA_Z": 1.3, "COMPASS_ODI_X": 0.01, "COMPASS_ODI_Y": 0.02,
        "COMPASS_ODI_Z": 0.03,
    }  # fmt: skip
    assert bench.v.autopilot.calibrated.state & COMPASS_DONE
    service._states = {2: State(SUCCESS, fit=FIT)}
    service.due_us = 5
    assert service.accept(0.0) == MavResult.ACCEPTED and service.due_us == NEVER
    assert bench.set["COMPASS_OFS3_X"] == 10.0 and "COMPASS_OFS2_X" not in bench.set


def test_a_calibration_goes_on_from_its_state(bench: Bench) -> None:
    service = bench.service
    service.start(3.0, True, False, 2.0, True)
    service._states[0] = State(SUCCESS, 2, ((1.0, 2.0, 3.0),), FIT, True)
    held, before = service.snapshot(), dict(vars(service), _states=dict(service._states))
    service.cancel(0.0)
    service.start(4.0, False, True, 0.0, False)
    service.restore(held)
    assert vars(service) == before and hash(held)


def test_a_calibration_is_cancelled_for_some_or_all(bench: Bench) -> None:
    service = bench.service
    service.start(0.0, False, False, 0.0, False)
    assert service.cancel(8.0) == MavResult.FAILED and len(service._states) == 3
    assert service.cancel(1.0) == MavResult.ACCEPTED and set(service._states) == {1, 2} and bench.running
    assert service.cancel(0.0) == MavResult.ACCEPTED and service._states == {}
    assert not bench.running and service.due_us == NEVER


# ---------------------------------------------------------------- samples


@pytest.mark.parametrize(("apart", "taken"), [(59.0, False), (60.0, True), (61.0, True)])
def test_samples_lie_apart_by_their_share_of_the_field(bench: Bench, apart: float, taken: bool) -> None:
    """0.12 of 500 mGauss, where the field is not known."""
    bench.reading = np.array([500.0 + apart, 0.0, 0.0])
    found = bench.service._sampled(0, State(FIRST, samples=((500.0, 0.0, 0.0), (0.0, 500.0, 0.0))))
    assert len(found.samples) == 2 + taken


@pytest.mark.parametrize(("before", "status"), [(0, FIRST), (48, FIRST), (49, SECOND), (298, SECOND)])
def test_the_second_step_begins_with_fifty_samples(bench: Bench, before: int, status: int) -> None:
    bench.reading = np.array([0.0, 0.0, -5000.0])
    state = State(WAITING, samples=tuple(map(tuple, directions(before) if before else ())))
    found = bench.service._sampled(0, state)
    assert (found.status, len(found.samples), found.is_running) == (status, before + 1, True)


@pytest.mark.parametrize(
    ("radius", "fitness", "offset", "status"),
    [
        (500.0, 15.9, 100.0, SUCCESS),
        (500.0, 16.0, 100.0, FAILURE),
        (500.0, 5.0, 1799.0, SUCCESS),
        (500.0, 5.0, 1800.0, FAILURE),
        (500.0, 5.0, -1800.0, FAILURE),
        (150.0, 5.0, 0.0, BAD_RADIUS),
        (151.0, 5.0, 0.0, SUCCESS),
        (949.0, 5.0, 0.0, SUCCESS),
        (950.0, 5.0, 0.0, BAD_RADIUS),
    ],
)
def test_a_fit_is_judged_by_compass_cal_fit_offs_max_and_the_earths_field(
    bench: Bench, radius: float, fitness: float, offset: float, status: int
) -> None:
    fit = FIT._replace(offset=(0.0, offset, 0.0), fitness=fitness, radius=radius)
    assert bench.service._judged(fit) == status


@pytest.mark.parametrize(
    ("fitness", "retries", "saves", "status", "attempt", "saved"),
    [
        (5.0, False, False, SUCCESS, 1, False),
        (5.0, False, True, SUCCESS, 1, True),
        (99.0, False, True, FAILURE, 1, False),
        (99.0, True, True, WAITING, 2, False),
    ],
)
def test_with_three_hundred_samples_it_is_fitted_and_saved_or_begins_anew(
    bench: Bench, monkeypatch: Any, fitness: float, retries: bool, saves: bool, status: int, attempt: int, saved: bool
) -> None:
    monkeypatch.setattr(calibration, "fit_compass", lambda samples, strength: FIT._replace(fitness=fitness))
    service = bench.service
    service._retries, service._saves, service._reboots = retries, saves, True
    bench.reading = np.array([0.0, 0.0, -5000.0])
    service._states = {0: State(SECOND, samples=tuple(map(tuple, directions(299))))}
    bench.v.autopilot.calibrated.state = COMPASS_RUNNING
    service.service(2_000_000)
    found = service._states[0]
    assert (found.status, found.attempt, found.is_saved, bool(bench.set)) == (status, attempt, saved, saved)
    assert bench.running == retries and bench.reboots == int(saved)


# ---------------------------------------------------------------- reports


def test_progress_is_told_ten_times_a_second(bench: Bench) -> None:
    service = bench.service
    service.start(5.0, False, False, 10.0, False)
    for now in range(1_000_000, 1_200_001, 20_000):
        service.service(now)
    assert len(bench.sent) == 3 * 2
    names, fields = zip(*bench.sent[:2], strict=True)
    assert names == ("MAG_CAL_PROGRESS",) * 2 and [told.compass_id for told in fields] == [0, 2]
    assert {(told.cal_mask, told.cal_status, told.attempt, told.completion_pct) for told in fields} == {(5, 1, 1, 0)}


@pytest.mark.parametrize(("count", "percent"), [(1, 0), (3, 1), (150, 50), (299, 99)])
def test_completion_is_the_share_of_samples(bench: Bench, count: int, percent: int) -> None:
    bench.service._states = {1: State(SECOND, 3, samples=tuple(map(tuple, directions(count))))}
    bench.service._report(1, bench.service._states[1])
    ((_, told),) = bench.sent
    assert (told.completion_pct, told.attempt, told.cal_mask, told.compass_id) == (percent, 3, 2, 1)


def test_the_end_is_told_with_all_that_was_fitted(bench: Bench) -> None:
    state = State(SUCCESS, fit=FIT, is_saved=True)
    bench.service._states = {0: state}
    bench.service._report(0, state)
    ((name, told),) = bench.sent
    assert name == "MAG_CAL_REPORT" and (told.cal_status, told.autosaved, told.cal_mask) == (SUCCESS, 1, 1)
    assert (told.ofs_x, told.ofs_y, told.ofs_z, told.fitness) == (10.0, -20.0, 30.0, 5.0)
    assert (told.diag_y, told.offdiag_z, told.scale_factor) == pytest.approx((1.2, 0.03, 1.0))
