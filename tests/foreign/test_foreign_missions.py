# SPDX-License-Identifier: BSD-3-Clause
"""The recorded scripts flown by a foreign autopilot on our physics, here by ArduPilot's stand-in."""

from __future__ import annotations

import pytest

from sitl.errors import OptionError
from sitl.missions import compare


@pytest.mark.slow
def test_the_rovers_drive_is_repeated_by_a_program(ardurover):
    figures = {figure.name: figure for figure in compare.figures("rover", autopilot=f"ardupilot:{ardurover}")}
    compared = [f for name, f in figures.items() if f.theirs and "reached" in name]
    assert compared
    for figure in compared:
        assert abs(figure.percent) < 20.0, figure


@pytest.mark.slow
def test_the_copters_mission_is_repeated_by_a_program(arducopter):
    figures = compare.figures("copter", autopilot=f"ardupilot:{arducopter}")
    compared = [f for f in figures if f.theirs and f.name.startswith("AUTO") and "reached" in f.name]
    assert compared
    for figure in compared:
        assert abs(figure.percent) < 20.0, figure


def test_px4_does_not_speak_the_scripts_commands(px4):
    with pytest.raises(OptionError, match="for ArduPilot"):
        compare.figures("copter", autopilot=f"px4:{px4}")
