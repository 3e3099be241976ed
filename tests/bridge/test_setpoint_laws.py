# SPDX-License-Identifier: BSD-3-Clause
"""What set-points of each kind mean north, east, down, before a firmware makes anything of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.state import Estimate
from sitl.bridge.services.setpoint_messages import (
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
    global_target,
    local_target,
    masked,
    rotation,
    to_ned,
)
from sitl.core.mavlink import MavFrame
from sitl.core.vectors import Quat, Vec3
from tests.bridge.fakes import FakeVehicle, filled

POS, VEL, ACC = Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0), Vec3(7.0, 8.0, 9.0)
NUMBERS = dict(zip(("x", "y", "z", "vx", "vy", "vz", "afx", "afy", "afz"), range(1, 10), strict=True))
NOTHING = Vec3(0.0, 0.0, 0.0)


def estimate() -> Estimate:
    """100 m north, 200 m east and 10 m above the origin, facing east."""
    vehicle = FakeVehicle()
    vehicle.locate()
    found: Estimate = vehicle.v.autopilot.estimate
    found.pos = Vec3(100.0, 200.0, -10.0)
    found.q = Quat(math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    return found


def about(vector: Any) -> Any:
    return pytest.approx(tuple(vector), abs=1e-12)


@pytest.mark.parametrize(
    ("frame", "north_east_down"),
    [
        (MavFrame.LOCAL_NED, (1, 2, 3)),
        (MavFrame.LOCAL_OFFSET_NED, (1, 2, 3)),
        (MavFrame.BODY_NED, (-2, 1, 3)),
        (MavFrame.BODY_OFFSET_NED, (-2, 1, 3)),
    ],
)
def test_only_frames_of_the_body_turn_with_it(frame: MavFrame, north_east_down: Any) -> None:
    assert tuple(to_ned(POS, frame, math.pi / 2)) == about(north_east_down)


@pytest.mark.parametrize(
    ("frame", "pos", "vel", "acc", "relative"),
    [
        (MavFrame.LOCAL_NED, (1, 2, 3), (4, 5, 6), (7, 8, 9), False),
        (MavFrame.LOCAL_OFFSET_NED, (101, 202, -7), (4, 5, 6), (7, 8, 9), False),
        (MavFrame.BODY_NED, (98, 201, -7), (-5, 4, 6), (-8, 7, 9), True),
        (MavFrame.BODY_OFFSET_NED, (98, 201, -7), (-5, 4, 6), (-8, 7, 9), True),
    ],
)
def test_local_ones(frame: MavFrame, pos: Any, vel: Any, acc: Any, relative: bool) -> None:
    m = filled(SetPositionTargetLocalNed, coordinate_frame=frame, type_mask=0, yaw=0.5, yaw_rate=0.25, **NUMBERS)
    target = local_target(m, estimate())
    assert (tuple(target.pos), tuple(target.vel), tuple(target.acc)) == (about(pos), about(vel), about(acc))
    assert (target.yaw, target.yaw_rate, target.relative_yaw) == (0.5, 0.25, relative)


def test_ones_on_the_globe_are_of_north() -> None:
    numbers = {name: value for name, value in NUMBERS.items() if len(name) > 1}
    for frame in (0, 3, 5, 6, 10, 11):
        m = filled(SetPositionTargetGlobalInt, coordinate_frame=frame, type_mask=0, yaw=0.5, yaw_rate=0.25, **numbers)
        target = global_target(m, POS)
        assert target == (True, POS, True, VEL, True, ACC, True, 0.5, True, 0.25, False)


@pytest.mark.parametrize("bit", range(12))
def test_one_bit_of_a_mask_ignores_the_whole_vector(bit: int) -> None:
    used = [True] * 5
    if bit < 9:
        used[bit // 3] = False
    elif bit > 9:  # 9: the acceleration is a force, which is for the firmware to refuse
        used[bit - 7] = False
    target = masked(1 << bit, POS, VEL, ACC, 0.5, 0.25, True)
    assert [target.use_pos, target.use_vel, target.use_acc, target.use_yaw, target.use_yaw_rate] == used
    given: list[Any] = [POS, VEL, ACC, 0.5, 0.25]
    none: list[Any] = [NOTHING, NOTHING, NOTHING, 0.0, 0.0]
    assert [target.pos, target.vel, target.acc, target.yaw, target.yaw_rate] == [
        given[k] if used[k] else none[k] for k in range(5)
    ]
    assert target.relative_yaw is True


def test_a_mask_of_all_leaves_nothing() -> None:
    nan = Vec3(math.nan, math.inf, -math.inf)
    assert masked(0xFFF, nan, nan, nan, math.nan, math.inf, False) == (
        False, NOTHING, False, NOTHING, False, NOTHING, False, 0.0, False, 0.0, False,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("numbers", "q"),
    [
        ((1, 0, 0, 0), (1, 0, 0, 0)),
        ((0, 0, 3, 4), (0, 0, 0.6, 0.8)),
        ((0.0011, 0, 0, 0), (1, 0, 0, 0)),
        ((0, -2, 0, 0), (0, -1, 0, 0)),
    ],
)
def test_rotations_have_length_one(numbers: Any, q: Any) -> None:
    found = rotation(np.array(numbers, np.float32))
    assert found.is_given and tuple(found.q) == pytest.approx(q)


@pytest.mark.parametrize(
    "numbers", [(0, 0, 0, 0), (0.00099, 0, 0, 0), (math.nan, 0, 0, 1), (math.inf, 0, 0, 0), (0, 0, 0, -math.inf)]
)
def test_numbers_of_no_rotation(numbers: Any) -> None:
    assert rotation(np.array(numbers, np.float32)) == (False, (1.0, 0.0, 0.0, 0.0))
