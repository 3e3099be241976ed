# SPDX-License-Identifier: BSD-3-Clause
"""Set-points as PX4 takes them, and its modes."""

from __future__ import annotations

import math

import pytest

from sitl.core.algebra import euler_of
from sitl.core.vectors import Quat
from sitl.envs.mavlink import px4
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.envs.mavlink.preparation import mode_parameters
from sitl.envs.robots.copter import ROBOT


@pytest.fixture
def inbox():
    """Of a copter that heads east."""
    made = StepTelemetry(1)
    made.system, made.attitude = 5, (0, 0.0, 0.0, math.pi / 2, 0.0, 0.0, 0.0)
    return made


def fields(name, row, inbox):
    kind, payload = px4.COPTER[name](row, inbox, (0.0, 0.0, 0.0))
    found = kind.decode(payload)
    assert getattr(found, "target_system", getattr(found, "target", None)) == 5
    return kind.name, found


@pytest.mark.parametrize(
    ("name", "axes", "used"), [("velocity", "vx vy vz", 0o7 << 3), ("acceleration", "afx afy afz", 0o7 << 6)]
)
def test_motions_along_the_heading_are_told_in_the_local_frame(inbox, name, axes, used):
    kind, found = fields(name, (1.0, 0.5, 0.25, 0.3), inbox)
    assert kind == "SET_POSITION_TARGET_LOCAL_NED" and found.coordinate_frame == 1
    told = [getattr(found, axis) for axis in axes.split()]
    assert told == pytest.approx([0.5, 1.0, -0.25], abs=1e-6)  # forward is east, left is north
    assert found.yaw_rate == pytest.approx(-0.3)
    assert not found.type_mask & used and not found.type_mask & 2048  # these and the turn rate count
    assert found.type_mask & 0o777 & ~used == 0o777 & ~used  # and nothing else


def test_a_lean_comes_without_rates_of_roll_and_pitch(inbox):
    kind, found = fields("thrust", (0.1, -0.2, 0.3, 0.6), inbox)
    assert kind == "SET_ATTITUDE_TARGET" and found.type_mask == 1 | 2
    assert euler_of(Quat(*found.q)) == pytest.approx((0.1, -0.2, math.pi / 2), abs=1e-6)
    assert (found.body_yaw_rate, found.thrust) == pytest.approx((-0.3, 0.6))


def test_rates_come_without_an_attitude(inbox):
    kind, found = fields("rates", (0.1, -0.2, 0.3, 0.6), inbox)
    assert kind == "SET_ATTITUDE_TARGET" and found.type_mask == 128
    assert (found.body_roll_rate, found.body_pitch_rate, found.body_yaw_rate) == pytest.approx((0.1, -0.2, -0.3))


@pytest.mark.parametrize(
    ("pulses", "sticks"),
    [
        ((1500, 1500, 1500, 1500), (0, 0, 500, 0)),
        ((1500, 1400, 1500, 0), (250, 0, 500, 0)),  # as the paper's "forward"; one that is released rests
        ((1600, 1500, 1700, 1400), (0, 250, 750, -250)),
        ((2500, 0, 500, 1500), (0, 1000, 0, 0)),
    ],
)
def test_pulses_are_told_as_sticks(inbox, pulses, sticks):
    for name in ("rc", "loiter"):
        kind, found = fields(name, (*pulses, 0, 0, 0, 0), inbox)
        assert kind == "MANUAL_CONTROL" and (found.x, found.y, found.z, found.r) == sticks


def test_modes_are_asked_for_as_each_autopilot_takes_them():
    assert mode_parameters(4) == (1, 4, 0)  # ArduPilot's GUIDED
    assert mode_parameters(px4.OFFBOARD) == (1, 6, 0)
    assert mode_parameters(px4.HOLD) == (1, 4, 3)


def test_each_set_point_of_a_px4_has_a_message_and_a_mode():
    kind = ROBOT.with_px4
    names = {setpoint.name for setpoint in kind.setpoints}
    assert names == set(kind.encode) == set(kind.modes) and "attitude" not in names
    assert 0 < kind.repeat_us < 500_000  # COM_RC_LOSS_T is shorter than COM_OF_LOSS_T


@pytest.mark.parametrize(
    ("number", "parameters"),
    [(0, (1, 0, 0)), (65535, (1, 65535, 0)), (1 << 16, (1, 1, 0)), (4 << 16 | 6 << 24, (1, 4, 6)),
     (255 << 16 | 255 << 24, (1, 255, 255))],
)  # fmt: skip
def test_a_main_mode_stands_in_the_third_byte_of_px4s_numbers(number, parameters):
    """Its first one, MANUAL, too: smaller numbers are ArduPilot's."""
    assert mode_parameters(number) == parameters
