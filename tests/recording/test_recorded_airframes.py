# SPDX-License-Identifier: BSD-3-Clause
"""A recording brings its airframe along as figures: the Python file that it was made with is never run on replay."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import vehicles
from sitl.recording.recording import read
from sitl.recording.replay import Replay
from sitl.simulation import Core
from tests.recording.recorded_flights import hop

AIRFRAME = """
from sitl import vehicles
AIRFRAME = vehicles.load("erle_copter").changed(mass=1.5)
"""


def test_a_file_that_a_recording_names_is_not_run(core: Core, tmp_path: Path) -> None:
    """Somebody's file lies where the header says; the flight is the recorded one all the same."""
    file, marker = tmp_path / "heavy.py", tmp_path / "marker"
    file.write_text(AIRFRAME)
    flown = hop(tmp_path / "heavy.rec", core, frame=str(file))
    assert read(flown.path).header["frame"] == str(file)
    file.write_text(f"open({str(marker)!r}, 'w')\n" + AIRFRAME)
    replay = Replay(read(flown.path), core=core)
    assert replay.run() == [] == replay.differences
    assert not marker.exists()
    file.unlink()
    assert Replay(read(flown.path), core=core, record=tmp_path / "again.rec").run() == []
    assert Replay(read(flown.path), frame="erle_copter", core=core).differences  # the user's word counts


@pytest.mark.parametrize("name", vehicles.names())
def test_an_airframe_comes_back_from_its_figures(name: str) -> None:
    """All that a simulation takes from an airframe is the same."""
    airframe = vehicles.load(name)
    again = vehicles.of_data(type(airframe), vehicles.to_data(airframe))
    assert again.record().tobytes() == airframe.record().tobytes()
    assert again.parameters == airframe.parameters and again.name == airframe.name
