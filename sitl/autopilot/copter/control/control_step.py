# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' part of the firmware: once at boot, and the last step of every tick."""

from __future__ import annotations

from ....core.kernels import inline_unit, law
from ....core.records import Records
from ...state import Actuators, Estimate
from ..parameters import Parameters
from ..state import Autopilot, Vehicle
from . import motors, rate, throttle_mix
from .altitude_start import set_max_speed_accel_d
from .attitude import relax
from .position_start import set_max_speed_accel_ne
from .state import DT, Control
from .thrust_curve import SLOW_DT, compensate
from .vibration_compensation import follow_height

_SLOW_TICKS = round(SLOW_DT / DT)


@law
def init(control: Control, est: Estimate, p: Parameters) -> None:
    """Filters, compensation and limits to sane starts (gains are read live from the parameters).

    Harmless when called again on the ground or after a parameter change.
    """
    if control.motors.compensation_gain <= 0.0:
        control.motors.voltage_ratio = 1.0
        control.motors.lift_max = 1.0
        control.motors.compensation_gain = 1.0
        control.attitude.mix = p.ATC.THR_MIX_MAN
        control.attitude.mix_desired = p.ATC.THR_MIX_MAN
        relax(control, est)
    if control.pos_ne.speed_max <= 0.0:
        set_max_speed_accel_ne(control.pos_ne, p, p.WPNAV.SPEED * 0.01, p.WPNAV.ACCEL * 0.01)
    if control.pos_d.speed_up <= 0.0:
        legs = p.WPNAV
        set_max_speed_accel_d(control.pos_d, p.PSC, legs.SPEED_DN * 0.01, legs.SPEED_UP * 0.01, legs.ACCEL_Z * 0.01)


@law
def drive(ap: Autopilot, actuators: Actuators, time_us: int) -> None:
    """Follow ``attitude.rate_target`` and write the actuators; ``time_us`` since boot."""
    control, p = ap.control, ap.params
    follow_height(control.vibration, ap.estimate)
    throttle_mix.follow_mix(control.attitude, control.motors, motors.hover_throttle(p.MOT))
    rate.control_rates(control.rate, control.motors, control.attitude.rate_target, ap.estimate.rates, p.ATC)
    if control.tick % _SLOW_TICKS == 0:
        compensate(control.motors, ap.battery, ap.estimate, p.MOT)
    motors.drive_motors(control.motors, ap.arming, p, time_us)
    motors.write_actuators(control.motors, actuators, ap.arming.armed, int(p.MOT.PWM_MIN), int(p.MOT.PWM_MAX))
    control.tick += 1


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """The same for vehicle ``i``."""
    v = fleet[i]
    drive(v.autopilot, v.actuators, v.time_us)
