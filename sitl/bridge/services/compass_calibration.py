# SPDX-License-Identifier: BSD-3-Clause
"""Calibration of compasses: by turning the vehicle in all directions, or from a known heading.

While the vehicle turns, samples that lie apart from each other are kept; when there are enough of them, offsets and the
matrix against soft iron are fitted so that all are as long as the earth's field. MAG_CAL_PROGRESS and MAG_CAL_REPORT
report it ten times a second.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np

from ...autopilot.calibration_fit import CompassFit, fit_compass, sphere
from ...autopilot.params.simulation import DELIVERED
from ...autopilot.sensor_calibration import COMPASS_DONE, COMPASS_RUNNING
from ...core.algebra import norm, quat_from_euler, rotate_inverse
from ...core.constants import NEVER
from ...core.earth_field import field_ned
from ...core.mavlink import MavResult, MavSeverity
from ...core.sums import lengths, matrix_product
from ...core.vectors import Euler, Vec3
from ..dialect import message
from ..host import Host
from .parameter_protocol import ParameterService
from .service import Service
from .statustext import StatusTextService

PROGRESS, REPORT = message("MAG_CAL_PROGRESS"), message("MAG_CAL_REPORT")
COMPASSES = 3
WAITING, FIRST_STEP, SECOND_STEP, SUCCESS, FAILURE, BAD_RADIUS = 1, 2, 3, 4, 5, 7
"""MAG_CAL_STATUS"""
SAMPLES, FIRST_SAMPLES = 300, 50
SPACING = 0.12
"""Least distance of two samples, of the field's strength: 300 lie so in half of all directions or more."""
LEAST_RADIUS, MOST_RADIUS = 150.0, 950.0
"""Strength of a field that can be the earth's [mGauss]."""
LOOK_US, REPORT_US = 20_000, 100_000


def _sections() -> np.ndarray[Any, Any]:
    """Directions of 80 triangles of equal rank: an icosahedron's faces, each of four."""
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    corners = [(0.0, a, b * golden) for a, b in itertools.product((-1.0, 1.0), repeat=2)]
    points = np.array([np.roll(p, k) for p in corners for k in range(3)])
    faces = [
        np.array(face) for face in itertools.combinations(points, 3)
        if all(lengths(a - b) < 2.1 for a, b in itertools.combinations(face, 2))
    ]  # fmt: skip
    found = [sub for face in faces for sub in (face.sum(axis=0), *(face.sum(axis=0) + 3.0 * corner for corner in face))]
    return np.array([section / lengths(section) for section in found])


SECTIONS = _sections()


class State(NamedTuple):
    """How far the calibration of one compass is."""

    status: int
    attempt: int = 1
    samples: tuple[tuple[float, float, float], ...] = ()
    """[mGauss]"""
    fit: CompassFit | None = None
    is_saved: bool = False

    @property
    def is_running(self) -> bool:
        """Whether samples are taken."""
        return self.status in (WAITING, FIRST_STEP, SECOND_STEP)


