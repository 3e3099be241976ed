# SPDX-License-Identifier: BSD-3-Clause
import pytest

from sitl import vehicles
from sitl.autopilot.rover.parameters import TABLE
from sitl.vehicle.copter import Copter
from sitl.vehicles import AirframeError
from sitl.vehicles.figures.rover import Figures


@pytest.mark.parametrize("name", vehicles.names("rover"))
def test_rovers_are_complete_and_their_parameters_accepted(name):
    airframe = vehicles.load(name)
    assert (airframe.name, airframe.kind) == (name, "rover")
    record = airframe.record()
    assert record.dtype == Figures.dtype
    assert record["speed_max"] == airframe.figures["speed_max"]
    for parameter, value in airframe.parameters.items():
        assert parameter in TABLE
        assert TABLE[parameter].refusal(value) is None


def test_names_by_kind():
    assert vehicles.names("rover")[0] == "erle_rover"
    assert set(vehicles.names("copter")) | set(vehicles.names("rover")) == set(vehicles.names())
    assert all(vehicles.load(name).kind == "copter" for name in vehicles.names("copter"))


@pytest.mark.parametrize(
    ("figures", "message"),
    [
        ({"steering_angle": 2.0}, r"'erle_rover': steering_angle = 2.0 is outside 0.01 .. 1.39626 rad"),
        ({"grip": 0.0}, r"grip = 0.0 is outside 0.01 .. 10000"),
        ({"steering_model": 0.5}, r"steering_model = 0.5 is not a whole number"),
        ({"thrust_model": 1}, r"unknown figure 'thrust_model'"),
        ({"steering_model": 1}, r"figures missing: turning_diameter"),
        ({"steering_model": 2}, r"figures missing: track_slip"),
    ],
)
def test_bad_figures_of_a_rover_are_named(figures, message):
    with pytest.raises(AirframeError, match=message):
        vehicles.load("erle_rover").changed(**figures)


def test_an_airframe_has_a_kind():
    with pytest.raises(AirframeError, match="'x' is of no kind: make one of a class of its kind"):
        vehicles.Airframe(name="x", description="", figures={})


def test_a_rover_does_not_fit_a_copters_record():
    with pytest.raises(TypeError, match="cannot become one of"):
        vehicles.apply(vehicles.load("erle_rover"), Copter())
