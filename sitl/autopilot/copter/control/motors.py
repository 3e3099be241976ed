# SPDX-License-Identifier: BSD-3-Clause
"""Motors: spooling up and down, throttle filter, hover throttle, and the way from demands to pulses.

Spool states and desired states carry ArduPilot's numbers. On the ground the motors idle at ``spin_up_ratio``
of MOT_SPIN_MIN (MOT_SPIN_ARM when idling armed); between SPOOLING_UP and SPOOLING_DOWN they follow the mixer
with the throttle limited to ``thrust_max``, which ramps over MOT_SPOOL_TIME.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite
from ...control.pid import lowpass_gain
from .mixer import mix
from .state import DT
from .thrust_curve import SLOW_DT, command_from_thrust, update_slow

# desired_spool
DESIRED_SHUT_DOWN, DESIRED_GROUND_IDLE, DESIRED_THROTTLE_UNLIMITED = 0, 1, 2
# spool_state
SHUT_DOWN, GROUND_IDLE, SPOOLING_UP, THROTTLE_UNLIMITED, SPOOLING_DOWN = 0, 1, 2, 3, 4

MOTORS = 4
ARMING_DELAY_US = 2_000_000
"""Motors stand still for this long after arming [us]: time to step back (ArduPilot's)."""
_SLOW_TICKS = round(SLOW_DT / DT)
_HOVER_TIME = 10.0  # time constant of hover-throttle learning [s]
_HOVER_MIN, _HOVER_MAX = 0.125, 0.6875  # range in which a hover throttle is believed


@law
def hover_throttle(ap):
    """Throttle 0 .. 1 that holds the vehicle in the air (MOT_THST_HOVER, learnt in flight)."""
    return constrain(float(ap.params.MOT.THST_HOVER), _HOVER_MIN, _HOVER_MAX)


@law
def learn_hover_throttle(ap, dt):
    """One step of learning, to be called every ``dt`` while hovering level (MOT_HOVER_LEARN not 0)."""
    throttle = float(ap.control.motors.throttle)
    if ap.params.MOT.HOVER_LEARN == 0.0 or throttle <= 0.0:
        return
    hover = float(ap.params.MOT.THST_HOVER)
    ap.params.MOT.THST_HOVER = constrain(hover + dt / (dt + _HOVER_TIME) * (throttle - hover), _HOVER_MIN, _HOVER_MAX)


@law
def set_limits(motors, value):
    """All limit flags at once."""
    motors.limit_roll = value
    motors.limit_pitch = value
    motors.limit_yaw = value
    motors.limit_throttle_lower = value
    motors.limit_throttle_upper = value


@law
def spool(motors, enabled, spool_time, spool_time_down, idle_ratio):
    """One tick of the spool state machine; ``idle_ratio`` is MOT_SPIN_ARM over MOT_SPIN_MIN, times in
    seconds.

    ``enabled`` is false while disarmed and during the arming delay: then the motors stand.
    """
    if not enabled:
        motors.desired_spool = DESIRED_SHUT_DOWN
        motors.spool_state = SHUT_DOWN
    up = DT / max(spool_time, 0.05)
    down = DT / max(spool_time_down, 0.05) if spool_time_down > 0.0 else up
    state = int(motors.spool_state)
    desired = int(motors.desired_spool)
    if state == SHUT_DOWN:
        set_limits(motors, 1)
        motors.spin_up_ratio = 0.0
        motors.thrust_max = 0.0
        if desired != DESIRED_SHUT_DOWN:
            motors.spool_state = GROUND_IDLE
    elif state == GROUND_IDLE:
        set_limits(motors, 1)
        ratio = float(motors.spin_up_ratio)
        if desired == DESIRED_SHUT_DOWN:
            ratio = max(ratio - down, 0.0)
            if ratio <= 0.0:
                motors.spool_state = SHUT_DOWN
        elif desired == DESIRED_GROUND_IDLE:
            ratio += constrain(idle_ratio - ratio, -down, up)
        else:
            ratio = min(ratio + up, 1.0)
            if ratio >= 1.0:
                motors.spool_state = SPOOLING_UP
        motors.spin_up_ratio = ratio
        motors.thrust_max = 0.0
    elif state == SPOOLING_UP:
        set_limits(motors, 0)
        motors.spin_up_ratio = 1.0
        if desired != DESIRED_THROTTLE_UNLIMITED:
            motors.spool_state = SPOOLING_DOWN
            return
        motors.thrust_max += up
        if motors.thrust_max >= min(float(motors.throttle), 1.0):
            motors.thrust_max = 1.0
            motors.spool_state = THROTTLE_UNLIMITED
    elif state == THROTTLE_UNLIMITED:
        set_limits(motors, 0)
        motors.spin_up_ratio = 1.0
        motors.thrust_max = 1.0
        if desired != DESIRED_THROTTLE_UNLIMITED:
            motors.spool_state = SPOOLING_DOWN
    else:
        set_limits(motors, 0)
        motors.spin_up_ratio = 1.0
        if desired == DESIRED_THROTTLE_UNLIMITED:
            motors.spool_state = SPOOLING_UP
            return
        motors.thrust_max = max(float(motors.thrust_max) - down, 0.0)
        if motors.thrust_max <= 0.0:
            motors.spool_state = GROUND_IDLE


@law
def filter_throttle(motors, armed):
    """Low-pass of the throttle demand at ``throttle_filter_hz``."""
    if not armed:
        motors.throttle = 0.0
        return
    old = float(motors.throttle)
    new = old + lowpass_gain(float(motors.throttle_filter_hz), DT) * (float(motors.throttle_in) - old)
    motors.throttle = constrain(new, 0.0, 1.0)


@law
def slew(old, new, time_up, time_down):
    """Command limited to full range within MOT_SLEW_UP_TIME / MOT_SLEW_DN_TIME [s] (0: unlimited)."""
    if time_up > 0.0:
        new = min(new, old + DT / time_up)
    if time_down > 0.0:
        new = max(new, old - DT / time_down)
    return new


@law
def command_motors(ap):
    """``motors.actuator`` from the spool state and the mixer's thrusts."""
    p = ap.params
    motors = ap.control.motors
    state = int(motors.spool_state)
    spin_min = float(p.MOT.SPIN_MIN)
    span = float(p.MOT.SPIN_MAX) - spin_min
    for k in range(MOTORS):
        if state == SHUT_DOWN:
            motors.actuator[k] = 0.0
            continue
        wanted = float(motors.spin_up_ratio) * spin_min
        if state != GROUND_IDLE:
            thrust = float(motors.thrust[k])
            if not finite(thrust):
                thrust = 0.0
            wanted = spin_min + span * command_from_thrust(
                thrust, float(p.MOT.THST_EXPO), float(motors.lift_max), float(motors.voltage_ratio)
            )
        motors.actuator[k] = slew(
            float(motors.actuator[k]), wanted, float(p.MOT.SLEW_UP_TIME), float(p.MOT.SLEW_DN_TIME)
        )


@law
def update(ap, time_us):
    """Everything between the demands of the controllers and ``motors.actuator``; ``time_us`` since boot."""
    p = ap.params
    motors = ap.control.motors
    if int(ap.control.tick) % _SLOW_TICKS == 0:
        update_slow(ap)
    armed = ap.arming.armed != 0
    filter_throttle(motors, armed)
    spin_min = float(p.MOT.SPIN_MIN)
    idle = float(p.MOT.SPIN_ARM) / spin_min if spin_min > 0.0 else 0.0
    enabled = armed and time_us - ap.arming.armed_us >= ARMING_DELAY_US
    spool(motors, enabled, float(p.MOT.SPOOL_TIME), float(p.MOT.SPOOL_TIM_DN), idle)
    if motors.spool_state == SHUT_DOWN:
        motors.throttle_out = 0.0
    else:
        gain = float(motors.compensation_gain)
        out = mix(
            motors,
            int(p.FRAME.TYPE),
            float(motors.roll) * gain,
            float(motors.pitch) * gain,
            float(motors.yaw) * gain,
            float(motors.throttle) * gain,
            float(motors.throttle_avg_max) * gain,
            min(float(motors.thrust_max) * gain, 1.0),
            float(p.MOT.YAW_HEADROOM) * 0.001,
        )
        motors.throttle_out = out / gain
    command_motors(ap)
    if motors.test_motor != 0:
        for k in range(MOTORS):
            motors.actuator[k] = float(motors.test_actuator) if k + 1 == motors.test_motor else 0.0


@law
def write_actuators(ap, actuators):
    """Pulses [us] and 0 .. 1 controls of the border; disarmed motors get MOT_PWM_MIN and zero."""
    least = int(ap.params.MOT.PWM_MIN)
    span = int(ap.params.MOT.PWM_MAX) - least
    if span <= 0:
        least = 1000
        span = 1000
    armed = ap.arming.armed != 0
    actuators.armed = 1 if armed else 0
    for k in range(MOTORS):
        pulse = least + int(span * float(ap.control.motors.actuator[k]))
        actuators.pwm[k] = pulse
        actuators.controls[k] = constrain((pulse - 1000) * 0.001, 0.0, 1.0) if armed else 0.0
