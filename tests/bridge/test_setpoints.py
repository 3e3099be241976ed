# SPDX-License-Identifier: BSD-3-Clause
"""What the copter makes of set-points."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.modes import auto_yaw
from sitl.autopilot.copter.modes.guided import ACCEL, ANGLE, GUIDED, POS_VEL_ACCEL, POSITION, VELOCITY_ACCEL
from sitl.bridge.copter.setpoints import attitude_target, position_target_global, position_target_local
from sitl.bridge.services.setpoint_messages import (
    SetAttitudeTarget,
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
)
from sitl.vehicle.copter import Copter
from tests.bridge.fakes import HOME, FakeVehicle, filled

ONLY_POSITION, ONLY_VELOCITY, ONLY_ACCELERATION, POS_VEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0
VELOCITY_AND_YAW, VELOCITY_AND_RATE = 0x9C7, 0x5C7
NOW = 5_000_000
ZERO = (0.0, 0.0, 0.0)
NAN3 = (math.nan,) * 3


@pytest.fixture
def v() -> Copter:
    """In GUIDED, 100 m north, 200 m east and 10 m above the origin, facing east."""
    vehicle = FakeVehicle()
    vehicle.locate()
    copter: Copter = vehicle.v
    copter.time_us = NOW
    copter.autopilot.modes.number = GUIDED
    copter.autopilot.estimate.euler = (0.0, 0.0, math.pi / 2)
    copter.autopilot.estimate.pos = (100.0, 200.0, -10.0)
    return copter


def local(mask: int, frame: int = 1, p: Any = (1, 2, -3), vel: Any = (4, 5, 6), a: Any = (7, 8, 9), **more: Any) -> Any:
    numbers = dict(zip(("x", "y", "z", "vx", "vy", "vz", "afx", "afy", "afz"), (*p, *vel, *a), strict=True))
    fields = {"yaw": 0.5, "yaw_rate": 0.25, **numbers, **more}
    return filled(SetPositionTargetLocalNed, coordinate_frame=frame, type_mask=mask, **fields)


def place(frame: int, lat: int, alt: float, mask: int = ONLY_POSITION, lon: int = HOME[1]) -> Any:
    fields = {"lat_int": lat, "lon_int": lon, "alt": alt}
    return filled(SetPositionTargetGlobalInt, coordinate_frame=frame, type_mask=mask, **fields)


def attitude(mask: int, q: Any = (1, 0, 0, 0), thrust: float = 0.5) -> Any:
    rates = {"body_roll_rate": 0.1, "body_pitch_rate": 0.2, "body_yaw_rate": 0.3}
    return filled(SetAttitudeTarget, type_mask=mask, q=q, thrust=thrust, **rates)


LAWS: dict[type, Any] = {
    SetPositionTargetLocalNed: position_target_local,
    SetPositionTargetGlobalInt: position_target_global,
    SetAttitudeTarget: attitude_target,
}


def is_taken(v: Copter, message: Any) -> bool:
    """Whether the vehicle's record is another one afterwards."""
    before = bytes(v._bytes)
    LAWS[type(message)](message, v, 255)
    return bytes(v._bytes) != before


def flown(v: Copter, message: Any) -> tuple[Any, ...]:
    """(submode, position, velocity, acceleration) of GUIDED after a set-point."""
    assert is_taken(v, message)
    guided = v.autopilot.modes.guided
    assert guided.update_us == NOW
    return (guided.submode, tuple(guided.pos), tuple(guided.vel), tuple(guided.acc))


@pytest.mark.parametrize(("mask", "submode", "pos", "vel", "acc"), [
    (ONLY_POSITION, POSITION, (1, 2, -3), ZERO, ZERO),
    (ONLY_VELOCITY, VELOCITY_ACCEL, ZERO, (4, 5, 6), ZERO),
    (0xC07, VELOCITY_ACCEL, ZERO, (4, 5, 6), (7, 8, 9)),
    (POS_VEL, POS_VEL_ACCEL, (1, 2, -3), (4, 5, 6), ZERO),
    (0xC00, POS_VEL_ACCEL, (1, 2, -3), (4, 5, 6), (7, 8, 9)),
    (ONLY_ACCELERATION, ACCEL, ZERO, ZERO, (7, 8, 9)),
    (0xDF9, VELOCITY_ACCEL, ZERO, ZERO, ZERO),  # one ignored component ignores all three: nothing is left
])  # fmt: skip
def test_kinds(v: Copter, mask: int, submode: int, pos: Any, vel: Any, acc: Any) -> None:
    assert flown(v, local(mask)) == (submode, pos, vel, acc)


