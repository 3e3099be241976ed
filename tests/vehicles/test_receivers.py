# SPDX-License-Identifier: BSD-3-Clause
"""Sensor sets: what tells a vehicle where it is, with its real errors."""

from __future__ import annotations

import argparse
import math

import pytest

from sitl.cli.options import add_vehicle_options, scenario_of
from sitl.envs.options import EnvOptionError
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.errors import OptionError
from sitl.vehicles import load, turtlebot
from sitl.vehicles.receivers import SETS, equipped


@pytest.mark.parametrize("frame", ["erle_copter", "erle_rover"])
def test_the_own_set_is_the_airframe_itself_and_others_stand_over_it(frame):
    airframe = load(frame)
    assert equipped(airframe, "gps") is airframe
    for name, chosen in SETS.items():
        made = equipped(airframe, name)
        assert made.name == frame and made.value("lidar_samples") == airframe.value("lidar_samples")
        assert all(made.value(name) == value for name, value in chosen.properties.items())
        assert all(made.parameters[name] == value for name, value in chosen.parameters.items())


def test_an_unknown_set_is_refused_with_those_there_are():
    with pytest.raises(OptionError, match=r"sensors 'mocop' is not known; it is one of gps, rtk.*did you mean 'mocap'"):
        equipped(load("erle_copter"), "mocop")
    with pytest.raises(OptionError, match="airframe 'turtlebot' has no receiver"):
        equipped(turtlebot.AIRFRAME, "rtk")
    with pytest.raises(EnvOptionError, match="sensors 'rtx'"):
        AutopilotRobot("open", 1, frame="erle_copter", sensors="rtx")


@pytest.mark.parametrize("sensors, within", [("rtk", 0.1), ("mocap", 0.04), ("uwb", 0.6), ("ardupilot", 0.04)])
def test_the_start_of_an_episode_is_known_as_well_as_the_set_knows_it(sensors, within):
    robot = AutopilotRobot("open", 1, frame="erle_copter", sensors=sensors)
    robot.reset(0, (3.0, 2.0, 0.0, 0.5), 7)
    x, y, z = (robot.state[0] - robot.true_state()[0])[:3]
    assert math.sqrt(x * x + y * y + z * z) < within


@pytest.mark.parametrize(("sensors", "source"), [("rtk", 3), ("mocap", 3), ("uwb", None)])
def test_the_height_is_that_of_the_system_where_it_has_one(sensors, source):
    own, made = load("erle_copter"), equipped(load("erle_copter"), sensors)
    assert made.parameters.get("EK3_SRC1_POSZ") == source
    for name in ("baro_noise", "baro_drift", "baro_drift_time"):
        assert made.value(name) == own.value(name), "the barometer is the airframe's"


def test_the_command_line_takes_a_set():
    parser = argparse.ArgumentParser()
    add_vehicle_options(parser)
    given = parser.parse_args(["--frame", "erle_copter", "--sensors", "rtk"])
    given.vehicle, given.params = "copter", None
    assert scenario_of(given).airframe.value("gps_noise_horizontal") == SETS["rtk"].properties["gps_noise_horizontal"]
