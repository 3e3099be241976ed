# SPDX-License-Identifier: BSD-3-Clause
"""An airframe from a log of a rover whose properties are known; what a log cannot tell is said."""

from __future__ import annotations

import dataclasses

import pytest

from sitl import Simulation, cli, vehicles
from sitl.agents.rehearsal.airframe_plan import airframe_plan
from sitl.client import Client
from sitl.identify import IdentifyError, identify
from sitl.identify.flight_plan import rover_items
from sitl.identify.rover.expected import expected
from sitl.logs.dataflash.log import attach
from sitl.missions import files


def drive(airframe, path, reversals: int = 0) -> None:
    """Rest; full throttle both ways, at once from one to the other so many times; steering from side to side."""
    slew = {"MOT_SLEWRATE": 0} if reversals else {}
    simulation = Simulation(airframe, seed=5, params={"LOG_DISARMED": 1, **slew})
    attach(simulation, path)
    vehicle = Client(simulation)
    vehicle.wait_ready()
    vehicle.delay(25)
    vehicle.set_mode("MANUAL")

    def sticks(steering: float, throttle: float, seconds: float) -> None:
        vehicle.rc({1: round(1500 + 400 * steering), 3: round(1500 + 400 * throttle)})
        vehicle.delay(seconds)

    sticks(0.0, 0.0, 1.0)
    vehicle.arm()
    sticks(0.0, 0.0, 4.0)
    for throttle in (0.4, 1.0, 0.0, -0.6, -1.0, 0.0):
        sticks(0.0, throttle, 4.0)
    for _ in range(reversals):
        sticks(0.0, 1.0, 3.03)
        sticks(0.0, -1.0, 3.06)
    for throttle in (0.4, 0.7):
        for steering in (0.5, -0.5, 1.0, -1.0):
            sticks(steering, throttle, 3.0)
    sticks(0.0, 0.0, 4.0)
    vehicle.disarm()
    vehicle.delay(2)
    simulation.close()


@pytest.fixture(scope="session")
def driven(tmp_path_factory):
    path = tmp_path_factory.mktemp("identify") / "drive.bin"
    drive("erle_rover", path)
    return path


@pytest.fixture(scope="session")
def found(driven):
    return identify(driven, mass=882.0)


def test_estimates_contain_the_truth_and_others_say_why_not(found) -> None:
    known = expected(vehicles.load("erle_rover"))
    for name in (
        "speed_by_throttle", "speed_by_throttle_back", "top_speed", "speed_lag", "turning_radius", "steering_gain",
        "steering_trim", "rear_axle", "avionics_current", "battery_resistance",
    ):  # fmt: skip
        estimate = found[name]
        assert estimate.low <= known[name] <= estimate.high, f"{estimate}, truth {known[name]}"
    assert found["turning_radius"].relative < 0.05 and found["speed_lag"].relative < 0.15
    assert "the limit was not reached: tyres held" in found["grip"].reason
    assert all(estimate.is_observed or estimate.reason for estimate in found.estimates)
    assert "battery_capacity: not observable in this log: " in found.table()


def test_the_airframe_is_a_file_that_drives(found, tmp_path) -> None:
    out = tmp_path / "mine.toml"
    found.write(out)
    mine, answers = vehicles.load(str(out)), expected(vehicles.load(str(out)))
    assert mine.kind == "rover" and mine.value("mass") == 882.0
    for name in ("speed_by_throttle", "speed_lag", "turning_radius", "steering_gain", "rear_axle"):
        assert answers[name] == pytest.approx(found[name].value, rel=0.01), name
    low, high = mine.intervals["speed_max"]
    assert (low, high) == pytest.approx((found["speed_by_throttle"].low, found["speed_by_throttle"].high))
    assert set(mine.intervals) <= set(mine.properties) and "contact_radius" not in mine.intervals
    assert "identified, by steering_gain" in out.read_text()
    names = [change.name for change in airframe_plan(out).changes]
    assert "least speed_max" in names and "drawn within the intervals" in names
    simulation = Simulation(str(out), seed=1)
    Client(simulation).wait_ready()
    simulation.close()


