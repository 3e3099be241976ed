# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot of a copter in the air learns at once what it would learn by flying: the lean and the throttle that
hold it in another wind, or with other properties."""

from __future__ import annotations

from ...core.algebra import multiply, rotate
from ...core.border import Actuators
from ...core.constants import GRAVITY
from ...core.kernels import law
from ...core.scalars import constrain
from ...core.vectors import Quat, Vec2, Vec3
from .control.attitude_target import set_target
from .control.motors import hover_throttle
from .control.spool import SpoolState
from .control.state import Control, MotorsState
from .parameters import Parameters
from .parameters.control import Motors
from .state import Autopilot

_MIN, _MAX = 0.125, 0.6875
"""Range in which a hover throttle is believed, as it is learnt."""


@law
def is_flying(motors: MotorsState) -> bool:
    """Whether the motors follow the mixer."""
    return SpoolState.SPOOLING_UP <= motors.spool_state <= SpoolState.THROTTLE_UNLIMITED


@law
def thrust_of(control: float, motors: MotorsState, p: Motors) -> float:
    """Thrust 0 .. 1 that the autopilot takes a motor to give at an actuator control 0 .. 1."""
    shortest, span = (p.PWM_MIN, p.PWM_MAX - p.PWM_MIN) if p.PWM_MAX > p.PWM_MIN else (1000.0, 1000.0)
    actuator = (1000.0 * control + 1000.0 - shortest) / span
    command = (actuator - p.SPIN_MIN) / (p.SPIN_MAX - p.SPIN_MIN) * motors.voltage_ratio
    expo = constrain(p.THST_EXPO, -1.0, 1.0)
    return ((1.0 - expo) * command + expo * command * command) / motors.lift_max


@law
def total_thrust(motors: MotorsState, actuators: Actuators, p: Motors) -> float:
    """The same of all motors, summed."""
    total = 0.0
    for k in range(motors.count):
        total += thrust_of(float(actuators.controls[motors.output[k]]), motors, p)
    return total


@law
def lean_acceleration(q: Quat) -> Vec2:
    """Horizontal acceleration [m/s^2] that level flight at an attitude gives."""
    up = rotate(q, Vec3(0.0, 0.0, -1.0))
    return Vec2(-GRAVITY * up.x / up.z, -GRAVITY * up.y / up.z)


@law
def lean(ap: Autopilot, turn: Quat) -> None:
    """The body has leant by ``turn`` (NED): the estimate knows, attitude and velocity loops ask for it."""
    ap.ekf.q = multiply(turn, ap.ekf.q)
    ap.second_lane.ekf.q = multiply(turn, ap.second_lane.ekf.q)
    ap.estimate.q = multiply(turn, ap.estimate.q)
    attitude, position = ap.control.attitude, ap.control.pos_ne
    before = lean_acceleration(attitude.target_q)
    set_target(attitude, multiply(turn, attitude.target_q))
    change = lean_acceleration(attitude.target_q) - before
    position.vel_integrator += change
    position.accel_target += change


@law
def scale_throttle(control: Control, p: Parameters, ratio: float, lift: float) -> None:
    """All thrusts by ``ratio``; the throttle before the boost for lean by ``lift``."""
    motors, attitude, altitude = control.motors, control.attitude, control.pos_d
    hover = hover_throttle(p.MOT)
    learnt = hover if p.MOT.HOVER_LEARN == 0.0 else constrain(hover * lift, _MIN, _MAX)
    altitude.accel.integrator = learnt - lift * (hover - altitude.accel.integrator)
    p.MOT.THST_HOVER = learnt
    attitude.throttle_in *= lift
    motors.throttle_in *= ratio
    motors.throttle *= ratio
    motors.throttle_out *= ratio
    motors.throttle_avg_max = min(motors.throttle_avg_max * ratio, 1.0)
    for k in range(motors.count):
        motors.thrust[k] *= ratio
    control.rate.roll.integrator *= ratio
    control.rate.pitch.integrator *= ratio
    control.rate.yaw.integrator *= ratio


@law
def set_outputs(motors: MotorsState, actuators: Actuators, p: Motors) -> None:
    """Pulses and commands of the motors from ``actuators.controls``."""
    shortest, span = (p.PWM_MIN, p.PWM_MAX - p.PWM_MIN) if p.PWM_MAX > p.PWM_MIN else (1000.0, 1000.0)
    for k in range(motors.count):
        output = motors.output[k]
        pulse = 1000.0 + 1000.0 * float(actuators.controls[output])
        motors.actuator[k] = (pulse - shortest) / span
        actuators.pwm[output] = int(pulse)


@law
def trim(ap: Autopilot, actuators: Actuators, turn: Quat, thrust_was: float) -> None:
    """Follow a body that leant by ``turn`` (NED) and whose rotors got other controls; ``thrust_was``: ``total_thrust``
    before."""
    cosine = rotate(ap.estimate.q, Vec3(0.0, 0.0, 1.0)).z
    lean(ap, turn)
    now = rotate(ap.estimate.q, Vec3(0.0, 0.0, 1.0)).z
    ap.control.attitude.cos_lean = now
    ratio = total_thrust(ap.control.motors, actuators, ap.params.MOT) / thrust_was
    set_outputs(ap.control.motors, actuators, ap.params.MOT)
    scale_throttle(ap.control, ap.params, ratio, ratio * now / cosine)
