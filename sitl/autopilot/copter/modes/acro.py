# SPDX-License-Identifier: BSD-3-Clause
"""ACRO: the sticks are body rates, the throttle drives the motors; a trainer levels it and limits its lean.

ACRO_TRAINER 1 turns back to level with the sticks centred, at ACRO_BAL_ROLL and ACRO_BAL_PITCH times the lean; 2 does
so whatever the sticks say, and pushes back beyond ANGLE_MAX. 0 holds the attitude that was reached.
"""

from __future__ import annotations

import math

from ....core.elementary import cos
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Euler, Vec2, Vec3
from ...control.shaping import sqrt_controller
from ...radio import expo
from .. import pilot
from ..control import attitude, throttle_mix
from ..control.attitude_error import body_rates
from ..control.attitude_target import accel_max
from ..control.motors import hover_throttle
from ..control.state import DT
from ..parameters import Parameters
from ..parameters.flight_modes import Acro
from ..state import Vehicle
from . import ground
from .mode import CopterMode
from .state import PilotState

ACRO = 1

# ACRO_TRAINER
OFF = 0
LEVELING = 1
LIMITED = 2

_LEVEL_MAX = math.radians(30.0)
"""Leans beyond this level no faster."""
_OVERSHOOT = math.radians(10.0)
"""LIMITED holds a full stick so far beyond ANGLE_MAX, where ATC_ACCEL_R_MAX and ATC_ACCEL_P_MAX allow that."""


@law
def stick_rates(sticks: PilotState, p: Acro) -> Vec3:
    """Body rates [rad/s] of the sticks: ACRO_RP_RATE, ACRO_Y_RATE and their expo; a diagonal is no faster."""
    rp = pilot.limit_stick(Vec2(sticks.roll, sticks.pitch), 1.0)
    fastest = math.radians(p.RP_RATE)
    yaw = math.radians(p.Y_RATE) * expo(sticks.yaw, p.Y_EXPO)
    return Vec3(fastest * expo(rp.x, p.RP_EXPO), fastest * expo(rp.y, p.RP_EXPO), yaw)


@law
def leveling_rate(angle: float, gain: float) -> float:
    """Rate [rad/s] back from a lean ``angle`` [rad] with ``gain`` [1/s]."""
    return -gain * constrain(angle, -_LEVEL_MAX, _LEVEL_MAX)


@law
def limiting_rate(angle: float, angle_max: float, rate_max: float, accel: float) -> float:
    """Rate [rad/s] back to ``angle_max`` [rad] that ``accel`` [rad/s^2] can stop; ``rate_max``: of a full stick."""
    excess = angle - constrain(angle, -angle_max, angle_max)
    return -sqrt_controller(excess, rate_max / _OVERSHOOT, accel, DT)


@law
def trained_rates(rates: Vec3, sticks: PilotState, lean: Euler, p: Parameters) -> Vec3:
    """The sticks' ``rates`` with the trainer's at the target attitude ``lean``."""
    trainer = int(p.ACRO.TRAINER)
    if trainer == OFF:
        return rates
    roll, pitch = leveling_rate(lean.roll, p.ACRO.BAL_ROLL), leveling_rate(lean.pitch, p.ACRO.BAL_PITCH)
    if trainer == LIMITED:
        fastest, angle_max, accel = math.radians(p.ACRO.RP_RATE), math.radians(p.ANGLE_MAX * 0.01), accel_max(p.ATC)
        roll += limiting_rate(lean.roll, angle_max, fastest, accel.x)
        pitch += limiting_rate(lean.pitch, angle_max, fastest, accel.y)
        return rates + body_rates(lean, Euler(roll, pitch, 0.0))
    stick = max(abs(sticks.roll), max(abs(sticks.pitch), abs(sticks.yaw)))
    share = constrain(1.0 - stick, 0.0, 1.0) * cos(lean.pitch)
    return rates + body_rates(lean, Euler(roll, pitch, 0.0)) * share


@law
def throttle(sticks: PilotState, p: Parameters) -> float:
    """Motor throttle 0 .. 1 that the stick asks for: ACRO_THR_MID in its middle, or that of hovering."""
    middle = p.ACRO.THR_MID if p.ACRO.THR_MID > 0.0 else hover_throttle(p.MOT)
    return pilot.throttle_out(sticks.throttle_filtered, pilot.throttle_middle(p), middle)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    control, sticks, p = ap.control, ap.modes.pilot, ap.params
    wanted = throttle(sticks, p)
    if ground.spool_by_stick(ap.arming, sticks.throttle_zero, control.motors):
        attitude.relax(control, ap.estimate)
        wanted = 0.0
    rates = stick_rates(sticks, p.ACRO)
    rates = trained_rates(rates, sticks, control.attitude.target_euler, p)
    attitude.input_rates(control, ap.estimate, p, rates)
    throttle_mix.set_throttle_out(control, p, wanted, False, p.PILOT.THR_FILT)


MODE = CopterMode(number=ACRO, name="ACRO", run=run, manual_throttle=True, needs_pilot=True, ignores_simple=True)