class CompassCalibrationService(Service):
    """Calibration of compasses."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._states: dict[int, State] = {}
        """By number of the compass."""
        self._retries = self._saves = self._reboots = False
        self._start_us = self._report_us = 0

    def snapshot(self) -> Any:
        states = tuple((k, *s[:3], s.fit and tuple(s.fit), s.is_saved) for k, s in self._states.items())
        return (states, self._retries, self._saves, self._reboots, self._start_us, self._report_us, self.due_us)

    def restore(self, state: Any) -> None:
        states, self._retries, self._saves, self._reboots, self._start_us, self._report_us, self.due_us = state
        self._states = {
            k: State(status, attempt, samples, fit and CompassFit(*fit), is_saved)
            for k, status, attempt, samples, fit, is_saved in states
        }

    # ------------------------------------------------------------------ what it is asked

    def start(self, mask: float, retries: bool, saves: bool, delay: float, reboots: bool) -> int:
        """Begin with the compasses in ``mask`` (0: all) after ``delay`` [s]. Its MAV_RESULT."""
        if self.bridge.autopilot.armed():
            self.bridge.get(StatusTextService).say(MavSeverity.NOTICE, "Disarm to allow compass calibration")
            return MavResult.FAILED
        chosen = self._chosen(mask)
        if chosen is None:
            return MavResult.FAILED
        if any(state.is_running for state in self._states.values()):
            return MavResult.ACCEPTED
        self._retries, self._saves, self._reboots = retries, saves, reboots
        self._states = {k: State(WAITING) for k in chosen}
        now = self.bridge.now_us
        self._start_us, self._report_us, self.due_us = now + round(1e6 * max(delay, 0.0)), now, now
        self._mark(COMPASS_RUNNING)
        return MavResult.ACCEPTED

    def accept(self, mask: float) -> int:
        """Take over what was found. Its MAV_RESULT: FAILED while one of them is without success."""
        chosen = self._chosen(mask)
        states = [(k, self._states[k]) for k in chosen or () if k in self._states]
        if chosen is None or any(state.status != SUCCESS for _, state in states):
            return MavResult.FAILED
        for k, state in states:
            self._save(k, state)
            del self._states[k]
        self._rest()
        return MavResult.ACCEPTED

    def cancel(self, mask: float) -> int:
        """Stop. Its MAV_RESULT."""
        chosen = self._chosen(mask)
        if chosen is None:
            return MavResult.FAILED
        for k in chosen:
            self._states.pop(k, None)
        self._rest()
        return MavResult.ACCEPTED

    def use_heading(self, yaw: float, mask: float, lat: float, lon: float) -> int:
        """Find the offsets from a true heading [deg] at a location [deg] (0, 0: where it is). The MAV_RESULT."""
        ap, chosen = self.bridge.vehicle.v.autopilot, self._chosen(mask)
        if lat == 0.0 and lon == 0.0:
            if not ap.estimate.origin_set:
                return MavResult.FAILED
            lat, lon = 1e-7 * ap.estimate.origin_lat, 1e-7 * ap.estimate.origin_lon
        if chosen is None or not (abs(lat) <= 90.0 and abs(lon) <= 180.0):
            return MavResult.FAILED
        euler = ap.estimate.euler
        attitude = quat_from_euler(Euler(euler.roll, euler.pitch, math.radians(yaw)))
        field = rotate_inverse(attitude, Vec3(*field_ned(lat, lon)))
        for k in chosen:
            offset = 1e3 * np.array(tuple(field)) - self._shown(k)
            self._set(k, CompassFit(tuple(offset.tolist()), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0, 0.0))
        return MavResult.ACCEPTED

    @staticmethod
    def _chosen(mask: float) -> list[int] | None:
        """Numbers of the compasses in a mask; None when it has others."""
        if not (0.0 <= mask < 1 << COMPASSES):
            return None
        return [k for k in range(COMPASSES) if not int(mask) or int(mask) >> k & 1]

    # ------------------------------------------------------------------ over time

    def service(self, now_us: int) -> None:
        if now_us >= self._start_us:
            for k, state in self._states.items():
                if state.is_running:
                    self._states[k] = self._sampled(k, state)
        if not any(state.is_running for state in self._states.values()):
            self._unmark()
        if now_us >= self._report_us:
            self._report_us = now_us + REPORT_US
            for k, state in self._states.items():
                self._report(k, state)
        if self._reboots and self._states and all(state.is_saved for state in self._states.values()):
            self.bridge.vehicle.request_reboot()
        self.due_us = now_us + LOOK_US if self._states else NEVER

    def _sampled(self, k: int, state: State) -> State:
        """With the sample of now, and fitted when there are enough."""
        sample = self._shown(k)
        if state.samples:
            apart = lengths(np.array(state.samples) - sample).min()
            if apart < SPACING * (self._strength() or 500.0):
                return state
        samples = (*state.samples, tuple(sample.tolist()))
        if len(samples) < SAMPLES:
            return state._replace(status=FIRST_STEP if len(samples) < FIRST_SAMPLES else SECOND_STEP, samples=samples)
        fit = fit_compass(np.array(samples), self._strength())
        status = self._judged(fit)
        if status != SUCCESS and self._retries:
            return State(WAITING, state.attempt + 1)
        done = state._replace(status=status, samples=samples, fit=fit)
        if status == SUCCESS and self._saves:
            self._save(k, done)
            done = done._replace(is_saved=True)
        return done

    def _judged(self, fit: CompassFit) -> int:
        params = self.bridge.vehicle.v.autopilot.params.COMPASS
        if not LEAST_RADIUS < fit.radius < MOST_RADIUS:
            return BAD_RADIUS
        return SUCCESS if fit.fitness < params.CAL_FIT and max(map(abs, fit.offset)) < params.OFFS_MAX else FAILURE

    def _strength(self) -> float | None:
        """Of the earth's field where the vehicle is [mGauss]; None before it knows its location."""
        estimate = self.bridge.vehicle.v.autopilot.estimate
        if not estimate.origin_set:
            return None
        return 1e3 * norm(field_ned(1e-7 * estimate.origin_lat, 1e-7 * estimate.origin_lon))

    def _shown(self, k: int) -> np.ndarray[Any, Any]:
        """What a compass shows without any correction [mGauss]."""
        sensors = self.bridge.vehicle.v.sensors
        shown = 1e3 * np.array(tuple((sensors.mag, sensors.mag2, sensors.mag3)[k]))
        return shown if k else shown - np.array(tuple(DELIVERED))

    # ------------------------------------------------------------------ results

    def _save(self, k: int, state: State) -> None:
        if state.fit is not None and not state.is_saved:
            self._set(k, state.fit)
            self._mark(COMPASS_DONE)

    def _set(self, k: int, fit: CompassFit) -> None:
        parameters: ParameterService = self.bridge.get(ParameterService)
        number = str(k + 1) if k else ""
        for group, values in (("OFS", fit.offset), ("DIA", fit.diagonal), ("ODI", fit.others)):
            for axis, value in zip("XYZ", values, strict=True):
                parameters.set(f"COMPASS_{group}{number}_{axis}", value)

    def _rest(self) -> None:
        """Nothing to do any more, unless other compasses are still being calibrated."""
        if not any(state.is_running for state in self._states.values()):
            self._unmark()
        if not self._states:
            self.due_us = NEVER

    def _mark(self, bit: int) -> None:
        self.bridge.vehicle.v.autopilot.calibrated.state |= bit

    def _unmark(self) -> None:
        self.bridge.vehicle.v.autopilot.calibrated.state &= ~COMPASS_RUNNING

    def _report(self, k: int, state: State) -> None:
        mask = sum(1 << number for number in self._states)
        fit = state.fit
        if fit is None:
            percent = 100 * len(state.samples) // SAMPLES
            covered = self._covered(state)
            fields = {"attempt": state.attempt, "completion_pct": percent, "completion_mask": covered}
            self.bridge.broadcast(
                PROGRESS, PROGRESS.payload(compass_id=k, cal_mask=mask, cal_status=state.status, **fields)
            )
            return
        names = ("ofs_{}", "diag_{}", "offdiag_{}")
        found = {
            name.format(axis): value
            for name, values in zip(names, (fit.offset, fit.diagonal, fit.others), strict=True)
            for axis, value in zip("xyz", values, strict=True)
        }
        fields = {"autosaved": int(state.is_saved), "fitness": fit.fitness, "scale_factor": 1.0, **found}
        self.bridge.broadcast(REPORT, REPORT.payload(compass_id=k, cal_mask=mask, cal_status=state.status, **fields))

    @staticmethod
    def _covered(state: State) -> list[int]:
        """completion_mask: a bit for each of 80 directions of the field in which there is a sample."""
        covered = np.zeros(len(SECTIONS), dtype=bool)
        if len(state.samples) >= FIRST_SAMPLES:
            samples = np.array(state.samples)
            covered[np.argmax(matrix_product(samples - sphere(samples)[0], SECTIONS.T), axis=1)] = True
        packed: list[int] = np.packbits(covered, bitorder="little").tolist()
        return packed
