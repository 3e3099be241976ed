# SPDX-License-Identifier: BSD-3-Clause
"""Motors: spooling up and down, throttle filter, hover throttle, and the way from demands to pulses.

Spool states and desired states carry ArduPilot's numbers. On the ground the motors idle at ``spin_up_ratio``
of MOT_SPIN_MIN (MOT_SPIN_ARM when idling armed); between SPOOLING_UP and SPOOLING_DOWN they follow the mixer
with the throttle limited to ``thrust_max``, which ramps over MOT_SPOOL_TIME.
"""

from __future__ import annotations

from ....core.kernels import inlined, law
from ....core.scalars import constrain, finite
from ...control.pid import lowpass_gain
from ...state import Actuators, Arming
from ..parameters import Parameters
from ..parameters.control import Motors
from .mixer import Boost, Demands, follow_boost, mix, mix_many, watch_balance
from .spool import DesiredSpoolState, SpoolState
from .state import DT, QUAD, MotorsState
from .thrust_curve import command_from_thrust

ARMING_DELAY_US = 2_000_000
"""Motors stand still for this long after arming [us]: time to step back (ArduPilot's)."""
_HOVER_TIME = 10.0  # time constant of hover-throttle learning [s]
_HOVER_MIN, _HOVER_MAX = 0.125, 0.6875  # range in which a hover throttle is believed


@law
def hover_throttle(p: Motors) -> float:
    """Throttle 0 .. 1 that holds the vehicle in the air (MOT_THST_HOVER, learnt in flight)."""
    return constrain(p.THST_HOVER, _HOVER_MIN, _HOVER_MAX)


@law
def learn_hover_throttle(p: Motors, throttle: float, dt: float) -> None:
    """One step of learning, to be called every ``dt`` [s] while hovering level (MOT_HOVER_LEARN not 0)."""
    if p.HOVER_LEARN == 0.0 or throttle <= 0.0:
        return
    hover = p.THST_HOVER
    p.THST_HOVER = constrain(hover + dt / (dt + _HOVER_TIME) * (throttle - hover), _HOVER_MIN, _HOVER_MAX)


@law
def set_limits(motors: MotorsState, value: bool) -> None:
    """All limit flags at once."""
    motors.limit_roll = value
    motors.limit_pitch = value
    motors.limit_yaw = value
    motors.limit_throttle_lower = value
    motors.limit_throttle_upper = value


@law
def spool(motors: MotorsState, enabled: bool, p: Motors) -> None:
    """One tick of the spool state machine.

    ``enabled`` is false while disarmed and during the arming delay: then the motors stand.
    """
    if not enabled:
        motors.desired_spool = DesiredSpoolState.SHUT_DOWN
        motors.spool_state = SpoolState.SHUT_DOWN
    up = DT / max(p.SPOOL_TIME, 0.05)
    down = DT / max(p.SPOOL_TIM_DN, 0.05) if p.SPOOL_TIM_DN > 0.0 else up
    state = motors.spool_state
    desired = motors.desired_spool
    if state == SpoolState.SHUT_DOWN:
        set_limits(motors, True)
        motors.boosting, motors.boost_ratio = False, 0.0
        motors.spin_up_ratio = 0.0
        motors.thrust_max = 0.0
        if desired != DesiredSpoolState.SHUT_DOWN:
            motors.spool_state = SpoolState.GROUND_IDLE
    elif state == SpoolState.GROUND_IDLE:
        set_limits(motors, True)
        motors.boosting, motors.boost_ratio = False, 0.0
        ratio = motors.spin_up_ratio
        if desired == DesiredSpoolState.SHUT_DOWN:
            ratio = max(ratio - down, 0.0)
            if ratio <= 0.0:
                motors.spool_state = SpoolState.SHUT_DOWN
        elif desired == DesiredSpoolState.GROUND_IDLE:
            idle = p.SPIN_ARM / p.SPIN_MIN if p.SPIN_MIN > 0.0 else 0.0
            ratio += constrain(idle - ratio, -down, up)
        else:
            ratio = min(ratio + up, 1.0)
            if ratio >= 1.0 and not motors.blocked:
                motors.spool_state = SpoolState.SPOOLING_UP
        motors.spin_up_ratio = ratio
        motors.thrust_max = 0.0
    elif state == SpoolState.SPOOLING_UP:
        set_limits(motors, False)
        motors.boosting = False
        motors.spin_up_ratio = 1.0
        if desired != DesiredSpoolState.THROTTLE_UNLIMITED:
            motors.spool_state = SpoolState.SPOOLING_DOWN
            return
        motors.thrust_max += up
        if motors.thrust_max >= min(motors.throttle, 1.0):
            motors.thrust_max = 1.0
            motors.spool_state = SpoolState.THROTTLE_UNLIMITED
    elif state == SpoolState.THROTTLE_UNLIMITED:
        set_limits(motors, False)
        motors.spin_up_ratio = 1.0
        motors.thrust_max = 1.0
        if motors.boosting or motors.boost_ratio > 0.0:
            follow_boost(motors, up, down)
        if desired != DesiredSpoolState.THROTTLE_UNLIMITED:
            motors.spool_state = SpoolState.SPOOLING_DOWN
    else:
        set_limits(motors, False)
        motors.boosting, motors.boost_ratio = False, 0.0
        motors.spin_up_ratio = 1.0
        if desired == DesiredSpoolState.THROTTLE_UNLIMITED:
            motors.spool_state = SpoolState.SPOOLING_UP
            return
        motors.thrust_max = max(motors.thrust_max - down, 0.0)
        if motors.thrust_max <= 0.0:
            motors.spool_state = SpoolState.GROUND_IDLE