@pytest.mark.parametrize(("mask", "mode", "yaw", "rate"), [
    (VELOCITY_AND_YAW, auto_yaw.ANGLE_RATE, 0.5, 0.0),
    (0x1C7, auto_yaw.ANGLE_RATE, 0.5, 0.25),
])  # fmt: skip
def test_yaws(v: Copter, mask: int, mode: int, yaw: float, rate: float) -> None:
    flown(v, local(mask))
    heading = v.autopilot.modes.auto_yaw
    assert (heading.mode, heading.yaw, heading.rate) == (mode, yaw, rate)


def test_a_yaw_rate_alone(v: Copter) -> None:
    flown(v, local(VELOCITY_AND_RATE))
    assert (v.autopilot.modes.auto_yaw.mode, v.autopilot.modes.auto_yaw.rate) == (auto_yaw.RATE, 0.25)


@pytest.mark.parametrize("frame", [8, 9])
def test_yaws_of_body_frames_count_from_the_nose(v: Copter, frame: int) -> None:
    v.autopilot.control.attitude.target_euler = (0.0, 0.0, 1.5)
    flown(v, local(VELOCITY_AND_YAW, frame))
    heading = v.autopilot.modes.auto_yaw
    assert (heading.mode, heading.yaw, heading.offset) == (auto_yaw.FIXED, pytest.approx(1.5), 0.5)


@pytest.mark.parametrize(("frame", "pos", "vel"), [
    (1, (1, 2, -3), (4, 5, 6)),
    (7, (101, 202, -13), (4, 5, 6)),
    (8, (98, 201, -13), (-5, 4, 6)),
    (9, (98, 201, -13), (-5, 4, 6)),
])  # fmt: skip
def test_local_frames(v: Copter, frame: int, pos: Any, vel: Any) -> None:
    target = flown(v, local(0xC00, frame, a=(-5, 4, 3)))
    assert target[1] == pytest.approx(pos) and target[2] == pytest.approx(vel)
    assert target[3] == pytest.approx((-5, 4, 3) if frame in (1, 7) else (-4, -5, 3))


@pytest.mark.parametrize("message", [
    local(ONLY_POSITION, frame=0), local(ONLY_POSITION, frame=12), local(0xFFF), local(0xC38),
    local(ONLY_VELOCITY, vel=(math.nan, 0, 0)), local(ONLY_POSITION, p=(0, math.inf, 0)),
    local(POS_VEL, p=(0, math.inf, 0), vel=(0, -math.inf, 0)), local(VELOCITY_AND_YAW, yaw=math.nan),
    local(VELOCITY_AND_RATE, yaw_rate=-math.inf),
    place(1, HOME[0], 10.0), place(6, HOME[0], math.nan), place(6, HOME[0], math.inf),
    place(6, 2_000_000_000, 10.0), place(6, HOME[0], 10.0, lon=1_800_000_001),
    local(ONLY_ACCELERATION | 0x200), local(ONLY_ACCELERATION | 0x200, a=NAN3),  # a force
    local(ONLY_VELOCITY, vel=(0, 0, 1001)), local(POS_VEL, vel=(-1001, 0, 0)),
    attitude(7 | 64), attitude(64), attitude(1), attitude(2), attitude(3), attitude(4), attitude(0x84),
    attitude(0, (0, 0, 0, 0)), attitude(7, (1.01, 0, 0, 0)), attitude(7, (0, 2, 0, 0)),
    attitude(0, (math.nan, 0, 0, 0)),
    attitude(0, (math.inf, 0, 0, 0)), attitude(7, thrust=math.inf), attitude(7, thrust=math.nan),
])  # fmt: skip
def test_what_cannot_be_flown_stops(v: Copter, message: Any) -> None:
    assert flown(v, message) == (VELOCITY_ACCEL, ZERO, ZERO, ZERO)


@pytest.mark.parametrize("message", [
    local(ONLY_POSITION, p=(2e9, 0, 0)),  # too far for the firmware
])  # fmt: skip
def test_what_is_ignored(v: Copter, message: Any) -> None:
    assert not is_taken(v, message)


def test_numbers_that_the_mask_ignores_may_be_anything(v: Copter) -> None:
    bad = {"vel": NAN3, "a": NAN3, "yaw": math.nan, "yaw_rate": math.inf}
    assert flown(v, local(ONLY_POSITION, **bad))[:2] == (POSITION, (1, 2, -3))
    assert flown(v, local(ONLY_VELOCITY, 9, p=NAN3, a=NAN3))[3] == ZERO


