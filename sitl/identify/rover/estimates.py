# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a rover from its logs. What a log cannot show is said with the reason."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...core.constants import GRAVITY
from ..board import CAPACITY, resistance, vibration
from ..estimate import NORMAL_95, Estimate, Sought
from ..log_streams import FlightLog
from ..regression import GUSTS_S, least_squares
from ..sensors import sensors
from ..signals import within
from .courses import STEP_S
from .fit import DriveFit
from .model import Array, Model
from .power import power
from .sought import (
    AXLE,
    BACKWARD,
    BRAKE,
    DIFFER,
    ELECTRONICS,
    FORWARD,
    FULL,
    GAIN,
    GRIP,
    LAG,
    LOAD,
    MOTORS,
    PIVOT,
    RADIUS,
    ROLLING,
    SERVO,
    TOP,
    TOP_BACK,
    TRACK,
    TRIM,
    VOLTAGE,
)
from .stretches import Stretches, stretches

_SHARES = {
    "speed_by_throttle": 0.02, "speed_by_throttle_back": 0.02, "top_speed": 0.02, "top_speed_back": 0.02,
    "speed_lag": 0.05, "rolling_resistance": 0.1, "drive_accel": 0.04, "brake_accel": 0.05, "turning_radius": 0.015,
    "steering_gain": 0.025, "steering_time": 0.08, "turning_track": 0.015, "pivot_rate": 0.02, "grip": 0.05,
    "rear_axle": 0.03,
}  # fmt: skip
"""Relative half of the interval that is added for what the model leaves out: chosen on logs with known truth, as are
those below."""
_FLOORS = {"speed_lag": 0.01, "rolling_resistance": 0.001, "steering_trim": 0.003, "steering_time": 0.008,
           "side_difference": 0.002, "rear_axle": 0.01}  # fmt: skip
"""The same in the property's unit."""
_MOST_RELATIVE = 0.3
_MOST = {
    "rolling_resistance": 0.004,
    "steering_trim": 0.03,
    "side_difference": 0.03,
    "steering_time": 0.05,
    "rear_axle": 0.1,
}
"""Greatest half of an interval in the property's unit, where the value may be 0."""
_LEAST_S = 20.0
_BACKWARD_S = 5.0
_FULL = 0.8
_LATE_S, _ALIKE = 0.01, 10
"""The heading may be so late (assumed), by residuals of which so many in a row are alike."""
_MOST_GRIP = 3.0
_TURNED = 0.1
"""Steering outputs that spread by less tell no turning."""


def estimates(logs: Sequence[FlightLog]) -> list[Estimate]:
    """All properties of a rover that these logs show, and the others with the reason."""
    data = stretches(logs)
    if isinstance(data, str):
        found = [sought.hidden(data) for sought in _all(None)]
    elif reason := _too_little(data):
        found = [sought.hidden(reason) for sought in _all(data.skids)]
    else:
        fit = DriveFit(data)
        found = [*_drive(fit), *(_skid(fit) if data.skids else _steering(fit)), _grip(fit), _axle(fit), *power(fit)]
    return [
        *found,
        _voltage(logs),
        resistance(logs),
        CAPACITY.hidden("a drive does not empty the battery"),
        vibration(logs),
        *sensors(logs),
    ]


def _all(skids: bool | None) -> list[Sought]:
    car, skid = (RADIUS, GAIN, TRIM, SERVO), (TRACK, PIVOT, DIFFER)
    turning = (*car, *skid) if skids is None else skid if skids else car
    drive = (FORWARD, BACKWARD, TOP, TOP_BACK, LAG, ROLLING, MOTORS, BRAKE)
    return [*drive, *turning, GRIP, AXLE, LOAD, FULL, ELECTRONICS]


def _too_little(data: Stretches) -> str:
    moved = abs(data.speed.value) > 0.1 * max(float(abs(data.speed.value).max()), 0.1)
    seconds = float(moved.mean()) * data.seconds
    return "" if seconds >= _LEAST_S else f"it drove for {seconds:.0f} s; {_LEAST_S:.0f} s are needed"


