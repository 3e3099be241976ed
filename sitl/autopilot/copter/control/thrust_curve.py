# SPDX-License-Identifier: BSD-3-Clause
"""From thrust to motor command: the curve of motor and propeller, the battery's voltage and the density of
the air.

Thrust of a motor at full voltage is taken as (1 - expo) c + expo c^2 of its command c (MOT_THST_EXPO);
command times voltage counts when the battery sags (MOT_BAT_VOLT_MAX). The laws below invert that.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ...control.pid import lowpass_gain

SLOW_DT = 0.1
"""Period of ``update_slow`` [s]."""
_VOLTAGE_HZ = 0.5
_SAG_TIME = 0.5
_LAPSE = 2.25577e-5
_DENSITY_EXPONENT = 4.2559


@law
def air_density_ratio(altitude):
    """Density relative to sea level of the standard atmosphere, altitude above mean sea level [m], below 11
    km.
    """
    return math.exp(_DENSITY_EXPONENT * math.log(1.0 - _LAPSE * constrain(altitude, -1000.0, 11000.0)))


@law
def resting_voltage(motors, voltage, current):
    """Voltage [V] without the drop that the present current causes; learns the battery's resistance on the
    way.

    Changes of voltage against changes of current give the resistance, weighted with the size of the change;
    the drop since the highest voltage seen bounds it.
    """
    if current <= 0.0:
        return voltage
    motors.current_most = max(float(motors.current_most), current)
    if voltage > motors.voltage_reference:
        motors.voltage_reference = voltage
        motors.current_reference = current
    change = current - float(motors.current_slow)
    if change != 0.0:
        found = -(voltage - float(motors.voltage_slow)) / change
        weight = min(0.1 * abs(change) / float(motors.current_most), 1.0)
        if found > 0.0:
            motors.resistance += weight * (found - float(motors.resistance))
        extra = current - float(motors.current_reference)
        drop = float(motors.voltage_reference) - voltage
        if drop > 0.0 and extra > 0.0:
            motors.resistance = min(float(motors.resistance), drop / extra)
    k = SLOW_DT / (SLOW_DT + _SAG_TIME)
    motors.voltage_slow += k * (voltage - float(motors.voltage_slow))
    motors.current_slow += k * (current - float(motors.current_slow))
    return voltage + current * float(motors.resistance)


@law
def update_slow(ap):
    """Voltage and density compensation, to be called every ``SLOW_DT``."""
    p = ap.params
    motors = ap.control.motors
    resting = resting_voltage(motors, float(ap.battery.voltage), float(ap.battery.current))
    most = float(p.MOT.BAT_VOLT_MAX)
    least = float(p.MOT.BAT_VOLT_MIN)
    if most <= 0.0 or least >= most or not resting >= 0.25 * least:
        motors.voltage_ratio = 1.0
        motors.lift_max = 1.0
    else:
        ratio = constrain(resting, max(least, 0.6 * most), most) / most
        motors.voltage_ratio += lowpass_gain(_VOLTAGE_HZ, SLOW_DT) * (ratio - float(motors.voltage_ratio))
        expo = constrain(float(p.MOT.THST_EXPO), -1.0, 1.0)
        v = float(motors.voltage_ratio)
        motors.lift_max = v * (1.0 - expo) + expo * v * v
    gain = 1.0 / max(float(motors.lift_max), 0.1)
    if ap.estimate.origin_set != 0:
        density = air_density_ratio(float(ap.estimate.origin_alt) - float(ap.estimate.pos[2]))
        gain /= constrain(density, 0.5, 1.25)
    motors.compensation_gain = gain


@law
def command_from_thrust(thrust, expo, lift_max, voltage_ratio):
    """Motor command 0 .. 1 within the spin range that gives ``thrust`` 0 .. 1."""
    t = constrain(thrust, 0.0, 1.0) * lift_max
    e = constrain(expo, -1.0, 1.0)
    command = t
    if abs(e) > 1e-6:
        command = (e - 1.0 + math.sqrt(max((1.0 - e) * (1.0 - e) + 4.0 * e * t, 0.0))) / (2.0 * e)
    return constrain(command / voltage_ratio, 0.0, 1.0)
