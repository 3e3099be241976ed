# SPDX-License-Identifier: BSD-3-Clause
"""Motors: from the modes' steering and throttle to the outputs (MOT_*).

Once a period: slew limit, then either steering and throttle of a car (functions 26 and 70) or left and right of a
skid-steered vehicle (73 and 74), curve of the throttle, pulses. The limit flags say what could not be given; the loops
of ``steering`` and ``speed`` read them in the next period.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite
from ..parameters import Parameters
from ..parameters.control import Motors
from . import mixer, servos
from .state import DT, TEST_LEFT, TEST_RIGHT, TEST_STEERING, TEST_THROTTLE, Control, MotorsState, current_tick


@law
def is_skid(params: Parameters) -> bool:
    """Whether the vehicle steers with its left and right motors."""
    return servos.is_assigned(params, servos.LEFT) and servos.is_assigned(params, servos.RIGHT)


@law
def throttle_max(params: Motors) -> float:
    """Throttle limit 0.05 .. 1 (MOT_THR_MAX)."""
    return constrain(params.THR_MAX, 5.0, 100.0) * 0.01


@law
def throttle_min(params: Motors) -> float:
    """Throttle at which the motors begin to turn, 0 .. 0.2 (MOT_THR_MIN)."""
    return constrain(params.THR_MIN * 0.01, 0.0, min(0.2, throttle_max(params)))


@law
def set_steering(m: MotorsState, steering: float) -> None:
    """Steering demand of a control loop: shrunk with speed, mirrored while the vehicle rolls backwards."""
    m.steering = steering if finite(steering) else 0.0
    m.scale_steering = True


@law
def set_steering_unscaled(m: MotorsState, steering: float) -> None:
    """Steering of a pilot's or client's hand, not shrunk; mirrored while the throttle pulls backwards."""
    set_steering(m, steering)
    m.scale_steering = False


@law
def set_throttle(m: MotorsState, armed: bool, throttle: float, params: Motors) -> None:
    """Throttle demand -1 .. 1; none while disarmed."""
    if armed:
        limit = throttle_max(params)
        m.throttle = constrain(throttle, -limit, limit) if finite(throttle) else 0.0


@law
def slew_limited(throttle: float, last: float, slew_rate: float) -> float:
    """``throttle`` as near as a slew rate [%/s] lets it come from the last period's; 0: no limit."""
    rate = slew_rate * 0.01
    if rate <= 0.0:
        return throttle
    return constrain(throttle, last - rate * DT, last + rate * DT)


@law
def is_moving(m: MotorsState, armed: bool, params: Parameters) -> bool:
    """Whether a demand turns the motors (ArduPilot's active())."""
    return armed and (m.throttle != 0.0 or (is_skid(params) and m.steering != 0.0))


@law
def flag_limits(m: MotorsState, armed: bool, steering: float, throttle: float, throttle_limit: float) -> None:
    """Flags of what the demands themselves use up."""
    if not armed or steering <= -1.0:
        m.limit_left = True
    if not armed or steering >= 1.0:
        m.limit_right = True
    if not armed or throttle <= -throttle_limit:
        m.limit_lower = True
    if not armed or throttle >= throttle_limit:
        m.limit_upper = True


@law
def slew_throttle(m: MotorsState, slew_rate: float) -> None:
    """Move the throttle no faster than a slew rate [%/s]."""
    limited = slew_limited(m.throttle, m.throttle_last, slew_rate)
    if limited < m.throttle:
        m.limit_upper = True
    elif limited > m.throttle:
        m.limit_lower = True
    m.throttle = limited
    m.throttle_last = limited


@law
def delay_reversal(m: MotorsState, motor: int, value: float, tick: int, delay: float) -> float:
    """``value``, or 0 for ``delay`` [s] after the last output of the motor in the other direction."""
    if delay <= 0.0 or value == 0.0:
        return value
    if value * m.direction[motor] < 0.0 and (tick - m.direction_tick[motor]) * DT < delay:
        return 0.0
    m.direction[motor] = value
    m.direction_tick[motor] = tick
    return value


@law
def motor_output(control: Control, motor: int, throttle: float, params: Motors) -> float:
    """Output -1 .. 1 of motor 0 .. 2 for a throttle."""
    curved = mixer.thrust_curve(throttle, throttle_min(params), params.THST_EXPO)
    return constrain(delay_reversal(control.motors, motor, curved, current_tick(control), params.REV_DELAY), -1.0, 1.0)


@law
def scaled_steering(m: MotorsState, speed: float, base: float) -> float:
    """Steering of a loop at ``speed`` [m/s].

    At speed the same steering angle turns faster, so steering shrinks with ``base`` (MOT_SPD_SCA_BASE [m/s]) over the
    speed. Below that speed the loop must not learn: both flags are set.
    """
    steering = m.steering
    if 0.0 < base < abs(speed):
        steering *= base / abs(speed)
    else:
        m.limit_left = True
        m.limit_right = True
    return -steering if speed < 0.0 else steering


@law
def drive_car(control: Control, armed: bool, params: Motors) -> None:
    """Steering and throttle of a car. Wheels steer even while disarmed."""
    m = control.motors
    steering, throttle = m.steering, m.throttle
    if armed and m.scale_steering:
        speed = control.speed.forward if control.speed.forward_ok else 0.0
        steering = scaled_steering(m, speed, params.SPD_SCA_BASE)
    elif armed and throttle < 0.0:
        steering = -steering
    flag_limits(m, armed, steering, throttle, throttle_max(params))
    m.out_steering = constrain(steering, -1.0, 1.0)
    m.out_throttle = motor_output(control, 0, throttle, params) if armed else 0.0
    m.out_left = 0.0
    m.out_right = 0.0


@law
def drive_skid(control: Control, armed: bool, params: Motors) -> None:
    """Left and right of a skid-steered vehicle."""
    m = control.motors
    flag_limits(m, armed, m.steering, m.throttle, throttle_max(params))
    m.out_steering = constrain(m.steering, -1.0, 1.0)
    m.out_throttle = m.throttle
    m.out_left = 0.0
    m.out_right = 0.0
    if armed:
        sides = mixer.mix_skid(m, m.steering, m.throttle, params.STR_THR_MIX, params.THST_ASYM)
        m.out_left = motor_output(control, 1, sides.left, params)
        m.out_right = motor_output(control, 2, sides.right, params)


@law
def run_motor_test(m: MotorsState, params: Motors) -> None:
    """Motor test: the motor in question alone."""
    value = constrain(m.test_value, -1.0, 1.0)
    curved = mixer.thrust_curve(value, throttle_min(params), params.THST_EXPO)
    m.out_throttle = curved if m.test_motor == TEST_THROTTLE else 0.0
    m.out_steering = value if m.test_motor == TEST_STEERING else 0.0
    m.out_left = curved if m.test_motor == TEST_LEFT else 0.0
    m.out_right = curved if m.test_motor == TEST_RIGHT else 0.0


@law
def drive_motors(control: Control, armed: bool, params: Parameters) -> None:
    """One period, from the demands to ``motors.out_*`` and the limit flags."""
    m = control.motors
    if not armed:
        m.throttle = 0.0
    m.limit_left = False
    m.limit_right = False
    m.limit_lower = False
    m.limit_upper = False
    slew_throttle(m, params.MOT.SLEWRATE)
    if m.test_motor != 0:
        run_motor_test(m, params.MOT)
    elif is_skid(params):
        drive_skid(control, armed, params.MOT)
    else:
        drive_car(control, armed, params.MOT)