def _made(sought: Sought, fit: DriveFit, value: float, error: float) -> Estimate:
    """A property with what is added to its interval, or too uncertain."""
    name = sought.name
    half = float(np.linalg.norm([NORMAL_95 * error, _SHARES.get(name, 0.0) * value, _FLOORS.get(name, 0.0)]))
    if not math.isfinite(half) or half > max(_MOST_RELATIVE * abs(value), _MOST.get(name, 0.0)):
        return sought.hidden(f"too uncertain: {value:.3g} +- {half:.2g} {sought.unit}".rstrip())
    low = value - half if name in _MAY_BE_NEGATIVE else max(value - half, 0.0)
    return sought.between(value, low, value + half, f"{fit.data.seconds:.0f} s of RCOU, XKF1, IMU")


_MAY_BE_NEGATIVE = ("steering_trim", "side_difference", "rear_axle")


def _drive(fit: DriveFit) -> list[Estimate]:
    data = fit.data
    back_s = float((data.speed.value < -0.2 * abs(data.speed.value).max()).mean()) * data.seconds
    forward_s = float((data.speed.value > 0.2 * abs(data.speed.value).max()).mean()) * data.seconds
    outputs = _throttle(data)
    most, least = max(float(x.max()) for x in outputs), min(float(x.min()) for x in outputs)
    return [
        *_both(fit, (FORWARD, TOP), "speed", forward_s, most, "forward"),
        *_both(fit, (BACKWARD, TOP_BACK), "back", back_s, -least, "backward"),
        _made(LAG, fit, *fit.interval("lag")),
        _made(ROLLING, fit, *fit.of(lambda model: model.rolling_resistance)),
        _motors(fit),
        _brake(fit),
    ]


def _throttle(data: Stretches) -> tuple[Array, ...]:
    first, second = data.inputs()
    return (first, second) if data.skids else (second,)


def _both(
    fit: DriveFit, sought: tuple[Sought, Sought], name: str, seconds: float, most: float, direction: str
) -> list[Estimate]:
    """Speed without load, and at full throttle, one way."""
    if seconds < _BACKWARD_S:
        return [
            one.hidden(f"it drove {direction} for {seconds:.0f} s; {_BACKWARD_S:.0f} s are needed") for one in sought
        ]
    free = _made(sought[0], fit, *fit.interval(name))
    if most < _FULL:
        return [
            free,
            sought[1].hidden(f"throttle {direction} reached {100.0 * most:.0f} %; {100.0 * _FULL:.0f} % are needed"),
        ]
    return [free, _made(sought[1], fit, *fit.of(lambda model: model.value(name) - model.value("loss")))]


def _accelerations(fit: DriveFit) -> Array:
    speed = fit.courses.speed
    return np.diff(speed, axis=1, prepend=fit.data.start_speed[:, None]) / STEP_S


def _motors(fit: DriveFit) -> Estimate:
    if "weakness" not in fit.names:
        most = float(abs(_accelerations(fit)[:, 1:]).max())
        return MOTORS.hidden(f"the motors gave all that was asked for, {most:.1f} m/s^2 at most")
    value, error = fit.interval("weakness")
    return _made(MOTORS, fit, 1.0 / value, error / value**2)


def _brake(fit: DriveFit) -> Estimate:
    """What the accelerometer showed while the motors braked with all they have."""
    data, accel = fit.data, _accelerations(fit)
    speed = fit.courses.speed
    most = float(np.where(accel * speed < 0.0, abs(accel), 0.0)[:, 1:].max())
    if "weakness" not in fit.names:
        return BRAKE.hidden(f"it never braked with all it has: {most:.1f} m/s^2 at most")
    limit = 1.0 / fit.interval("weakness")[0]
    braked = (accel * speed < 0.0) & (abs(accel) > 0.98 * limit) & (abs(speed) > 0.05 * abs(speed).max())
    which = data.accel.of(braked.astype(float)) > 0.99
    if which.sum() < 10:
        return BRAKE.hidden(f"it braked with all it has for {STEP_S * braked.sum():.1f} s; {most:.1f} m/s^2 at most")
    rows = data.accel.value[which] * -np.sign(data.accel.of(speed)[which])
    mean = least_squares(lambda p: rows - p[0], np.array([rows.mean()]), data.accel.stretch[which], int(GUSTS_S))
    return _made(BRAKE, fit, float(mean.value[0]), float(mean.error[0]))


