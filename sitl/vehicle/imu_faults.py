# SPDX-License-Identifier: BSD-3-Clause
"""What SIM_ACC*, SIM_GYR* and SIM_VIB_FREQ do to the IMUs."""

from __future__ import annotations

import math

from ..autopilot.params.simulation import Axes, Simulated, axes
from ..core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER, Sensors
from ..core.memory import words_of
from ..core.vectors import Vec3
from ..physics.native.records import ImuFault, SensorState


def _acc(fault: ImuFault, bias: Axes, scale: Axes, noise: float, stuck: float) -> None:
    fault.acc_bias = axes(bias)
    fault.acc_stretch = Vec3(*(1.0 / k - 1.0 if k else 0.0 for k in axes(scale)))
    fault.acc_noise, fault.acc_stuck = noise, stuck


def _gyro(fault: ImuFault, bias: Axes, scale: Axes, noise: float) -> None:
    fault.gyro_bias, fault.gyro_stretch, fault.gyro_noise = axes(bias), 0.01 * axes(scale), math.radians(noise)


def apply(sim: Simulated, sensors: SensorState, border: Sensors) -> None:
    """Bring both IMUs in line with the parameters."""
    first, second = sensors.imus[0], sensors.imus[1]
    _acc(first, sim.ACC1_BIAS, sim.ACC1_SCAL, sim.ACC1_RND, sim.ACCEL1_FAIL)
    _acc(second, sim.ACC2_BIAS, sim.ACC2_SCAL, sim.ACC2_RND, sim.ACCEL2_FAIL)
    _gyro(first, sim.GYR1_BIAS, sim.GYR1_SCALE, sim.GYR1_RND)
    _gyro(second, sim.GYR2_BIAS, sim.GYR2_SCALE, sim.GYR2_RND)
    sensors.vibration_hz = axes(sim.VIB_FREQ)
    silent = (int(sim.GYR_FAIL_MSK) & 3) * GYRO_SILENT | (int(sim.ACC_FAIL_MSK) & 3) * ACC_SILENT
    noisy = any((sim.ACC1_RND, sim.ACC2_RND, sim.GYR1_RND, sim.GYR2_RND))
    words = words_of(first).tolist()
    alike = words == words_of(second).tolist() and not noisy
    sensors.imu_state = silent | (0 if alike and not silent else IMUS_DIFFER)
    sensors.imus_faulty = sensors.imu_state != 0 or any(words)
    border.imu_state = sensors.imu_state
