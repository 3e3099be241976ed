# SPDX-License-Identifier: BSD-3-Clause
"""An airframe from a log of a copter whose figures are known; what a log cannot tell is said."""

from __future__ import annotations

import pytest

from sitl import Simulation, cli, vehicles
from sitl.client import Client
from sitl.identify import IdentifyError, identify
from sitl.logs.dataflash.log import attach
from sitl.missions import files


@pytest.fixture(scope="session")
def flown(tmp_path_factory):
    """A hover and a few legs of ArduPilot's quad."""
    path = tmp_path_factory.mktemp("identify") / "flight.bin"
    simulation = Simulation("ardupilot_quad", seed=1, params={"LOG_BITMASK": 180223})
    attach(simulation, path)
    vehicle = Client(simulation)
    vehicle.wait_ready()
    vehicle.take_off(8)
    vehicle.delay(30)
    for north, east in ((15, 0), (15, 15), (0, 0)):
        vehicle.goto(north, east, altitude=8)
    simulation.close()
    return path


def test_figures_contain_the_truth_and_others_say_why_not(flown) -> None:
    found = identify(flown)
    hover = found["hover_output"]
    assert hover.low < 0.5909 < hover.high and hover.relative < 0.02
    for axis in ("roll", "pitch"):
        figure = found[f"{axis}_effectiveness"]
        assert figure.low < 304.3 < figure.high, str(figure)
    assert "did not change" in found["battery_resistance"].reason  # an ideal source
    assert all(figure.is_observed or figure.reason for figure in found.figures)
    assert "yaw_effectiveness: not observable in this log: " in found.table()


def test_the_airframe_flies_at_the_same_output(flown, tmp_path, capsys) -> None:
    out = tmp_path / "mine.toml"
    assert cli.main(["identify", str(flown), "--mass", "2.0", "--out", str(out)]) == 0
    assert "hover_output: 0.59" in capsys.readouterr().out
    mine, known = vehicles.load(str(out)), vehicles.load("ardupilot_quad")
    assert mine.value("mass") == 2.0
    # A third less mass with the same ratio of thrust: outflow^2 by mass stays.
    ratio = mine.value("outflow_speed_max") ** 2 / mine.value("mass")
    assert ratio == pytest.approx(known.value("outflow_speed_max") ** 2 / 3.0, rel=0.02)
    assert "identified, by hover_output: 0.59" in out.read_text()


def test_rates_that_are_too_low_are_said(flown, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.rates._LEAST_HZ", 60.0)
    assert "RATE is logged at 50 Hz; 60 Hz are needed" in identify(flown)["roll_effectiveness"].reason


def test_logs_of_no_use_are_named(flown, tmp_path) -> None:
    data = flown.read_bytes()
    for name, content, says in (
        ("no_parm.bin", data.replace(b"PARM", b"PXRM"), "has no PARM"),
        ("rover.bin", data.replace(b"ArduCopter V", b"xArduRover V"), "is of a rover; only copters"),
        ("ground.bin", data[: len(data) // 5], "never in the air"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(IdentifyError, match=says):
            identify(path)
    with pytest.raises(IdentifyError, match="mass -1"):
        identify(flown, mass=-1.0)


def test_the_plan_is_a_mission(tmp_path, capsys) -> None:
    path = tmp_path / "plan.waypoints"
    assert cli.main(["identify", "--plan", str(path), "--home", "47.397,8.545"]) == 0
    mission = files.load(path).mission
    assert len(mission) > 25
    assert cli.main(["identify", "--plan", str(path)]) == 2
    assert "--home None is not LAT,LON" in capsys.readouterr().err
