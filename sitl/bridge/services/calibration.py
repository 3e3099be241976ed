# SPDX-License-Identifier: BSD-3-Clause
"""Calibration of gyros and accelerometers at rest, as MAV_CMD_PREFLIGHT_CALIBRATION asks for it.

Accelerometers are calibrated level ("simple", "level"), or in six positions: clients are sent the position (a text,
and MAV_CMD_ACCELCAL_VEHICLE_POS once a second), and answer with that command, or with any COMMAND_ACK, when the vehicle
is in it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...autopilot.calibration_fit import fit_accelerometer
from ...autopilot.estimation.alignment import CALIBRATE, initialise
from ...autopilot.estimation.strapdown import tilt_from_acc
from ...autopilot.sensor_calibration import ACCELS_DONE, corrected_acc, mounted
from ...core.constants import GRAVITY, NEVER
from ...core.mavlink import MavResult, MavSeverity
from ...core.vectors import Vec3
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .parameter_protocol import ParameterService
from .service import Handler, Service
from .statustext import StatusTextService

COMMAND_LONG = message("COMMAND_LONG")
VEHICLE_POS = 42429
"""MAV_CMD_ACCELCAL_VEHICLE_POS"""
POSITIONS = ("level", "on its LEFT side", "on its RIGHT side", "nose DOWN", "nose UP", "on its BACK")
SUCCESS, FAILURE = 16777215, 16777216
"""ACCELCAL_VEHICLE_POS"""
TICK_US, REPORT_US = 2_500, 1_000_000
SAMPLES = 400
"""A second of them at each position."""
MOST_TRIM = math.radians(10.0)
MOST_OFFSET, LEAST_SCALE, MOST_SCALE, MOST_ERROR = 3.5, 0.8, 1.2, 0.1
"""Of accelerometers whose calibration counts [m/s^2], [1], [1], [m/s^2]."""
GYROS, LEVEL, SIMPLE, POSITION = "gyros", "level", "simple", "position"


class CalibrationService(Service):
    """Gyros and accelerometers."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._task = ""
        """What is being measured; "": nothing."""
        self._sum = np.zeros(6)
        self._count = 0
        self._means: list[tuple[float, ...]] = []
        """Accelerations at the positions so far."""
        self._waits = 0
        """Number of the position that clients are asked for, or the result that they are told; 0: none."""
        self._report_us = NEVER

    def handlers(self) -> dict[str, Handler]:
        return {"COMMAND_ACK": self._acknowledged}

    def snapshot(self) -> Any:
        return (
            self._task, tuple(self._sum.tolist()), self._count, tuple(self._means), self._waits, self._report_us,
            self.due_us,
        )  # fmt: skip

    def restore(self, state: Any) -> None:
        self._task, total, self._count, means, self._waits, self._report_us, self.due_us = state
        self._sum, self._means = np.array(total), list(means)

    # ------------------------------------------------------------------ what it is asked

    def start(self, task: str) -> int:
        """Begin to measure GYROS, LEVEL or SIMPLE. Its MAV_RESULT."""
        if self._task or 0 < self._waits <= len(POSITIONS):
            return MavResult.TEMPORARILY_REJECTED
        if task == LEVEL and max(map(abs, self._trim(self._shown()[:3]))) > MOST_TRIM:
            return MavResult.FAILED
        self._measure(task)
        return MavResult.ACCEPTED

    def start_positions(self) -> int:
        """Begin with the first of six positions. Its MAV_RESULT."""
        if self._task:
            return MavResult.TEMPORARILY_REJECTED
        self._means = []
        self._ask(1)
        return MavResult.ACCEPTED

    def is_in_position(self, number: float) -> int:
        """A client says that the vehicle is in a position. The MAV_RESULT."""
        if self._task or number != self._waits or not 0 < self._waits <= len(POSITIONS):
            return MavResult.FAILED
        self._measure(POSITION)
        return MavResult.ACCEPTED

    def _acknowledged(self, channel: Channel, m: Any, sender: Sender) -> None:
        self.is_in_position(self._waits)

    # ------------------------------------------------------------------ over time

    def _measure(self, task: str) -> None:
        self._task, self._sum, self._count = task, np.zeros(6), 0
        self.due_us = self.bridge.now_us + TICK_US

    def _ask(self, number: int) -> None:
        """Ask for a position, or tell a result."""
        self._waits, self._report_us = number, self.bridge.now_us
        self.due_us = min(self.due_us, self._report_us)
        if number <= len(POSITIONS):
            text = f"Place vehicle {POSITIONS[number - 1]} and press any key."
            self.bridge.get(StatusTextService).say(MavSeverity.CRITICAL, text)

    def service(self, now_us: int) -> None:
        if self._task:
            self._sum += self._shown()
            self._count += 1
            if self._count == SAMPLES:
                self._finish(self._sum / SAMPLES)
        if now_us >= self._report_us:
            position = COMMAND_LONG.payload(command=VEHICLE_POS, param1=float(self._waits))
            self.bridge.broadcast(COMMAND_LONG, position)
            self._report_us = now_us + REPORT_US
        self.due_us = min(self._report_us, now_us + TICK_US if self._task else NEVER)

    def _shown(self) -> np.ndarray[Any, Any]:
        """Specific force [m/s^2] and rates [rad/s], as shown."""
        sensors = self.bridge.vehicle.v.sensors
        return np.array((*sensors.acc, *sensors.gyro))

    def _finish(self, mean: np.ndarray[Any, Any]) -> None:
        task, self._task = self._task, ""
        acc = mean[:3]
        if task == GYROS:
            self._set_gyros(mean[3:])
        elif task == SIMPLE:
            self._set_accelerometer(acc - (0.0, 0.0, -GRAVITY), np.ones(3))
            self._set("AHRS_TRIM", (0.0, 0.0))
            self._align(acc)
        elif task == LEVEL:
            roll, pitch = self._trim(acc)
            self._set("AHRS_TRIM", (roll, pitch))
            text = f"Trim OK: roll={math.degrees(roll):.2f} pitch={math.degrees(pitch):.2f} yaw=0.00"
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, text)
        else:
            self._means.append(tuple(acc.tolist()))
            if len(self._means) < len(POSITIONS):
                self._ask(len(self._means) + 1)
            else:
                self._fit()

    def _fit(self) -> None:
        fit = fit_accelerometer(np.array(self._means))
        good = (
            fit.fitness < MOST_ERROR
            and max(map(abs, fit.offset)) < MOST_OFFSET
            and min(fit.scale) >= LEAST_SCALE
            and max(fit.scale) <= MOST_SCALE
        )
        say: Callable[[int, str], None] = self.bridge.get(StatusTextService).say
        if good:
            self._set_accelerometer(np.array(fit.offset), np.array(fit.scale))
            self._set("AHRS_TRIM", self._trim(np.array(self._means[0])))
            self._align(np.array(self._means[-1]))
            self.bridge.vehicle.v.autopilot.calibrated.state |= ACCELS_DONE
        say(MavSeverity.CRITICAL, "Calibration successful" if good else "Calibration FAILED")
        self._ask(SUCCESS if good else FAILURE)

    def _trim(self, shown: np.ndarray[Any, Any]) -> tuple[float, float]:
        """Roll and pitch [rad] of the autopilot in a level vehicle."""
        tilt = tilt_from_acc(corrected_acc(Vec3(*shown.tolist()), self.bridge.vehicle.v.autopilot.params))
        return tilt.roll, tilt.pitch

    def _align(self, shown: np.ndarray[Any, Any]) -> None:
        """The estimator begins anew: what it has learnt of the accelerometer holds no more."""
        ap = self.bridge.vehicle.v.autopilot
        if ap.ekf.phase != CALIBRATE:
            ap.ekf.good_acc = mounted(corrected_acc(Vec3(*shown.tolist()), ap.params), ap.params.AHRS)
            initialise(ap.ekf)

    def _set_gyros(self, rates: np.ndarray[Any, Any]) -> None:
        ap = self.bridge.vehicle.v.autopilot
        before = ap.params.INS.GYROFFS
        change = rates - (before.X, before.Y, before.Z)
        self._set("INS_GYROFFS", rates)
        ap.ekf.gyro_bias = tuple(np.array(tuple(ap.ekf.gyro_bias)) - change)

    def _set_accelerometer(self, offset: np.ndarray[Any, Any], scale: np.ndarray[Any, Any]) -> None:
        self._set("INS_ACCOFFS", offset)
        self._set("INS_ACCSCAL", scale)

    def _set(self, group: str, values: Any) -> None:
        parameters: ParameterService = self.bridge.get(ParameterService)
        for axis, value in zip("XYZ", values, strict=False):
            parameters.set(f"{group}_{axis}", float(value))
