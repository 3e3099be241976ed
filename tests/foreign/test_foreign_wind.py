# SPDX-License-Identifier: BSD-3-Clause
"""Which parameters of another autopilot act on our physics, and how it follows them in flight."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.foreign.choice import Choice
from sitl.foreign.wind_parameters import Wind

VALUE, SET = message("PARAM_VALUE"), message("PARAM_SET")


@pytest.mark.parametrize("encode", [encode_v1, encode_v2])
def test_wind_that_the_autopilot_tells_blows_from_then_on(copter_plant, encode):
    wind, v = Wind(copter_plant), copter_plant.vehicle.v
    copter_plant.tick()
    for name, value in ((b"SIM_WIND_SPD", 7.0), (b"SIM_WIND_DIR", 270.0)):
        wind.frame(encode(VALUE, VALUE.payload(param_id=name, param_value=value, param_type=9), 0, 1, 1))
    copter_plant.tick()
    assert v.physics.wind.steady.y == 0.0
    wind.blow()
    assert v.physics.wind.speed == 7.0
    for _ in range(8000):
        copter_plant.tick()
    assert tuple(v.physics.wind.steady) == pytest.approx((0.0, 7.0, 0.0), abs=0.2)


def test_nothing_else_acts(copter_plant):
    """What a client asks for may be refused, and failed motors are in the pulses already."""
    wind, params = Wind(copter_plant), copter_plant.vehicle.v.autopilot.params.SIM
    before = params.WIND_SPD, params.ENGINE_FAIL, params.ENGINE_MUL
    copter_plant.tick()
    wind.frame(encode_v2(SET, SET.payload(param_id=b"SIM_WIND_SPD", param_value=7.0, param_type=9), 0, 255, 190))
    for name in (b"SIM_ENGINE_FAIL", b"SIM_ENGINE_MUL", b"SIM_WIND_NONE", b"ANGLE_MAX"):
        wind.frame(encode_v2(VALUE, VALUE.payload(param_id=name, param_value=1.0, param_type=9), 0, 1, 1))
    wind.blow()
    assert before == (params.WIND_SPD, params.ENGINE_FAIL, params.ENGINE_MUL)


def test_parameters_that_an_autopilot_is_given_act_once():
    values = {"SIM_WIND_SPD": 5.0, "SIM_ENGINE_FAIL": 1.0, "SIM_GPS1_ENABLE": 0.0, "WP_SPD": 3.0}
    assert Choice("ardupilot", Path("arducopter")).for_physics(values) == {"SIM_WIND_SPD": 5.0}
    values["SIM_BAT_DRAIN"] = 60.0  # of PX4's own
    ours = {"SIM_WIND_SPD": 5.0, "SIM_ENGINE_FAIL": 1.0, "SIM_GPS1_ENABLE": 0.0}
    assert Choice("px4", Path("px4")).for_physics(values) == ours
    assert Choice("px4", Path("px4")).for_autopilot(values) == {"WP_SPD": 3.0, "SIM_BAT_DRAIN": 60.0}
    assert Choice("ardupilot", Path("arducopter")).for_autopilot(values) == values