@law
def filter_throttle(motors: MotorsState, armed: bool) -> None:
    """Low-pass of the throttle demand at ``throttle_filter_hz``."""
    if not armed:
        motors.throttle = 0.0
        return
    new = motors.throttle + lowpass_gain(motors.throttle_filter_hz, DT) * (motors.throttle_in - motors.throttle)
    motors.throttle = constrain(new, 0.0, 1.0)


@law
def slew(old: float, new: float, time_up: float, time_down: float) -> float:
    """Command limited to full range within MOT_SLEW_UP_TIME / MOT_SLEW_DN_TIME [s] (0: unlimited)."""
    if time_up > 0.0:
        new = min(new, old + DT / time_up)
    if time_down > 0.0:
        new = max(new, old - DT / time_down)
    return new


@inlined
def command_motors(motors: MotorsState, count: int, p: Motors) -> None:
    """``motors.actuator`` of the first ``count`` from the spool state and the mixer's thrusts."""
    state = motors.spool_state
    span = p.SPIN_MAX - p.SPIN_MIN
    for k in range(count):
        if state == SpoolState.SHUT_DOWN:
            motors.actuator[k] = 0.0
            continue
        wanted = motors.spin_up_ratio * p.SPIN_MIN
        if state != SpoolState.GROUND_IDLE:
            thrust = motors.thrust[k] if finite(motors.thrust[k]) else 0.0
            command = command_from_thrust(thrust, p.THST_EXPO, motors.lift_max, motors.voltage_ratio)
            wanted = p.SPIN_MIN + span * command
        motors.actuator[k] = slew(motors.actuator[k], wanted, p.SLEW_UP_TIME, p.SLEW_DN_TIME)


@law
def compensated_demands(motors: MotorsState) -> Demands:
    """Demands of the controllers, for the thrust that this voltage and this air leave."""
    gain = motors.compensation_gain
    return Demands(
        motors.roll * gain,
        motors.pitch * gain,
        motors.yaw * gain,
        motors.throttle * gain,
        motors.throttle_avg_max * gain,
        min(motors.thrust_max * gain, 1.0),
    )


@law
def drive_test_motor(motors: MotorsState) -> None:
    """The motor under test turns, the others stand."""
    for k in range(motors.count):
        motors.actuator[k] = motors.test_actuator if k + 1 == motors.test_motor else 0.0


@law
def may_turn(arming: Arming) -> bool:
    """Whether the motors may turn: armed, and no switch forbids it."""
    return arming.armed and not arming.emergency_stop and (arming.interlock_on or not arming.interlock_used)


@law
def drive_motors(motors: MotorsState, arming: Arming, p: Parameters, time_us: int) -> None:
    """Everything between the demands of the controllers and ``motors.actuator``; ``time_us`` since boot."""
    filter_throttle(motors, arming.armed)
    spool(motors, may_turn(arming) and time_us - arming.armed_us >= ARMING_DELAY_US, p.MOT)
    if motors.spool_state == SpoolState.SHUT_DOWN:
        motors.throttle_out = 0.0
    else:
        demands = compensated_demands(motors)
        if motors.is_plain_quad:
            out = mix(motors, QUAD, demands, p.MOT.YAW_HEADROOM * 0.001, Boost(-1, 0.0))
            if motors.boosting:
                watch_balance(motors, out, demands.throttle_max)
        else:
            out = mix_many(motors, demands, p.MOT.YAW_HEADROOM * 0.001)
        motors.throttle_out = out / motors.compensation_gain
    if motors.is_plain_quad:
        command_motors(motors, QUAD, p.MOT)
    else:
        command_motors(motors, motors.count, p.MOT)
    if motors.test_motor != 0:
        drive_test_motor(motors)


@law
def write_actuators(motors: MotorsState, actuators: Actuators, armed: bool, pwm_min: int, pwm_max: int) -> None:
    """Pulses between ``pwm_min`` and ``pwm_max`` [us] and 0 .. 1 controls; disarmed motors get ``pwm_min`` and 0."""
    shortest, span = (pwm_min, pwm_max - pwm_min) if pwm_max > pwm_min else (1000, 1000)
    actuators.armed = armed
    if motors.is_plain_quad:
        for k in range(QUAD):
            write_output(actuators, k, shortest + int(span * motors.actuator[k]), armed)
    else:
        for k in range(motors.count):
            if motors.output[k] >= 0:
                write_output(actuators, motors.output[k], shortest + int(span * motors.actuator[k]), armed)


@inlined
def write_output(actuators: Actuators, output: int, pulse: int, armed: bool) -> None:
    """One pulse [us], and the control that it stands for."""
    actuators.pwm[output] = pulse
    actuators.controls[output] = constrain((pulse - 1000) * 0.001, 0.0, 1.0) if armed else 0.0
