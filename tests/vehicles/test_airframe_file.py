# SPDX-License-Identifier: BSD-3-Clause
"""Airframes as .toml files: written, read back bit for bit, flown as the name is; what is wrong in one is named."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest

from sitl import cli, vehicles
from sitl.autopilot.params import parm_files
from sitl.scenario import Scenario
from sitl.simulation import Simulation
from sitl.vehicles import AirframeError, CopterAirframe


@pytest.fixture
def own(tmp_path):
    """Makes a file of an airframe, with replacements in its text; returns its path."""

    def make(*changes: tuple[str, str], name: str = "erle_copter") -> str:
        text = vehicles.to_toml(vehicles.load(name))
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return make


@pytest.mark.parametrize("name", vehicles.names())
def test_every_airframe_is_read_back_bit_for_bit(own, name) -> None:
    known, read = vehicles.load(name), vehicles.load(own(name=name))
    assert read.record().tobytes() == known.record().tobytes()
    assert dict(read.parameters) == dict(known.parameters)
    assert (read.name, read.kind, read.description) == (known.name, known.kind, known.description)
    assert not isinstance(known, CopterAirframe) or read.rotors == known.rotors


def test_every_property_that_the_model_uses_is_in_the_file_with_its_unit(own) -> None:
    text = Path(own()).read_text()
    for prop in CopterAirframe.known:
        assert (f"{prop.name} = " in text) == (not prop.models or 0 in prop.models), prop.name
    assert "mass = 1.14  # [kg] everything included" in text
    assert "# angular_damping = 0.0  # [1/s]" in text


def test_a_flight_with_the_file_is_the_flight_with_the_name(own) -> None:
    records = []
    for frame in ("erle_copter", own()):
        simulation = Simulation(frame, seed=3)
        simulation.advance(2.0)
        records.append(simulation.fleet.tobytes())
        simulation.close()
    assert records[0] == records[1]


def test_notes_and_head_are_comments(tmp_path) -> None:
    notes = {"mass": "identified", "FRAME_CLASS": "from the log"}
    text = vehicles.to_toml(vehicles.load("erle_copter"), head=["Of two logs.", ""], notes=notes)
    assert text.startswith("# Of two logs.\n#\n")
    assert "# [kg] everything included; identified\n" in text
    assert "FRAME_CLASS = 1  # from the log\n" in text


def test_intervals_are_data_and_go_with_their_properties(tmp_path) -> None:
    known = vehicles.load("erle_copter")
    inertia = tuple(known.value("inertia"))
    measured = {"mass": (1.12, 1.16), "inertia": (tuple(0.9 * x for x in inertia), tuple(1.1 * x for x in inertia))}
    path = tmp_path / "mine.toml"
    path.write_text(vehicles.to_toml(dataclasses.replace(known, intervals=measured)))
    read = vehicles.load(str(path))
    assert read.intervals == measured
    assert read.record().tobytes() == known.record().tobytes()
    assert read.changed(mass=2.0).intervals == {"inertia": measured["inertia"]}


@pytest.mark.parametrize(
    ("interval", "says"),
    [
        ("mass = [1.2, 1.3]", r"interval of 'mass' = \(1.2, 1.3\) does not hold the property, which is 1.14"),
        ("mass = [1.1]", r"interval of 'mass' = \(1.1,\); low and high are needed"),
        ("mass = 1.14", r"interval of 'mass' = 1.14; low and high are needed"),
        ("mass = [-1, 2]", r"mass = -1 is outside 0.001 .. 10000 kg"),
        ("inertia = [0.0, 1.0]", r"inertia = 0.0; expected 3 numbers"),
        ("mas = [1.0, 2.0]", r"interval of 'mas': there is no such property; did you mean 'mass'"),
        ("mass = ['a', 'b']", r"intervals.mass = 'a'; numbers are allowed"),
    ],
)
def test_intervals_that_cannot_be_are_named(own, interval, says) -> None:
    with pytest.raises(AirframeError, match=rf"airframe file '.*mine\.toml'.*({says})"):
        vehicles.load(own(("[parameters]", f"[intervals]\n{interval}\n[parameters]")))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("mass = 1.14", "mass = -1.0", r"mass = -1.0 is outside 0.001 .. 10000 kg"),
        ("mass = 1.14", "mass = '1.14'", r"properties.mass = '1.14'; numbers are allowed"),
        ("mass = 1.14", "mass = true", r"properties.mass = True; numbers are allowed"),
        ("mass = 1.14", "mas = 1.14", r"unknown property 'mas'; did you mean 'mass'"),
        ("mass = 1.14", "", r"properties missing: mass"),
        ("inertia = [", "inertia = [1.0, ", r"inertia = \(1.0, .*expected 3 numbers"),
        ('kind = "copter"', 'kind = "plane"', r"kind = 'plane' is not known; it is one of copter, rover"),
        ('kind = "copter"', "", r"kind is missing; it is one of copter, rover"),
        ('kind = "copter"', 'kind = "rover"', r"a rover has no rotors"),
        ("[parameters]", "[parameter]", r"'parameter' is not known; did you mean 'parameters'"),
        ("[[rotor]]", "[rotor]", r"is not TOML|rotor = .* is not a table for each rotor"),
        ('direction = "ccw"', 'direction = "left"', r"rotor 1: direction = 'left'; it is one of ccw, cw"),
        ('direction = "ccw"', "direction = 1", r"rotor 1: direction = 1; it is one of ccw, cw"),
        ("x = 0.141", "", r"rotor 1: x is missing"),
        ("x = 0.141", "xx = 0.141", r"rotor 1: 'xx' is not known; there are x, y, z, direction"),
        ("FRAME_CLASS = 1", "FRAME_CLASS = nan", r"parameters.FRAME_CLASS = nan; a finite number"),
        ("mass = 1.14", "mass = ", r"is not TOML: "),
    ],
)
def test_what_is_wrong_is_named_with_the_file(own, old, new, says) -> None:
    with pytest.raises(AirframeError, match=rf"airframe file '.*mine\.toml'.*({says})"):
        vehicles.load(own((old, new)))


def test_parameters_that_the_firmware_lacks_or_refuses_are_named_with_the_file(own) -> None:
    with pytest.raises(AirframeError, match=r"mine\.toml'.* FRAME_TIPE \(did you mean 'FRAME_TYPE'\?\)"):
        Simulation(own(("FRAME_TYPE", "FRAME_TIPE")))
    with pytest.raises(parm_files.ParameterError, match=r"mine\.toml'.*ANGLE_MAX"):
        Simulation(own(("ANGLE_MAX = 3000", "ANGLE_MAX = -5")))


def test_the_old_name_of_the_properties_is_read(own) -> None:
    assert vehicles.load(own(("[properties]", "[figures]"))) == vehicles.load(own())
    with pytest.raises(AirframeError, match=r"mine\.toml': figures.mass = 'x'; numbers are allowed"):
        vehicles.load(own(("[properties]", "[figures]"), ("mass = 1.14", "mass = 'x'")))
    with pytest.raises(AirframeError, match=r"mine\.toml': there are 'figures' and 'properties': .* keep one of them"):
        vehicles.load(own(("[properties]", "[figures]\nmass = 1.0\n[properties]")))


@pytest.mark.parametrize("content", [b"\xff\xfe", None])
def test_files_that_cannot_be_read_are_named(tmp_path, content) -> None:
    path = tmp_path / "odd.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(AirframeError, match=r"odd\.toml' (is not UTF-8|cannot be read)"):
        vehicles.load(str(path))


def test_recordings_keep_the_properties_and_do_not_open_the_file(own, tmp_path) -> None:
    path = own(("mass = 1.14", "mass = 1.5"))
    data = Scenario(path).to_json()
    (tmp_path / "mine.toml").unlink()
    assert Scenario.from_json(data).airframe.value("mass") == 1.5
    described = data["airframe"]
    described["figures"] = described["properties"]
    with pytest.raises(AirframeError, match="there are 'figures' and 'properties'"):
        Scenario.from_json(data)
    del described["properties"]
    assert Scenario.from_json(data).airframe.value("mass") == 1.5


def test_sitl_frame_lists_prints_and_writes(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["frame"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(vehicles.names())
    assert cli.main(["frame", "skid-rover", "--out", "mine.toml"]) == 0
    skid = dataclasses.replace(vehicles.load("mine.toml"), name="skid_rover")
    assert skid.record().tobytes() == vehicles.load("skid_rover").record().tobytes()
    capsys.readouterr()
    assert cli.main(["frame", "mine.toml"]) == 0
    assert capsys.readouterr().out == (tmp_path / "mine.toml").read_text()
    assert cli.main(["frame", "skid_rover", "--out", "mine.txt"]) == 2
    assert "does not end in .toml" in capsys.readouterr().err
    assert cli.main(["frame", "--out", "mine.toml"]) == 2
    assert "which?" in capsys.readouterr().err


def test_an_airframe_as_json_has_its_properties_under_the_key_of_version_0_1_too(capsys) -> None:
    assert cli.main(["frame", "skid_rover", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["properties"]["track"] == data["figures"]["track"] == vehicles.load("skid_rover").properties["track"]