@pytest.mark.parametrize("mode", [0, 3, 5, 6, 9])
@pytest.mark.parametrize("message", [
    local(ONLY_POSITION), local(ONLY_POSITION, frame=0), place(3, HOME[0], 10.0), place(1, HOME[0], 10.0), attitude(0),
], ids=["local", "no frame", "global", "no global frame", "attitude"])  # fmt: skip
def test_other_modes_ignore_set_points(v: Copter, mode: int, message: Any) -> None:
    v.autopilot.modes.number = mode
    assert not is_taken(v, message)


@pytest.mark.parametrize(("frame", "z"), [(0, 594.0), (5, 594.0), (3, 10.0), (6, 10.0), (10, 10.0), (11, 10.0)])
def test_global_frames(v: Copter, frame: int, z: float) -> None:
    submode, pos, _, _ = flown(v, place(frame, HOME[0] + 1000, z))
    assert submode == POSITION and pos == pytest.approx((11.132, 0.0, -10.0), abs=0.01)


def test_heights_count_from_home_else_from_the_origin(v: Copter) -> None:
    v.autopilot.home.alt = HOME[2] - 4.0
    assert flown(v, place(3, HOME[0], 10.0))[1][2] == pytest.approx(-6.0)
    v.autopilot.home.is_set = False
    assert flown(v, place(3, HOME[0], 10.0))[1][2] == pytest.approx(-10.0)


def test_without_an_origin_only_velocities_are_flown(v: Copter) -> None:
    v.autopilot.estimate.origin_set = False
    assert not is_taken(v, place(3, HOME[0], 10.0))
    message = filled(SetPositionTargetGlobalInt, coordinate_frame=3, type_mask=ONLY_VELOCITY, alt=math.nan, vx=1.0)
    assert flown(v, message) == (VELOCITY_ACCEL, ZERO, (1.0, 0.0, 0.0), ZERO)


@pytest.mark.parametrize(("mask", "q", "rates"), [
    (7, (1, 0, 0, 0), ZERO), (128, None, (0.1, 0.2, 0.3)), (0, (1, 0, 0, 0), (0.1, 0.2, 0.3)),
])  # fmt: skip
def test_attitude(v: Copter, mask: int, q: Any, rates: Any) -> None:
    assert flown(v, attitude(mask))[0] == ANGLE
    target = v.autopilot.modes.guided
    assert target.use_attitude == (q is not None) and target.thrust == 0.5
    assert tuple(target.rates) == pytest.approx(rates)
    if q is not None:
        assert tuple(target.q) == q, "of length 1"


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("speed", "flies"), [(1000.0, True), (-1000.0, True), (1000.1, False), (-1000.1, False)])
def test_no_component_of_a_velocity_is_faster_than_1000_m_s(v: Copter, axis: int, speed: float, flies: bool) -> None:
    vel = [1.0, 1.0, 1.0]
    vel[axis] = speed
    assert (flown(v, local(ONLY_VELOCITY, vel=vel))[2] != ZERO) == flies


@pytest.mark.parametrize(("length", "flies"), [(1.0004, True), (0.9996, True), (1.0006, False), (0.9994, False)])
def test_quaternions_have_length_one(v: Copter, length: float, flies: bool) -> None:
    assert (flown(v, attitude(7, (length, 0, 0, 0)))[0] == ANGLE) == flies


@pytest.mark.parametrize(
    ("frame", "mask", "known", "over_ground"),
    [
        (10, ONLY_POSITION, True, True), (11, ONLY_POSITION, True, True), (3, ONLY_POSITION, True, False),
        (10, POS_VEL, True, None), (10, 0xC38, True, None), (10, ONLY_POSITION, False, None),
    ],
)  # fmt: skip
def test_heights_over_ground_that_is_no_plain(
    v: Copter, frame: int, mask: int, known: bool, over_ground: bool | None
) -> None:
    """Of a location alone; where nobody knows the ground nothing changes, and with a velocity it stops."""
    t, modes = v.autopilot.terrain, v.autopilot.modes
    t.asked = t.has_square = True
    t.is_known = t.was_known = known
    t.home, t.spacing, t.corners[:] = 600.0, 100, [650.0] * len(t.corners)
    modes.guided.submode = POSITION
    taken = is_taken(v, place(frame, HOME[0], 10.0, mask))
    if over_ground is None:
        assert not taken if not known else modes.guided.submode == VELOCITY_ACCEL
    else:
        assert modes.guided.submode == POSITION and modes.nav.over_ground == over_ground
        assert tuple(modes.guided.pos) == pytest.approx((0.0, 0.0, -10.0))
