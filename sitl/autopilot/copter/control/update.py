# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' part of the firmware: once at boot, and the last step of every tick."""

from __future__ import annotations

from ....core.kernels import inline_unit, law
from ....core.records import Records
from ...state import Actuators
from ..state import Autopilot, Vehicle
from . import motors, rate, throttle_mix
from .altitude_start import set_max_speed_accel_d
from .attitude import relax
from .position_start import set_max_speed_accel_ne


@law
def init(ap: Autopilot) -> None:
    """Filters, compensation and limits to sane starts (gains are read live from the parameters).

    Harmless when called again on the ground or after a parameter change.
    """
    p = ap.params
    control = ap.control
    if control.motors.compensation_gain <= 0.0:
        control.motors.voltage_ratio = 1.0
        control.motors.lift_max = 1.0
        control.motors.compensation_gain = 1.0
        control.attitude.mix = p.ATC.THR_MIX_MAN
        control.attitude.mix_desired = p.ATC.THR_MIX_MAN
        relax(ap)
    if control.pos_ne.speed_max <= 0.0:
        set_max_speed_accel_ne(ap, p.WPNAV.SPEED * 0.01, p.WPNAV.ACCEL * 0.01)
    if control.pos_d.speed_up <= 0.0:
        set_max_speed_accel_d(ap, p.WPNAV.SPEED_DN * 0.01, p.WPNAV.SPEED_UP * 0.01, p.WPNAV.ACCEL_Z * 0.01)


@law
def drive(ap: Autopilot, actuators: Actuators, time_us: int) -> None:
    """Follow ``attitude.rate_target`` and write the actuators; ``time_us`` since boot."""
    p = ap.params
    throttle_mix.follow_mix(ap.control.attitude, ap.control.motors, motors.hover_throttle(p.MOT))
    target, rates = ap.control.attitude.rate_target, ap.estimate.rates
    rate.control_rates(ap.control.rate, ap.control.motors, target, rates, p.ATC)
    motors.drive_motors(ap, time_us)
    armed = ap.arming.armed != 0
    motors.write_actuators(ap.control.motors, actuators, armed, int(p.MOT.PWM_MIN), int(p.MOT.PWM_MAX))
    ap.control.tick += 1


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """The same for vehicle ``i``."""
    v = fleet[i]
    drive(v.autopilot, v.actuators, v.time_us)
