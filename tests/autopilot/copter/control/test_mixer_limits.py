# SPDX-License-Identifier: BSD-3-Clause
"""The mixer where demands do not fit: which of them gives way, how far, and which flag says so; boosted thrust."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.control.frames import HEXA, OCTA, PLUS, QUAD, X, frame_of
from sitl.autopilot.copter.control.mixer import Boost, Demands, follow_boost, mix, mix_many, watch_balance
from sitl.autopilot.copter.control.state import MotorsState
from tests.autopilot.copter.control.test_mixer import FLAGS, made

HOVER = Demands(0.0, 0.0, 0.0, 0.5, 0.5, 1.0)
NOT_BOOSTED = Boost(-1, 0.0)


def mixed(
    frame: tuple[int, int] = (QUAD, PLUS), boost: Boost = NOT_BOOSTED, **changes: float
) -> tuple[MotorsState, float]:
    """Motors after one mix of a hover with some demands changed, and what came out."""
    motors, _ = made(frame)
    headroom = changes.pop("headroom", 0.2)
    return motors, mix(motors, motors.count, HOVER._replace(**changes), headroom, boost)


def flags(motors: MotorsState) -> set[str]:
    return {name.removeprefix("limit_") for name in FLAGS if getattr(motors, name)}


@pytest.mark.parametrize(
    ("changes", "out", "said"),
    (
        ({}, 0.5, set()),
        ({"throttle": 0.0, "throttle_avg_max": 0.0}, 0.0, {"throttle_lower"}),
        ({"throttle": -0.2, "throttle_avg_max": 0.0}, 0.0, {"throttle_lower"}),
        ({"throttle": 0.6, "throttle_max": 0.6}, 0.6, {"throttle_upper"}),
        ({"throttle": 0.9, "throttle_max": 0.6}, 0.6, {"throttle_upper"}),
        ({"throttle": 0.59, "throttle_max": 0.6}, 0.59, set()),
    ),
)
def test_throttle_stays_between_nothing_and_its_limit(changes: dict[str, float], out: float, said: set[str]) -> None:
    motors, got = mixed(**changes)
    assert got == pytest.approx(out) and flags(motors) == said


@pytest.mark.parametrize(
    ("roll", "throttle", "avg_max", "out", "said"),
    (
        (0.4, 0.1, 0.1, 0.1, {"roll", "pitch", "yaw"}),  # the lower motor would have to pull: shrunk to half
        (0.4, 0.1, 0.15, 0.15, {"roll", "pitch", "yaw"}),
        (0.4, 0.1, 0.2, 0.2, set()),  # raised as far as it is needed
        (0.4, 0.1, 1.0, 0.2, set()),
        (0.4, 0.9, 0.9, 0.8, {"throttle_upper"}),  # lowered: roll comes first
        (-0.4, 0.9, 0.9, 0.8, {"throttle_upper"}),
        (2.0, 0.5, 0.5, 0.5, {"roll", "pitch", "yaw"}),
        (2.4, 0.6, 0.6, 0.5, {"roll", "pitch", "yaw", "throttle_upper"}),
        (2.4, 0.4, 0.6, 0.5, {"roll", "pitch", "yaw"}),
    ),
)
def test_throttle_makes_room_for_a_roll(
    roll: float, throttle: float, avg_max: float, out: float, said: set[str]
) -> None:
    """A plus: its left and right motors take half of a roll each."""
    motors, got = mixed(roll=roll, throttle=throttle, throttle_avg_max=avg_max)
    assert got == pytest.approx(out)
    if abs(roll) != 2.0:
        assert flags(motors) == said
    difference = motors.thrust[1] - motors.thrust[0]
    kept = min(abs(roll), 2.0 * out, 2.0 * (1.0 - out), 1.0)
    assert abs(difference) == pytest.approx(kept) and difference * roll > 0.0
    assert motors.thrust[2] == motors.thrust[3] == pytest.approx(out)


@pytest.mark.parametrize("yaw", (1.0, -1.0))
@pytest.mark.parametrize(
    ("throttle", "roll", "headroom", "kept"),
    (
        (0.5, 0.0, 0.2, 1.0),  # all of it: half up, half down
        (0.2, 0.0, 0.2, 0.4),  # what lies below the throttle
        (0.2, 0.0, 0.0, 0.4),
        (0.1, 0.2, 0.3, 0.3),  # MOT_YAW_HEADROOM
    ),
)
def test_yaw_has_the_room_of_the_tightest_motor(
    throttle: float, roll: float, headroom: float, kept: float, yaw: float
) -> None:
    motors, _ = mixed(yaw=yaw, roll=roll, throttle=throttle, throttle_avg_max=throttle, headroom=headroom)
    assert bool(motors.limit_yaw) == (kept < 1.0)
    factors = motors.yaw_factor[:4]
    got = float(factors @ motors.thrust[:4] / (factors @ factors))
    assert got * yaw <= kept + 1e-9
    if throttle == 0.2 or kept == 1.0:
        assert got == pytest.approx(kept * yaw)


@pytest.mark.parametrize(("yaw", "kept"), ((1.0, 0.4), (-1.0, 0.2)))
def test_a_roll_takes_room_from_a_yaw_that_needs_the_same_motors(yaw: float, kept: float) -> None:
    """A plus: counter-clockwise the left and right motors are lowered, of which the roll has lowered one."""
    motors, _ = mixed(yaw=yaw, roll=0.2, throttle=0.2, throttle_avg_max=0.2, headroom=0.0)
    factors = motors.yaw_factor[:4]
    assert float(factors @ motors.thrust[:4] / (factors @ factors)) == pytest.approx(kept * yaw)


def test_where_attitude_may_raise_the_throttle_yaw_has_room_around_the_middle() -> None:
    motors, out = mixed(yaw=1.0, throttle=0.1, throttle_avg_max=1.0)
    assert not motors.limit_yaw and out == pytest.approx(0.5)


def octa(boost: float, **changes: float) -> tuple[MotorsState, float]:
    """An octa whose front motor, 0, is taken to fail."""
    return mixed((OCTA, PLUS), Boost(0, boost), **changes)


@pytest.mark.parametrize(("boost", "limit"), ((0.0, 0.6), (0.5, 0.8), (1.0, 1.0)))
def test_boosting_lets_throttle_rise_to_its_end(boost: float, limit: float) -> None:
    motors, out = octa(boost, throttle=1.0, throttle_avg_max=1.0, throttle_max=0.6)
    assert out == pytest.approx(limit) and motors.limit_throttle_upper


@pytest.mark.parametrize(("boost", "kept"), ((0.0, 0.2), (0.5, 0.35), (1.0, 0.5)))
def test_boosting_keeps_half_of_the_range_for_yaw(boost: float, kept: float) -> None:
    motors, _ = octa(boost, yaw=1.0, throttle=0.01, throttle_avg_max=0.01)
    others = motors.yaw_factor[:8]
    assert motors.limit_yaw
    _, least = octa(boost, yaw=kept, throttle=0.01, throttle_avg_max=1.0)
    assert least == pytest.approx(0.5 * kept) and max(abs(others)) == 0.5


@pytest.mark.parametrize(
    ("boost", "out"), ((0.0, 0.7), (0.5, 0.7 + 0.5 * 0.3 * (1.0 - 0.5**0.5)), (1.0, 1.0 - 0.3 * 0.5**0.5))
)
def test_a_motor_that_fails_limits_the_others_less_and_less(boost: float, out: float) -> None:
    assert octa(boost, pitch=0.6, throttle=0.9, throttle_avg_max=0.9)[1] == pytest.approx(out)


def balance(
    thrusts: list[float],
    frame: tuple[int, int] = (HEXA, X),
    boosting: bool = False,
    throttle_max: float = 1.0,
    out: float = 0.5,
) -> MotorsState:
    """Motors that have worked so for long."""
    motors, _ = made(frame)
    motors.boosting = boosting
    for k, thrust in enumerate(thrusts):
        motors.thrust[k] = motors.thrust_slow[k] = thrust
    watch_balance(motors, out, throttle_max)
    return motors


@pytest.mark.parametrize(
    ("thrusts", "frame", "unbalanced"),
    (
        ([0.76, 0.45, 0.45, 0.45, 0.45, 0.45], (HEXA, X), True),  # 1.5 times the mean
        ([0.74, 0.45, 0.45, 0.45, 0.45, 0.45], (HEXA, X), False),
        ([0.9, 0.1, 0.1, 0.1], (QUAD, X), False),  # too few to fly without one
        ([0.05, 0.0, 0.0, 0.0, 0.0, 0.0], (HEXA, X), False),  # hardly any thrust
    ),
)
def test_motors_are_out_of_balance_where_one_works_half_as_much_again(
    thrusts: list[float], frame: tuple[int, int], unbalanced: bool
) -> None:
    motors = balance(thrusts, frame)
    assert bool(motors.unbalanced) == unbalanced and motors.strongest == 0


@pytest.mark.parametrize(("first", "unbalanced"), ((0.5, True), (0.4, True), (0.38, False)))
def test_they_are_in_balance_again_within_a_quarter(first: float, unbalanced: bool) -> None:
    motors, _ = made((HEXA, X))
    motors.unbalanced = True
    for k, thrust in enumerate([first, *[0.29] * 5]):
        motors.thrust[k] = motors.thrust_slow[k] = thrust
    watch_balance(motors, 0.5, 1.0)
    ratio = first * 6.0 / (first + 5.0 * 0.29)
    assert bool(motors.unbalanced) == unbalanced == (ratio > 1.25)


def test_the_strongest_motor_stays_chosen_while_it_is_boosted() -> None:
    motors, _ = made((HEXA, X))
    motors.boosting, motors.strongest, motors.unbalanced = True, 2, True
    motors.thrust[4] = motors.thrust_slow[4] = 0.9
    watch_balance(motors, 0.5, 1.0)
    assert motors.strongest == 2
    motors.boosting = False
    watch_balance(motors, 0.5, 1.0)
    assert motors.strongest == 4


def test_what_a_motor_does_is_seen_with_half_a_second_of_delay() -> None:
    motors, _ = made((HEXA, X))
    motors.thrust[1] = 1.0
    for _ in range(200):
        watch_balance(motors, 0.5, 1.0)
    assert motors.thrust_slow[1] == pytest.approx(1.0 - 2.718281828**-1.0, abs=0.01)


@pytest.mark.parametrize(
    ("level", "out", "throttle_max", "ends"), ((0.5, 0.5, 1.0, True), (0.9, 0.5, 1.0, False), (0.5, 1.0, 1.0, False))
)
def test_boosting_ends_with_balance_and_thrust_to_spare(
    level: float, out: float, throttle_max: float, ends: bool
) -> None:
    motors = balance([level] * 6, boosting=True, out=out, throttle_max=throttle_max)
    assert bool(motors.boosting) != ends


def test_boosting_goes_on_while_the_motors_are_out_of_balance() -> None:
    assert balance([0.8, 0.4, 0.4, 0.4, 0.4, 0.4], boosting=True).boosting


@pytest.mark.parametrize(
    ("boosting", "unbalanced", "before", "after"),
    (
        (True, True, 0.5, 0.6),
        (True, True, 0.95, 1.0),
        (True, False, 0.5, 0.3),
        (False, True, 0.5, 0.3),
        (False, False, 0.1, 0.0),
    ),
)
def test_the_boost_comes_and_goes_in_steps(boosting: bool, unbalanced: bool, before: float, after: float) -> None:
    motors = MotorsState()
    motors.boosting, motors.unbalanced, motors.boost_ratio = boosting, unbalanced, before
    follow_boost(motors, 0.1, 0.2)
    assert motors.boost_ratio == pytest.approx(after)


def test_without_boosting_no_motor_is_left_out() -> None:
    motors, _ = made((OCTA, PLUS))
    motors.strongest, motors.boost_ratio = 0, 1.0
    assert mix_many(motors, HOVER._replace(pitch=0.6, throttle=0.9, throttle_avg_max=0.9), 0.2) == pytest.approx(0.7)


def test_the_plain_y6_is_in_balance_as_well() -> None:
    frame = frame_of(5, PLUS)
    assert frame is not None
    for part in ("forward", "right", "yaw"):
        assert sum(getattr(motor, part) for motor in frame) == pytest.approx(0.0, abs=1e-12)
    assert (
        sorted((round(m.forward, 6), abs(round(m.right, 6))) for m in frame)
        == [(-1.0, 0.0)] * 2 + [(0.5, 0.866025)] * 4
    )
