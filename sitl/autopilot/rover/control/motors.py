# SPDX-License-Identifier: BSD-3-Clause
"""Motors: from the modes' steering and throttle to the outputs (MOT_*).

Once a period: slew limit, then either steering and throttle of a car (functions 26 and 70) or left and right of a
skid-steered vehicle (73 and 74), curve of the throttle, pulses. The limit flags say what could not be given; the loops
of ``steering`` and ``speed`` read them in the next period.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite
from . import mixer, servos
from .recent import now_tick
from .state import DT

TEST_THROTTLE, TEST_STEERING, TEST_LEFT, TEST_RIGHT = 1, 2, 3, 4
"""MOTOR_TEST_ORDER of ArduRover's motor test."""


@law
def is_skid(ap):
    """Whether the vehicle steers with its left and right motors."""
    return servos.is_assigned(ap, servos.LEFT) and servos.is_assigned(ap, servos.RIGHT)


@law
def throttle_max(ap):
    """Throttle limit 0.05 .. 1 (MOT_THR_MAX)."""
    return constrain(float(ap.params.MOT.THR_MAX), 5.0, 100.0) * 0.01


@law
def throttle_min(ap):
    """Throttle at which the motors begin to turn, 0 .. 0.2 (MOT_THR_MIN)."""
    return constrain(float(ap.params.MOT.THR_MIN) * 0.01, 0.0, min(0.2, throttle_max(ap)))


@law
def set_steering(ap, steering):
    """Steering demand of a control loop: shrunk with speed, mirrored while the vehicle rolls backwards."""
    ap.control.motors.steering = steering if finite(steering) else 0.0
    ap.control.motors.scale_steering = 1


@law
def set_steering_unscaled(ap, steering):
    """Steering of a pilot's or client's hand, not shrunk; mirrored while the throttle pulls backwards."""
    set_steering(ap, steering)
    ap.control.motors.scale_steering = 0


@law
def set_throttle(ap, throttle):
    """Throttle demand -1 .. 1; none while disarmed."""
    if ap.arming.armed == 0:
        return
    most = throttle_max(ap)
    ap.control.motors.throttle = constrain(throttle, -most, most) if finite(throttle) else 0.0


@law
def slew_limited(ap, throttle):
    """``throttle`` as near as MOT_SLEWRATE lets this period come."""
    rate = float(ap.params.MOT.SLEWRATE) * 0.01
    if rate <= 0.0:
        return throttle
    last = float(ap.control.motors.throttle_last)
    return constrain(throttle, last - rate * DT, last + rate * DT)


@law
def is_moving(ap):
    """Whether a demand turns the motors (ArduPilot's active())."""
    m = ap.control.motors
    if ap.arming.armed == 0:
        return False
    return m.throttle != 0.0 or (is_skid(ap) and m.steering != 0.0)


@law
def _set_limits(m, armed, steering, throttle, most):
    """Flags of what the demands themselves use up."""
    if not armed or steering <= -1.0:
        m.limit_left = 1
    if not armed or steering >= 1.0:
        m.limit_right = 1
    if not armed or throttle <= -most:
        m.limit_lower = 1
    if not armed or throttle >= most:
        m.limit_upper = 1


@law
def _slew(ap):
    m = ap.control.motors
    wanted = float(m.throttle)
    limited = slew_limited(ap, wanted)
    if limited < wanted:
        m.limit_upper = 1
    elif limited > wanted:
        m.limit_lower = 1
    m.throttle = limited
    m.throttle_last = limited


@law
def _direction_delayed(ap, motor, value):
    """``value``, or 0 for MOT_REV_DELAY after the last output in the other direction."""
    m = ap.control.motors
    if ap.params.MOT.REV_DELAY <= 0.0 or value == 0.0:
        return value
    now = now_tick(ap)
    if value * float(m.direction[motor]) < 0.0 and (now - int(m.direction_tick[motor])) * DT < ap.params.MOT.REV_DELAY:
        return 0.0
    m.direction[motor] = value
    m.direction_tick[motor] = now
    return value


@law
def _motor_output(ap, motor, throttle):
    curved = mixer.thrust_curve(throttle, throttle_min(ap), float(ap.params.MOT.THST_EXPO))
    return constrain(_direction_delayed(ap, motor, curved), -1.0, 1.0)


@law
def _car(ap, armed):
    """Steering and throttle of a car. Wheels steer even while disarmed.

    At speed the same steering angle turns faster, so steering shrinks with MOT_SPD_SCA_BASE over the speed. Below that
    speed the loop must not learn: both flags are set.
    """
    m = ap.control.motors
    steering, throttle = float(m.steering), float(m.throttle)
    speed = float(ap.control.speed.forward) if ap.control.speed.forward_ok != 0 else 0.0
    base = float(ap.params.MOT.SPD_SCA_BASE)
    if armed and m.scale_steering != 0:
        if 0.0 < base < abs(speed):
            steering *= base / abs(speed)
        else:
            m.limit_left = 1
            m.limit_right = 1
        if speed < 0.0:
            steering = -steering
    elif armed and throttle < 0.0:
        steering = -steering
    _set_limits(m, armed, steering, throttle, throttle_max(ap))
    m.out_steering = constrain(steering, -1.0, 1.0)
    m.out_throttle = _motor_output(ap, 0, throttle) if armed else 0.0
    m.out_left = 0.0
    m.out_right = 0.0


@law
def _skid(ap, armed):
    """Left and right of a skid-steered vehicle."""
    m = ap.control.motors
    p = ap.params
    steering, throttle = float(m.steering), float(m.throttle)
    _set_limits(m, armed, steering, throttle, throttle_max(ap))
    m.out_steering = constrain(steering, -1.0, 1.0)
    m.out_throttle = throttle
    m.out_left = 0.0
    m.out_right = 0.0
    if armed:
        left, right = mixer.skid(m, steering, throttle, float(p.MOT.STR_THR_MIX), float(p.MOT.THST_ASYM))
        m.out_left = _motor_output(ap, 1, left)
        m.out_right = _motor_output(ap, 2, right)


@law
def _test(ap):
    """Motor test: the motor in question alone."""
    m = ap.control.motors
    motor = int(m.test_motor)
    value = constrain(float(m.test_value), -1.0, 1.0)
    curved = mixer.thrust_curve(value, throttle_min(ap), float(ap.params.MOT.THST_EXPO))
    m.out_throttle = curved if motor == TEST_THROTTLE else 0.0
    m.out_steering = value if motor == TEST_STEERING else 0.0
    m.out_left = curved if motor == TEST_LEFT else 0.0
    m.out_right = curved if motor == TEST_RIGHT else 0.0


@law
def update(ap):
    """One period, from the demands to ``motors.out_*`` and the limit flags."""
    m = ap.control.motors
    armed = ap.arming.armed != 0
    if not armed:
        m.throttle = 0.0
    m.limit_left = 0
    m.limit_right = 0
    m.limit_lower = 0
    m.limit_upper = 0
    _slew(ap)
    if m.test_motor != 0:
        _test(ap)
    elif is_skid(ap):
        _skid(ap, armed)
    else:
        _car(ap, armed)
