# SPDX-License-Identifier: BSD-3-Clause
"""Whatever pilots and ground stations do, the modes stay in known states and ask for finite numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.copter import arming
from sitl.autopilot.copter.modes import auto, auto_yaw, decisions, guided_setpoints, mode_commands, set_mode
from sitl.autopilot.copter.modes.mode_list import NAMES
from sitl.core.algebra import ZERO
from sitl.core.vectors import Quat, Vec3
from tests.autopilot.copter.steady_copter import fly, make

NUMBERS = st.floats(allow_nan=True, allow_infinity=True)
ACTIONS = st.one_of(
    st.tuples(st.just("mode"), st.sampled_from((*NAMES, 1, 99))),
    st.tuples(st.just("stick"), st.integers(0, 7), st.integers(0, 65535)),
    st.tuples(st.just("position"), NUMBERS, NUMBERS, NUMBERS),
    st.tuples(st.just("velocity"), NUMBERS, NUMBERS, NUMBERS),
    st.tuples(st.just("attitude"), *[NUMBERS] * 8),
    st.tuples(st.just("yaw"), NUMBERS, NUMBERS, st.integers(-1, 1), st.integers(0, 1)),
    st.tuples(st.just("speed"), st.integers(-1, 4), NUMBERS),
    st.tuples(st.just("takeoff"), NUMBERS),
    st.tuples(st.just("arm"), st.booleans()),
    st.tuples(st.just("disarm"), st.integers(0, 1)),
    st.tuples(st.just("gps"), st.integers(0, 1)),
    st.tuples(st.just("wait"), st.floats(0, 20)),
    st.tuples(st.just("start")),
)


def act(v: Any, name: str, *args: Any) -> None:
    ap = v.autopilot
    if name == "mode":
        set_mode.request(v, args[0], 2)
    elif name == "stick":
        ap.rc.override[args[0]], ap.rc.override_us[args[0]] = args[1], v.time_us
    elif name == "position":
        guided_setpoints.set_position(v, Vec3(*args), guided_setpoints.NO_YAW)
    elif name == "velocity":
        yaw = guided_setpoints.YawSetpoint(True, 0.5, False, 0.0, True)
        guided_setpoints.set_velocity(v, Vec3(*args), ZERO, yaw)
    elif name == "attitude":
        guided_setpoints.set_attitude(v, True, Quat(*args[:4]), Vec3(*args[4:7]), args[7])
    elif name == "yaw":
        mode_commands.condition_yaw(ap, auto_yaw.Turn(*args))
    elif name == "speed":
        mode_commands.change_speed(ap.control, ap.params, *args)
    elif name == "takeoff":
        mode_commands.take_off(ap, args[0])
    elif name == "arm":
        arming.arm(v, 1, args[0])
    elif name == "disarm":
        arming.disarm(v, 1, args[0])
    elif name == "gps":
        ap.estimate.position_ok = args[0]
    elif name == "wait":
        v.time_us += int(args[0] * 400) * 2500
    elif name == "start":
        auto.start_mission(ap.modes.auto, ap.arming)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.booleans(), st.lists(ACTIONS, min_size=1, max_size=8))
def test_modes_stay_in_known_states(in_flight, actions):
    v = fly(make()) if in_flight else make()
    ap = v.autopilot
    fleet = [v]
    for action in actions:
        act(v, *action)
        for _ in range(9):
            v.time_us += 2500
            v.tick += 1
            ap.control.tick += 1
            decisions.update(fleet, 0)
            assert int(ap.modes.number) in NAMES
            assert int(ap.control.motors.desired_spool) in (0, 1, 2)
            assert int(ap.arming.armed) in (0, 1) and int(ap.arming.landed) in (0, 1)
            if not ap.arming.armed:
                assert ap.control.motors.desired_spool == 0
            wanted = [*ap.control.attitude.rate_target, *ap.control.attitude.target_q]
            assert all(math.isfinite(x) for x in wanted)
            assert math.isfinite(ap.control.motors.throttle_in)
            assert np.isfinite(ap.control.pos_ne.accel_target).all()