def _steering(fit: DriveFit) -> list[Estimate]:
    first, _ = fit.data.inputs()
    if float(first.std()) < _TURNED:
        reason = f"the steering output spread by {first.std():.2f}; {_TURNED:g} are needed"
        return [sought.hidden(reason) for sought in (RADIUS, GAIN, TRIM, SERVO)]
    bend, error = fit.interval("bend")
    if float(abs(first).max()) < _FULL:
        radius = RADIUS.hidden(f"the steering output reached {abs(first).max():.2f}; {_FULL:g} is needed")
    else:
        radius = _made(RADIUS, fit, 1.0 / bend, error / bend**2)
    return [
        radius,
        _made(GAIN, fit, *fit.of(gain)),
        _made(TRIM, fit, *fit.interval("trim")),
        _servo(fit),
    ]


def gain(model: Model) -> float:
    """Curvature by output about straight on [1/m]."""
    angle, bend = model.steering_angle, model.value("bend")
    return bend * (angle / math.tan(angle) if model.value("shape") >= 0.0 else angle / math.sin(angle))


def _servo(fit: DriveFit) -> Estimate:
    if "servo" not in fit.names:
        steps = sum(len(pair[0].indices) for pair in fit.data.outputs)
        return SERVO.hidden(f"the wheels followed at once, as far as {steps} steps of the steering output tell")
    return _made(SERVO, fit, *fit.interval("servo"))


def _skid(fit: DriveFit) -> list[Estimate]:
    first, second = fit.data.inputs()
    spread = float(np.std(first - second))
    if spread < _TURNED:
        return [
            sought.hidden(f"the outputs of the sides differed by {spread:.2f}; {_TURNED:g} are needed")
            for sought in (TRACK, PIVOT, DIFFER)
        ]

    def pivot(model: Model) -> float:
        sides = model.value("speed") + model.value("back") - 2.0 * model.value("loss")
        return sides / model.value("track")

    return [
        _made(TRACK, fit, *fit.interval("track")),
        _made(PIVOT, fit, *fit.of(pivot)),
        _made(DIFFER, fit, *fit.interval("differ")),
    ]


def _grip(fit: DriveFit) -> Estimate:
    if "slip" in fit.names:
        value, error = fit.interval("slip")
        if value * _MOST_GRIP < 1.0:
            why = f"{1.0 / value:.1f} is more than tyres hold: something else held the yaw rate back"
            return GRIP.hidden(why, least=1.0 / value)
        return _made(GRIP, fit, 1.0 / value, error / value**2)
    most = float(np.percentile(np.hypot(fit.courses.speed * fit.courses.yaw_rate, _accelerations(fit)), 99.9))
    held = most / GRAVITY
    return GRIP.hidden(f"the limit was not reached: tyres held {most:.1f} m/s^2, {held:.2f} of the weight", least=held)


def _axle(fit: DriveFit) -> Estimate:
    """Velocity to the right by yaw rate, besides a heading that is off, and one that is late or early."""
    data = fit.data
    turn, along, aside = data.aside.of(fit.courses.yaw_rate), data.aside.of(fit.courses.speed), data.aside.value
    if float(turn.std()) < 0.05:
        return AXLE.hidden(f"it turned too little: the yaw rate spread by {turn.std():.3f} rad/s")
    x = np.stack([turn, along, turn * along, np.ones_like(turn)], -1)
    start = np.linalg.lstsq(x, aside, rcond=None)[0]
    weight = float(np.std(aside - x @ start)) * math.sqrt(_ALIKE) / _LATE_S

    def residuals(p: Array) -> Array:
        return np.append(aside - x @ p, weight * p[2])

    groups = np.append(data.aside.group, data.aside.group.max() + 1)
    found = least_squares(residuals, start, groups, int(10 * GUSTS_S))
    return _made(AXLE, fit, float(found.value[0]), float(found.error[0]))


def _voltage(logs: Sequence[FlightLog]) -> Estimate:
    """Which the number of cells follows from."""
    most = []
    for log in logs:
        if log.has("BAT"):
            table = log.stream("BAT", 0)
            rest = table["Volt"][within(table.time, log.at_rest)] if log.at_rest else table["Volt"]
            if len(rest) > 10:
                most.append(float(np.percentile(rest, 95.0)))
    if not most or min(most) <= 0.0:
        return VOLTAGE.hidden("no BAT, or no battery monitor (BATT_MONITOR)")
    best = max(most)
    return VOLTAGE.between(best, 0.995 * best, 1.005 * best, f"BAT of {len(most)} log{'s' * (len(most) > 1)}")
