# SPDX-License-Identifier: BSD-3-Clause
"""Airframes of copters and rovers: complete, named, checked, read from a user's file."""

from __future__ import annotations

import math
import sys

import pytest
from pytest import approx

from sitl import vehicles
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.rover.parameters import TABLE as ROVER_TABLE
from sitl.deprecation import SitlDeprecationWarning
from sitl.vehicle.copter import Copter
from sitl.vehicles import AirframeError, ardupilot_quad
from sitl.vehicles.properties.ground_vehicle import STEERING_SKID
from sitl.vehicles.properties.ground_vehicle import Properties as RoverProperties
from sitl.vehicles.properties.multicopter import Properties
from sitl.vehicles.turtlebot import TurtlebotAirframe


@pytest.mark.parametrize("name", vehicles.names("copter"))
def test_airframes_are_complete_and_their_parameters_accepted(name):
    airframe = vehicles.load(name)
    assert airframe.name == name
    record = airframe.record()
    assert record.dtype == Properties.dtype
    assert record["mass"] == airframe.properties["mass"]
    assert record["rotor_count"] == len(airframe.rotors)
    assert sum(record["rotor_direction"]) == 0.0
    for parameter, value in airframe.parameters.items():
        assert parameter in TABLE
        assert TABLE[parameter].refusal(value) is None


@pytest.mark.parametrize("name", ["erle-copter", " Erle_Copter "])
def test_names_are_forgiving(name):
    assert vehicles.load(name).name == "erle_copter"


def test_unknown_name_lists_the_known():
    with pytest.raises(AirframeError, match=r"'hexa'.*erle_copter, ardupilot_quad"):
        vehicles.load("hexa")


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({"mass": -1.0}, r"mass = -1.0 is outside 0.001"),
        ({"mass": math.nan}, r"mass = nan"),
        ({"inertia": (1.0, 2.0)}, r"inertia = \(1.0, 2.0\); expected 3 numbers"),
        ({"mass": "heavy"}, r"mass = 'heavy'; expected one number"),
        ({"mag_offset": (0.0, None, 0.0)}, r"mag_offset = \(0.0, None, 0.0\)"),
        ({"mas": 1.0}, r"unknown property 'mas'"),
        ({"rotor_x": 1.0}, r"unknown property 'rotor_x'"),
        ({"gps_rate": 0.0}, r"gps_rate"),
        ({"gps_noise_vertical": -1.0}, r"gps_noise_vertical = -1.0"),
        ({"control_min": 0.9, "control_max": 0.5}, r"control_min"),
    ],
)
def test_bad_properties_are_named(properties, message):
    with pytest.raises(AirframeError, match=message):
        vehicles.load("erle_copter").changed(**properties)


@pytest.mark.parametrize("rotor", [(math.nan, 0.0, 0.0, 1.0), (0.0, math.inf, 0.0, 1.0), (0.0, "left", 0.0, 1.0)])
def test_rotors_stand_at_numbers(rotor):
    erle = vehicles.load("erle_copter")
    with pytest.raises(AirframeError, match=r"rotor 2 is .*; expected four numbers"):
        copter((erle.rotors[0], vehicles.Rotor(*rotor)), erle.properties)


def copter(rotors, properties):
    return vehicles.CopterAirframe(name="x", description="", rotors=rotors, properties=properties)


def test_an_airframe_is_taken_as_it_is():
    heavier = vehicles.load("erle_copter").changed(mass=1.4)
    assert vehicles.load(heavier) is heavier
    with pytest.raises(AirframeError, match="airframe None is neither"):
        vehicles.load(None)


def test_missing_properties_are_named():
    erle = vehicles.load("erle_copter")
    properties = {k: v for k, v in erle.properties.items() if k not in ("mass", "speed_max")}
    with pytest.raises(AirframeError, match=r"properties missing: mass, speed_max"):
        copter(erle.rotors, properties)


def test_rotors_are_checked():
    erle = vehicles.load("erle_copter")
    with pytest.raises(AirframeError, match="rotor 1 turns 0"):
        copter((vehicles.Rotor(0, 0, 0, 0.0),), erle.properties)
    with pytest.raises(AirframeError, match="9 rotors"):
        copter(erle.rotors[:1] * 9, erle.properties)


def test_ardupilot_quad_derivation():
    q = ardupilot_quad
    outflow, area = q.OUTFLOW_HOVER, q.OUTFLOW_AREA
    assert outflow == approx(24.08, abs=0.01)
    assert area == approx(0.0877, abs=1e-4)
    full = 0.5 * q.REFERENCE_DENSITY * q.OUTFLOW_AREA * q.OUTFLOW_MAX**2
    assert q.WEIGHT / full == approx(0.39)
    # the recording hovers at 1590.7 us
    c = (0.5907 - 0.15) / 0.8
    assert 0.35 * c + 0.65 * c * c == approx(0.39, abs=1e-3)


def test_apply_writes_one_vehicle_of_a_fleet():
    fleet = Copter.fleet(2)
    vehicles.apply(vehicles.load("erle_copter"), Copter.of(fleet, 1))
    assert fleet["physics"]["airframe"]["mass"].tolist() == [0.0, 1.14]


