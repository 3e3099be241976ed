# SPDX-License-Identifier: BSD-3-Clause
"""From thrust to motor command: the curve of motor and propeller, the battery's voltage and the density of
the air.

Thrust of a motor at full voltage is taken as (1 - expo) c + expo c^2 of its command c (MOT_THST_EXPO);
command times voltage counts when the battery sags (MOT_BAT_VOLT_MAX). The laws below invert that.
"""

from __future__ import annotations

import math

from ....core.elementary import exp, log
from ....core.kernels import law
from ....core.scalars import constrain
from ...control.pid import lowpass_gain
from ...state import BatteryState, Estimate
from ..parameters.control import Motors
from .state import MotorsState

SLOW_DT = 0.1
"""Period of ``compensate`` [s]."""
_VOLTAGE_HZ = 0.5
_SAG_TIME = 0.5
_LAPSE = 2.25577e-5
_DENSITY_EXPONENT = 4.2559


@law
def air_density_ratio(altitude: float) -> float:
    """Density relative to sea level of the standard atmosphere at an altitude above it [m], below 11 km."""
    return exp(_DENSITY_EXPONENT * log(1.0 - _LAPSE * constrain(altitude, -1000.0, 11000.0)))


@law
def resting_voltage(motors: MotorsState, voltage: float, current: float) -> float:
    """Voltage [V] without the drop that a current [A] causes; learns the battery's resistance on the way.

    Changes of voltage against changes of current give the resistance, weighted with the size of the change;
    the drop since the highest voltage seen bounds it.
    """
    if current <= 0.0:
        return voltage
    motors.current_max = max(motors.current_max, current)
    if voltage > motors.voltage_reference:
        motors.voltage_reference = voltage
        motors.current_reference = current
    change = current - motors.current_slow
    if change != 0.0:
        found = -(voltage - motors.voltage_slow) / change
        weight = min(0.1 * abs(change) / motors.current_max, 1.0)
        if found > 0.0:
            motors.resistance += weight * (found - motors.resistance)
        extra = current - motors.current_reference
        drop = motors.voltage_reference - voltage
        if drop > 0.0 and extra > 0.0:
            motors.resistance = min(motors.resistance, drop / extra)
    k = SLOW_DT / (SLOW_DT + _SAG_TIME)
    motors.voltage_slow += k * (voltage - motors.voltage_slow)
    motors.current_slow += k * (current - motors.current_slow)
    return voltage + current * motors.resistance


@law
def compensate_voltage(motors: MotorsState, resting: float, p: Motors) -> None:
    """Voltage ratio and lift for a ``resting`` voltage [V] of a battery between MOT_BAT_VOLT_MIN and _MAX."""
    low, full = p.BAT_VOLT_MIN, p.BAT_VOLT_MAX
    if full <= 0.0 or low >= full or not resting >= 0.25 * low:
        motors.voltage_ratio = 1.0
        motors.lift_max = 1.0
        return
    ratio = constrain(resting, max(low, 0.6 * full), full) / full
    motors.voltage_ratio += lowpass_gain(_VOLTAGE_HZ, SLOW_DT) * (ratio - motors.voltage_ratio)
    e = constrain(p.THST_EXPO, -1.0, 1.0)
    v = motors.voltage_ratio
    motors.lift_max = v * (1.0 - e) + e * v * v


@law
def compensate(motors: MotorsState, battery: BatteryState, est: Estimate, p: Motors) -> None:
    """Voltage and density compensation, to be called every ``SLOW_DT``."""
    compensate_voltage(motors, resting_voltage(motors, battery.voltage, battery.current), p)
    gain = 1.0 / max(motors.lift_max, 0.1)
    if est.origin_set:
        gain /= constrain(air_density_ratio(est.origin_alt - est.pos.z), 0.5, 1.25)
    motors.compensation_gain = gain


@law
def command_from_thrust(thrust: float, expo: float, lift_max: float, voltage_ratio: float) -> float:
    """Motor command 0 .. 1 within the spin range that gives ``thrust`` 0 .. 1."""
    t = constrain(thrust, 0.0, 1.0) * lift_max
    e = constrain(expo, -1.0, 1.0)
    command = t
    if abs(e) > 1e-6:
        command = (e - 1.0 + math.sqrt(max((1.0 - e) * (1.0 - e) + 4.0 * e * t, 0.0))) / (2.0 * e)
    return constrain(command / voltage_ratio, 0.0, 1.0)
