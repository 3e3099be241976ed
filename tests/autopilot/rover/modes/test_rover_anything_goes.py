# SPDX-License-Identifier: BSD-3-Clause
"""Whatever pilots and ground stations do, the modes stay in known states and ask for finite numbers."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.rover import arming, motor_test
from sitl.autopilot.rover.modes import guided_setpoints, set_mode
from sitl.autopilot.rover.modes.mode_list import NAMES
from sitl.autopilot.rover.modes.set_mode import change_speed
from tests.autopilot.rover.modes.driven_rover import (
    Rover,
    drive_to,
    set_heading,
    set_turn_rate,
    set_velocity,
)

NUMBERS = st.floats(allow_nan=True, allow_infinity=True)
SETTERS = (
    drive_to,
    set_velocity,
    set_heading,
    set_turn_rate,
    lambda v, x, y: guided_setpoints.set_limits(v.autopilot.modes.guided, x, y),
)
ACTIONS = st.one_of(
    st.tuples(st.just("mode"), st.sampled_from((*NAMES, 2, 99))),
    st.tuples(st.just("stick"), st.integers(0, 7), st.integers(0, 65535)),
    st.tuples(st.just("guided"), st.sampled_from(SETTERS), NUMBERS, NUMBERS),
    st.tuples(st.just("speed"), NUMBERS),
    st.tuples(st.just("motor"), st.integers(-1, 5), NUMBERS, st.integers(-1, 3000), NUMBERS),
    st.tuples(st.just("arm"), st.booleans()),
    st.tuples(st.just("disarm"), st.integers(0, 1)),
    st.tuples(st.just("estimate"), st.booleans()),
    st.tuples(st.just("mission"), st.integers(0, 3)),
    st.tuples(st.just("wait"), st.floats(0, 20)),
)


def act(rover: Rover, name: str, *args: Any) -> None:
    v, ap = rover.v, rover.ap
    if name == "mode":
        set_mode.request(v, args[0], 2)
    elif name == "stick":
        ap.rc.override[args[0]], ap.rc.override_us[args[0]] = args[1], v.time_us
    elif name == "guided":
        args[0](v, *args[1:])
    elif name == "speed":
        change_speed(v, args[0])
    elif name == "motor":
        motor_test.start(v, *args)
    elif name == "arm":
        arming.arm(v, 1, args[0])
    elif name == "disarm":
        arming.disarm(v, 1, args[0])
    elif name == "estimate":
        rover.set_estimate(args[0])
    elif name == "mission":
        ap.modes.mission_count = args[0]
    elif name == "wait":
        v.time_us += int(args[0] * 50) * 20000


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.booleans(), st.booleans(), st.lists(ACTIONS, min_size=1, max_size=8))
def test_modes_stay_in_known_states(driving: bool, skid: bool, actions: list[Any]) -> None:
    rover = Rover(**({"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0} if skid else {}))
    if driving:
        rover.arm()
        rover.place(5.0, 5.0, 1.0, 2.0)
    for action in actions:
        act(rover, *action)
        for _ in range(9):
            rover.step()
            ap = rover.ap
            assert int(ap.modes.number) in NAMES
            assert int(ap.arming.armed) in (0, 1)
            motors = ap.control.motors
            assert -1.0 <= motors.throttle <= 1.0
            assert math.isfinite(motors.steering)
            if not ap.arming.armed:
                assert int(rover.v.actuators.pwm[2]) == 1500
            assert all(800 <= int(rover.v.actuators.pwm[k]) <= 2200 for k in (0, 2))
            assert all(math.isfinite(x) for x in rover.position)