def test_a_users_own_file(tmp_path) -> None:
    file = tmp_path / "heavy.py"
    file.write_text("from sitl import vehicles\nAIRFRAME = vehicles.load('erle_copter').changed(mass=1.4)\n")
    assert vehicles.load(str(file)).properties["mass"] == 1.4


OF_BEFORE = """\
from sitl import vehicles
from sitl.vehicles.figures.rover import STEERING_SKID

ERLE = vehicles.load("erle_rover")
AIRFRAME = vehicles.RoverAirframe(
    name="own", description="", figures={**ERLE.figures, "steering_model": STEERING_SKID, "track_slip": 1.5}
)
"""


def test_a_file_of_version_0_1_works_and_warns(tmp_path, monkeypatch) -> None:
    for name in [name for name in sys.modules if name.startswith("sitl.vehicles.figures")]:
        monkeypatch.delitem(sys.modules, name)  # another test's import of it would have had the warning
    file = tmp_path / "skids.py"
    file.write_text(OF_BEFORE)
    with pytest.warns(SitlDeprecationWarning) as found:
        airframe = vehicles.load(str(file))
    assert airframe.value("steering_model") == STEERING_SKID and airframe.value("track_slip") == 1.5
    assert airframe.value("mass") == vehicles.load("erle_rover").value("mass")
    assert [str(one.message).partition(" ")[0] for one in found] == [
        "sitl.vehicles.figures", "RoverAirframe.figures", "RoverAirframe(figures=)",
    ]  # fmt: skip
    assert {one.filename for one in found[1:]} == {str(file)}, "imports in pytest go through its own loader"


@pytest.mark.parametrize("cls", [vehicles.CopterAirframe, vehicles.RoverAirframe, TurtlebotAirframe])
def test_the_old_name_of_the_properties_is_that_of_all_kinds(cls) -> None:
    with pytest.warns(SitlDeprecationWarning, match=rf"{cls.__name__}\(figures=\)"), pytest.raises(AirframeError):
        cls(name="x", description="", figures={"mas": 1.0}, **({"rotors": ()} if cls.kind == "copter" else {}))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x = 1", "does not define AIRFRAME"),
        ("1 / 0", "ZeroDivisionError"),
        ("from sitl import vehicles\nAIRFRAME = vehicles.load('erle_copter').changed(mass=-1.0)", "mass"),
    ],
)
def test_a_file_that_cannot_be_used_is_named(tmp_path, text: str, says: str) -> None:
    file = tmp_path / "odd.py"
    file.write_text(text)
    with pytest.raises(AirframeError, match=says):
        vehicles.load(str(file))


def test_a_file_that_is_not_there_is_named() -> None:
    with pytest.raises(AirframeError, match=r"absent\.py.*cannot be read: No such file"):
        vehicles.load("absent.py")


@pytest.mark.parametrize("name", vehicles.names("rover"))
def test_rovers_are_complete_and_their_parameters_accepted(name):
    airframe = vehicles.load(name)
    assert (airframe.name, airframe.kind) == (name, "rover")
    record = airframe.record()
    assert record.dtype == RoverProperties.dtype
    assert record["speed_max"] == airframe.properties["speed_max"]
    for parameter, value in airframe.parameters.items():
        assert parameter in ROVER_TABLE
        assert ROVER_TABLE[parameter].refusal(value) is None


def test_names_by_kind():
    assert vehicles.names("rover")[0] == "erle_rover"
    assert set(vehicles.names("copter")) | set(vehicles.names("rover")) == set(vehicles.names())
    assert all(vehicles.load(name).kind == "copter" for name in vehicles.names("copter"))


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({"steering_angle": 2.0}, r"'erle_rover': steering_angle = 2.0 is outside 0.01 .. 1.39626 rad"),
        ({"grip": 0.0}, r"grip = 0.0 is outside 0.01 .. 10000"),
        ({"steering_model": 0.5}, r"steering_model = 0.5 is not a whole number"),
        ({"thrust_model": 1}, r"unknown property 'thrust_model'"),
        ({"steering_model": 1}, r"properties missing: turning_diameter"),
        ({"steering_model": 2}, r"properties missing: track_slip"),
    ],
)
def test_bad_properties_of_a_rover_are_named(properties, message):
    with pytest.raises(AirframeError, match=message):
        vehicles.load("erle_rover").changed(**properties)


def test_an_airframe_has_a_kind():
    with pytest.raises(AirframeError, match="'x' is of no kind: make one of a class of its kind"):
        vehicles.Airframe(name="x", description="", properties={})


def test_a_rover_does_not_fit_a_copters_record():
    with pytest.raises(TypeError, match="cannot become one of"):
        vehicles.apply(vehicles.load("erle_rover"), Copter())


def test_the_rover_of_ardupilots_simulator_has_its_parameters() -> None:
    """As ArduRover 4.7 lists them."""
    parameters = vehicles.load("ardupilot_rover").parameters
    assert [parameters[name] for name in ("BATT_LOW_VOLT", "WP_PIVOT_ANGLE", "AHRS_OPTIONS")] == [0.0, 0.0, 3.0]
