# SPDX-License-Identifier: BSD-3-Clause
"""PX4's parameters for a copter of ours, from the properties of its airframe.

Its control allocator scales torques so that what a rate loop commands, 1, moves each rotor's thrust by a known part of
the greatest one (``ControlAllocationPseudoInverse``: roll and pitch by the root of their mean square, yaw to 1). With
the inertia this is the angular acceleration of a whole command, and gains follow from where loops shall cross over.
Frames whose rotors are not placed symmetrically get gains that are near.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.constants import GRAVITY, TICK_HZ
from ..core.elementary import hypot
from ..core.sums import products
from ..vehicles import Airframe, CopterAirframe
from ..vehicles.properties.multicopter import THRUST_MOMENTUM

AIR_DENSITY = 1.225
"""[kg/m^3]"""
RATE_CROSSOVER, YAW_CROSSOVER = 25.0, 6.0
"""Where rate loops of roll and pitch, and of yaw, cross over [rad/s]. PX4 low-passes the yaw torque at 2 Hz."""
FILTERS_S = 0.005
"""Delay of gyro filters and loop, for which D makes up together with the rotors' lag [s]."""
LEAST_NOISE, MOST_NOISE = 0.1, 0.5
"""Of EKF2_GPS_P_NOISE, the least error of a fix that its filter believes in: ArduPilot's value with RTK, and PX4's own
[m]."""
HEIGHT_ERROR = 0.1
"""Of a receiver whose height is good enough without a range-finder [m]."""
_NEAR_ZERO = 1e-3


class Thrust(NamedTuple):
    """Of one rotor."""

    most: float
    """[N]"""
    hover: float
    """Share of it that hovers."""
    curve: float
    """THR_MDL_FAC: thrust goes with curve c^2 + (1 - curve) c of the command c."""
    arm: float
    """Yaw torque by thrust, about the hover [m]."""
    lag_s: float
    """Of the rotors' speed [s]."""


def thrust(airframe: CopterAirframe) -> Thrust:
    """What its rotors do."""
    value = airframe.value
    weight = float(value("mass")) * GRAVITY / len(airframe.rotors)
    if int(value("thrust_model")) == THRUST_MOMENTUM:
        speed = float(value("outflow_speed_max"))
        most = 0.5 * AIR_DENSITY * float(value("outflow_area")) * speed * speed
        hover, curve = weight / most, float(value("thrust_expo"))
        linear = 1.0 - curve
        command = (math.sqrt(linear * linear + 4.0 * curve * hover) - linear) / (2.0 * curve) if curve else hover
        # Its yaw torque goes with thrust times command: this is how it changes with thrust.
        arm = float(value("yaw_lever")) * (command + hover / (linear + 2.0 * curve * command))
        return Thrust(most, hover, curve, arm, 0.0)
    speed = float(value("speed_max"))
    most = float(value("thrust_coefficient")) * speed * speed
    lag = 0.5 * (float(value("time_constant_up")) + float(value("time_constant_down")))
    return Thrust(most, weight / most, 1.0, float(value("moment_coefficient")), lag)


def accelerations(airframe: CopterAirframe, rotor: Thrust) -> tuple[float, float, float]:
    """Angular acceleration of a whole command in roll, pitch and yaw [rad/s^2]."""

    def scale(levers: list[float]) -> float:
        used = len([lever for lever in levers if abs(lever) > _NEAR_ZERO])
        return math.sqrt(2.0 / (used * float(products(levers, levers)))) if used else 0.0

    xs, ys = [r.x for r in airframe.rotors], [r.y for r in airframe.rotors]
    both = max(scale(xs), scale(ys)) or 1.0
    ixx, iyy, izz = (float(x) for x in airframe.value("inertia"))
    return rotor.most / (both * ixx), rotor.most / (both * iyy), len(xs) * rotor.most * rotor.arm / izz


def receiver(airframe: Airframe) -> dict[str, float]:
    """Parameters that fit PX4 to what the receiver of an airframe is like: how late its fixes are, and how good.

    With a good receiver (RTK, motion capture) its height is not taken from a range-finder, as ArduPilot's with
    EK3_RNG_USE_HGT -1: by default PX4 does so below 1 m/s, and with each change learns another bias of the receiver's
    height. In a hover that is corrected all the time its height went off by 0.7 m in 20 s. With another receiver that
    default stays: without the range-finder the height is 0.6 m off after a take-off.
    """
    error, height_error = (
        hypot(float(airframe.value(f"gps_noise_{axis}")), float(airframe.value(f"gps_drift_{axis}")))
        for axis in ("horizontal", "vertical")
    )
    return {
        **({"EKF2_RNG_CTRL": 0.0} if height_error < HEIGHT_ERROR else {}),
        "SENS_GPS0_DELAY": round(1000.0 * float(airframe.value("gps_delay"))),
        "EKF2_GPS_P_NOISE": min(max(error, LEAST_NOISE), MOST_NOISE),
    }


def parameters(airframe: CopterAirframe) -> dict[str, float]:
    """Parameters with which PX4 flies this airframe: its rotors, their thrust, and gains.

    What pulse is full thrust PX4 need not know: over the HIL link it says parts of each motor's range
    (``bridge.hil.physics_end``).
    """
    rotor = thrust(airframe)
    values: dict[str, float] = {"CA_AIRFRAME": 0, "CA_ROTOR_COUNT": len(airframe.rotors)}
    for k, hub in enumerate(airframe.rotors):
        values |= {
            f"CA_ROTOR{k}_PX": hub.x,
            f"CA_ROTOR{k}_PY": hub.y,
            f"CA_ROTOR{k}_KM": rotor.arm * hub.direction,
            f"PWM_MAIN_FUNC{k + 1}": 101 + k,
        }
    values |= {"THR_MDL_FAC": rotor.curve, "MPC_THR_HOVER": rotor.hover}
    crossovers = (RATE_CROSSOVER, RATE_CROSSOVER, YAW_CROSSOVER)
    for axis, crossover, gain in zip(("ROLL", "PITCH", "YAW"), crossovers, accelerations(airframe, rotor)):
        p = crossover / gain
        values |= {
            f"MC_{axis}RATE_P": p,
            f"MC_{axis}RATE_I": p * crossover / 8.0,
            f"MC_{axis}RATE_D": 0.0 if axis == "YAW" else p * (rotor.lag_s + FILTERS_S),
            f"MC_{axis}_P": crossover / (3.0 if axis == "YAW" else 4.0),
        }
    if "BATT_CAPACITY" in airframe.parameters:
        values["BAT1_CAPACITY"] = float(airframe.parameters["BATT_CAPACITY"])
    values["IMU_INTEG_RATE"] = TICK_HZ  # its estimator then runs at each tick, which lockstep waits for
    return values | {"NAV_DLL_ACT": 0, "NAV_RCL_ACT": 0, "COM_RC_IN_MODE": 4}  # no ground station, no sticks