def test_a_mass_that_the_battery_contradicts_is_doubted(found) -> None:
    assert found.doubts == []
    (doubt,) = dataclasses.replace(found, mass=1.4).doubts
    assert doubt.startswith("mass 1.4 kg does not go with the battery: ") and "would be 0.12 %" in doubt
    assert len(dataclasses.replace(found, mass=3000.0).doubts) == 1, "more than all of the battery's energy"


@pytest.mark.slow
@pytest.mark.parametrize(("held", "grip"), [(0.3, 1.0), (5.8, 5.8)])
def test_the_airframes_tyres_hold_at_least_what_the_logs_held(found, held, grip) -> None:
    said = dataclasses.replace(found["grip"], least=held)
    others = (estimate for estimate in found.estimates if estimate.name != "grip")
    assert dataclasses.replace(found, estimates=(*others, said)).airframe().value("grip") == grip
    assert 0.0 < found["grip"].least < 1.0, "what this log held is less than the shipped airframe's"


@pytest.mark.slow
@pytest.mark.parametrize("grip", [0.04, 0.06])
def test_tyres_that_slide_tell_their_grip(tmp_path, grip: float) -> None:
    airframe = vehicles.load("erle_rover").changed(grip=grip)
    drive(airframe, tmp_path / "slippery.bin")
    estimate = identify(tmp_path / "slippery.bin")["grip"]
    assert estimate.low < grip < estimate.high and estimate.relative < 0.15, str(estimate)


@pytest.mark.slow
def test_motors_that_give_all_they_have_tell_it(tmp_path) -> None:
    drive("erle_rover", tmp_path / "reversals.bin", reversals=6)
    found, known = identify(tmp_path / "reversals.bin"), expected(vehicles.load("erle_rover"))
    for name in ("drive_accel", "brake_accel"):
        estimate = found[name]
        assert estimate.low < known[name] < estimate.high and estimate.relative < 0.1, (
            f"{estimate}, truth {known[name]}"
        )
    assert found.airframe().value("drive_accel") == found["drive_accel"].value


@pytest.mark.slow
def test_a_skidding_rover_has_a_track_and_no_wheels_that_turn(tmp_path) -> None:
    drive("skid_rover", tmp_path / "skid.bin")
    found = identify(tmp_path / "skid.bin")
    known = expected(vehicles.load("skid_rover"))
    for name in ("turning_track", "pivot_rate", "speed_lag", "drive_accel"):
        estimate = found[name]
        assert estimate.low <= known[name] <= estimate.high, f"{estimate}, truth {known[name]}"
    mine = found.airframe()
    assert mine.value("steering_model") == vehicles.load("skid_rover").value("steering_model")
    with pytest.raises(KeyError):
        found["turning_radius"]


def test_without_steering_and_throttle_there_is_no_airframe(driven, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.rover.stretches.outputs", lambda log: None)
    none = identify(driven)
    assert "SERVOn_FUNCTION 26 and 70" in none["speed_by_throttle"].reason
    with pytest.raises(IdentifyError, match="no airframe without speed_by_throttle"):
        none.airframe()


def test_a_rover_that_never_drove_is_named(driven, tmp_path) -> None:
    path = tmp_path / "stood.bin"
    path.write_bytes(driven.read_bytes()[:500_000])
    with pytest.raises(IdentifyError, match="never armed and driving"):
        identify(path)


def test_the_plan_grows_with_the_speed(tmp_path, capsys) -> None:
    path = tmp_path / "plan.waypoints"
    plan = ["identify", "--plan", str(path), "--home", "47.397,8.545"]
    assert cli.main([*plan, "--vehicle", "rover", "--speed", "2"]) == 0
    assert "28 m to each side" in capsys.readouterr().out
    assert len(files.load(path).mission) == len(rover_items(47.397, 8.545, 2.0))
    reach = [max(item[5] for item in rover_items(47.0, 8.0, speed)) - 47.0 for speed in (2.0, 4.0)]
    assert reach[1] == pytest.approx(2.0 * reach[0])
    assert cli.main([*plan, "--speed", "2"]) == 2
    assert "--speed 2 is of a rover's plan" in capsys.readouterr().err
    assert cli.main([*plan, "--vehicle", "rover", "--speed", "0"]) == 2
    assert "outside 0.1 .. 30" in capsys.readouterr().err
