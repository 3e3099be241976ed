# SPDX-License-Identifier: BSD-3-Clause
"""Vibration of the rotors, as IMUs show it (SIM_VIB_MOT_*): sines of each rotor's speed and of multiples of it."""

from __future__ import annotations

import math

from ....core.border import Sensors
from ....core.constants import TICK_S
from ....core.elementary import cos
from ....core.kernels import law
from ....core.vectors import Vec3
from ....vehicles.properties.multicopter import THRUST_MOMENTUM, Properties
from ..sensors.imu_faults import saturate
from .state import Rotors

HARMONICS = 8
"""Bits of SIM_VIB_MOT_HMNC that count."""
_TURN = 2.0 * math.pi


@law
def turn(rotors: Rotors, airframe: Properties) -> float:
    """Turn the rotors by a tick; gives the sum of their sines, each of amplitude 1, as means over the tick.

    Their angles at the start are those of Schroeder (IEEE Trans. Inf. Theory 16(1), 1970): n rotors of the same speed
    shake as much as n that have nothing to do with each other, the square root of n times one.
    """
    top = 1.0 if airframe.thrust_model == THRUST_MOMENTUM else airframe.speed_max
    total, per_speed, mask = 0.0, _TURN * TICK_S * rotors.rpm_max / (60.0 * top), int(rotors.vibrating)
    for k in range(airframe.rotor_count):
        phase, angle = float(rotors.phase[k]), per_speed * rotors.speed[k]
        rotors.phase[k] = phase + angle - _TURN * math.floor((phase + angle) / _TURN)
        before = phase + math.pi * k * k / airframe.rotor_count
        if angle <= 0.0 or (mask != 0 and not mask >> k & 1):
            continue
        for h in range(HARMONICS):
            if int(rotors.harmonics) >> h & 1:
                n = h + 1.0
                total += (cos(n * before) - cos(n * (before + angle))) / (n * angle)
    return total


@law
def shake(rotors: Rotors, sensors: Sensors, airframe: Properties) -> None:
    """Add the vibration to what the IMUs show."""
    wave = turn(rotors, airframe)
    unit = Vec3(wave, wave, wave)
    if rotors.acc_shake[0] != 0.0:
        sensors.acc = saturate(sensors.acc + float(rotors.acc_shake[0]) * unit, airframe.acc_range)
    if rotors.acc_shake[1] != 0.0:
        sensors.acc2 = saturate(sensors.acc2 + float(rotors.acc_shake[1]) * unit, airframe.acc_range)
    if rotors.gyro_shake[0] != 0.0:
        sensors.gyro = saturate(sensors.gyro + float(rotors.gyro_shake[0]) * unit, airframe.gyro_range)
    if rotors.gyro_shake[1] != 0.0:
        sensors.gyro2 = saturate(sensors.gyro2 + float(rotors.gyro_shake[1]) * unit, airframe.gyro_range)
