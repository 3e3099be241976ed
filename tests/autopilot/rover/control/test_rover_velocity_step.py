# SPDX-License-Identifier: BSD-3-Clause
"""Speed and heading loops on ArduPilot's SITL rover, beside what a real ArduRover 4.7 did there (GUIDED, autotest
parameters): pulses and estimated speed along the nose.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
import pytest

from sitl.autopilot.rover.control import motors, speed, steering
from sitl.autopilot.rover.control.state import DT
from tests.autopilot.rover.control.rover_car import RECORDED, Car, arm, finish, make_vehicle, sense


class Sample(NamedTuple):
    """One moment of a drive."""

    t: float
    speed: float
    heading: float
    steering_us: int
    throttle_us: int


# fmt: off
NORTH = [Sample(*row) for row in (
    (0.40, 0.090, 0.033, 1469, 1529), (0.80, 0.400, 0.027, 1476, 1559), (1.20, 0.851, 0.016, 1487, 1582),
    (1.60, 1.370, 0.008, 1496, 1599), (2.00, 1.894, 0.004, 1499, 1609), (2.40, 2.296, 0.002, 1500, 1588),
    (2.80, 2.438, 0.001, 1500, 1565), (3.20, 2.404, -0.000, 1500, 1550), (3.60, 2.290, -0.001, 1500, 1541),
    (4.00, 2.158, -0.001, 1500, 1539), (4.40, 2.047, -0.001, 1500, 1540), (4.80, 1.972, -0.001, 1500, 1544),
    (5.20, 1.935, -0.001, 1500, 1548), (6.00, 1.950, -0.002, 1500, 1552), (7.20, 1.995, -0.002, 1500, 1552),
)]
"""From rest, 2 deg off; the command took effect 0.045 s after it was sent."""
TURN = [Sample(*row) for row in (
    (0.62, 0.197, -1.455, 2000, 1544), (0.82, 0.373, -1.390, 2000, 1559), (1.02, 0.587, -1.282, 2000, 1571),
    (1.22, 0.828, -1.124, 2000, 1582), (1.42, 1.083, -0.913, 2000, 1591), (1.62, 1.346, -0.652, 1905, 1599),
    (1.80, 1.584, -0.454, 1749, 1604), (2.00, 1.846, -0.304, 1625, 1609), (2.20, 2.092, -0.212, 1576, 1604),
    (2.40, 2.274, -0.148, 1549, 1591), (2.60, 2.388, -0.104, 1533, 1578), (2.82, 2.446, -0.070, 1522, 1566),
    (3.22, 2.421, -0.035, 1511, 1549), (3.62, 2.299, -0.017, 1506, 1541), (4.00, 2.165, -0.009, 1503, 1538),
)]
"""From rest, 85 deg off: the steering is at its stop until the speed shrinks it."""
STOP = [Sample(*row) for row in (
    (3.00, 1.999, 0.0, 1500, 1546), (3.20, 1.953, 0.0, 1500, 1530), (3.40, 1.848, 0.0, 1500, 1513),
    (3.60, 1.691, 0.0, 1500, 1500), (3.80, 1.499, 0.0, 1500, 1486), (4.00, 1.276, 0.0, 1500, 1474),
    (4.20, 1.033, 0.0, 1500, 1464), (4.40, 0.774, 0.0, 1500, 1455), (4.60, 0.511, 0.0, 1500, 1448),
    (4.80, 0.248, 0.0, 1500, 1443), (5.20, -0.029, 0.0, 1500, 1500),
)]
"""No set-point for 3 s: a controlled stop from 2 m/s."""
HOLD = [Sample(*row) for row in (
    (0.08, 1.961, 0.0, 1500, 1522), (0.12, 1.936, 0.0, 1500, 1502), (0.48, 1.618, 0.0, 1500, 1500),
    (0.98, 1.260, 0.0, 1500, 1500), (1.92, 0.787, 0.0, 1500, 1500), (2.90, 0.482, 0.0, 1500, 1500),
)]
"""No throttle: it runs out, its throttle slewed to nothing. True speed here: nothing steers by the estimate."""
# fmt: on


def drive(car: Car, act: Callable[[Any], object], seconds: float, start: float) -> list[Sample]:
    """Every period of a mode that only acts; its first is at ``start``."""
    driven = []
    for k in range(round(seconds / DT)):
        sense(car.v)
        act(car.v)
        finish(car.v)
        pwm = car.v.actuators.pwm
        driven.append(Sample(start + k * DT, car.speed, car.heading, int(pwm[0]), int(pwm[2])))
        car.move()
    return driven


def towards(heading: float, wanted: float) -> Callable[[Any], object]:
    """GUIDED: heading and speed."""

    def act(v: Any) -> None:
        ap = v.autopilot
        demand = steering.out_from_heading(ap.control, ap.estimate, heading, ap.params.ATC)
        motors.set_steering(ap.control.motors, demand)
        speed.drive(ap.control, True, wanted, ap.params)

    return act


def coast(v: Any) -> None:
    """HOLD."""
    m = v.autopilot.control.motors
    motors.set_steering(m, 0.0)
    motors.set_throttle(m, True, 0.0, v.autopilot.params.MOT)


def stop(v: Any) -> None:
    """A controlled stop."""
    speed.stop(v.autopilot.control, True, v.autopilot.params)


def at_times_of(recorded: Iterable[Sample], driven: list[Sample]) -> list[tuple[Sample, Sample]]:
    """(recorded, ours) pairs: motion interpolated, pulses those in force."""
    times = [s.t for s in driven]
    pairs = []
    for r in recorded:
        held = driven[bisect.bisect_right(times, r.t) - 1]
        moved = held._replace(
            speed=float(np.interp(r.t, times, [s.speed for s in driven])),
            heading=float(np.interp(r.t, times, [s.heading for s in driven])),
        )
        pairs.append((r, moved))
    return pairs


def rolling(wanted: float) -> Car:
    """A car that has long been driving north at ``wanted``."""
    car = Car(arm(make_vehicle(**RECORDED)))
    drive(car, towards(0.0, wanted), 25.0, 0.0)
    assert car.speed == pytest.approx(wanted, abs=0.005)
    return car


def test_two_metres_a_second_north():
    driven = drive(Car(arm(make_vehicle(**RECORDED)), heading=0.034), towards(0.0, 2.0), 8.0, 0.045)
    for theirs, ours in at_times_of(NORTH, driven):
        assert ours.speed == pytest.approx(theirs.speed, rel=0.01, abs=0.01), theirs
        assert ours.heading == pytest.approx(theirs.heading, abs=0.004), theirs
        assert ours.steering_us == pytest.approx(theirs.steering_us, abs=2), theirs
        assert ours.throttle_us == pytest.approx(theirs.throttle_us, abs=4), theirs
    assert max(s.speed for s in driven) == pytest.approx(2.44, abs=0.015)
    assert next(s.t for s in driven if s.speed >= 1.0) == pytest.approx(1.32, abs=0.03)
    assert next(s.t for s in driven if s.speed >= 1.9) == pytest.approx(2.0, abs=0.03)


def test_turn_at_full_lock_and_the_shrinking_of_steering_with_speed():
    driven = drive(Car(arm(make_vehicle(**RECORDED)), heading=-1.488), towards(0.0, 2.0), 5.0, 0.09)
    for theirs, ours in at_times_of(TURN, driven):
        assert ours.speed == pytest.approx(theirs.speed, rel=0.015, abs=0.015), theirs
        assert ours.heading == pytest.approx(theirs.heading, abs=0.025), theirs
        assert ours.steering_us == pytest.approx(theirs.steering_us, abs=15), theirs
        assert ours.throttle_us == pytest.approx(theirs.throttle_us, abs=3), theirs


def test_controlled_stop():
    car = rolling(2.0)
    start = car.position[0]
    driven = drive(car, stop, 3.5, 2.98)
    for theirs, ours in at_times_of(STOP, driven):
        assert ours.speed == pytest.approx(theirs.speed, abs=0.04), theirs
        assert ours.throttle_us == pytest.approx(theirs.throttle_us, abs=4), theirs
    assert next(s.t for s in driven if s.speed < 0.1) == pytest.approx(4.92, abs=0.04)
    assert car.position[0] - start == pytest.approx(2.45, abs=0.1)


def test_hold_runs_out():
    car = rolling(1.969)
    driven = drive(car, coast, 5.5, 0.03)
    for theirs, ours in at_times_of(HOLD, driven):
        assert ours.speed == pytest.approx(theirs.speed, rel=0.015), theirs
        assert ours.throttle_us == pytest.approx(theirs.throttle_us, abs=5), theirs
