# SPDX-License-Identifier: BSD-3-Clause
"""What two IMUs show when something is wrong with one of them, or with both (SIM_ACC*, SIM_GYR*, SIM_VIB_FREQ).

Both feel the same and have the same small errors; they differ by their faults alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import by_component
from ....core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER, Sensors
from ....core.constants import TICK_S
from ....core.elementary import cos
from ....core.kernels import law
from ....core.rng import Rng, normal_vector
from ....core.vectors import Vec3
from ..records import ImuFault, Physics

WHITE = 0.1
"""Standard deviation of white noise, of the noise that is asked for; where the frame vibrates that is an amplitude."""
MOTORS_TURN = 0.3
"""Current besides that of the avionics above which motors turn [A]."""
_TURN = 2.0 * math.pi


class Sample(NamedTuple):
    """Of an accelerometer and a gyro, body."""

    acc: Vec3  # [m/s^2]
    gyro: Vec3  # [rad/s]


@law
def saturate(value: Vec3, bound: float) -> Vec3:
    """``value`` with each component within +-``bound``; NaN stays."""
    x, y, z = value.x, value.y, value.z
    return Vec3(min(max(x, -bound), bound), min(max(y, -bound), bound), min(max(z, -bound), bound))


@law
def wave(hz: float, time: float) -> float:
    """Mean over the tick that ends at ``time`` [s] of a sine of this frequency and amplitude 1."""
    if hz <= 0.0:
        return 0.0
    rate = _TURN * hz
    return (cos(rate * (time - TICK_S)) - cos(rate * time)) / (rate * TICK_S)


@law
def shake(amplitude: float, hz: Vec3, time: float, rng: Rng) -> Vec3:
    """What noise of this amplitude makes: a vibration of these frequencies, or, without any, white noise."""
    if hz.x == 0.0 and hz.y == 0.0 and hz.z == 0.0:
        return WHITE * amplitude * normal_vector(rng)
    return amplitude * Vec3(wave(hz.x, time), wave(hz.y, time), wave(hz.z, time))


@law
def faulty(fault: ImuFault, good: Sample, truth: Sample, shakes: bool, hz: Vec3, time: float, rng: Rng) -> Sample:
    """What an IMU shows that would show ``good`` of ``truth``; ``shakes``: motors turn; ``time`` [s]."""
    acc = good.acc + by_component(truth.acc, fault.acc_stretch) + fault.acc_bias
    gyro = good.gyro + by_component(truth.gyro, fault.gyro_stretch) + fault.gyro_bias
    if shakes and fault.acc_noise > 0.0:
        acc += shake(fault.acc_noise, hz, time, rng)
    if shakes and fault.gyro_noise > 0.0:
        gyro += shake(fault.gyro_noise, hz, time, rng)
    if fault.acc_stuck != 0.0:
        acc = Vec3(fault.acc_stuck, fault.acc_stuck, fault.acc_stuck)
    return Sample(acc, gyro)


@law
def show(p: Physics, sensors: Sensors, rng: Rng, good: Sample, truth: Sample) -> None:
    """Write acc, gyro, acc2, gyro2 and imu_state; what is silent goes on to show its last sample."""
    s, a, time = p.sensors, p.airframe, 1e-6 * sensors.time_us
    state, turns = s.imu_state, p.battery.current > a.avionics_current + MOTORS_TURN
    sensors.imu_state = state
    first = faulty(s.imus[0], good, truth, turns, s.vibration_hz, time, rng)
    if state & ACC_SILENT == 0:
        sensors.acc = saturate(first.acc, a.acc_range)
    if state & GYRO_SILENT == 0:
        sensors.gyro = saturate(first.gyro, a.gyro_range)
    if state & IMUS_DIFFER == 0:
        return
    second = faulty(s.imus[1], good, truth, turns, s.vibration_hz, time, rng)
    if state & 2 * ACC_SILENT == 0:
        sensors.acc2 = saturate(second.acc, a.acc_range)
    if state & 2 * GYRO_SILENT == 0:
        sensors.gyro2 = saturate(second.gyro, a.gyro_range)
