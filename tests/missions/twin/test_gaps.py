# SPDX-License-Identifier: BSD-3-Clause
"""What a log lacks: messages that the vehicle could not write, and the start of a mission."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.missions.twin import gaps, inputs
from sitl.missions.twin.flight_log import FlightLog
from tests.missions.twin.conftest import FORMATS, Log

COMMAND = (1, 1, 255, 190, 0)
AUTO = ("MODE", 20_500_000, 3, 3, 2)
START = ("MAVC", 20_600_000, *COMMAND, 300, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0, 1)
NOTE = "the log does not tell what began its mission on the ground: the twin is sent MISSION_START"


def flown(written: Log, *more: tuple[Any, ...], without: tuple[str, ...] = ("RCIN",)) -> inputs.Inputs:
    """A copter that climbs from 21 s on, a second after it was armed; nobody holds the sticks."""
    return inputs.of(FlightLog(written(*more, without=without)))


def test_a_take_off_in_auto_without_a_start_is_started(written: Log) -> None:
    found = flown(written, AUTO)
    (message,) = found.messages
    assert message.name == "COMMAND_INT" and message.fields["command"] == 300
    assert message.time == pytest.approx(0.6) and NOTE in found.notes


@pytest.mark.parametrize(
    "more",
    [
        (AUTO, START),
        (("MODE", 20_500_000, 4, 4, 2),),  # GUIDED
        (AUTO, ("MODE", 20_700_000, 5, 5, 2)),  # LOITER when it climbs
    ],
)
def test_what_began_otherwise_is_left_alone(written: Log, more: tuple[tuple[Any, ...], ...]) -> None:
    assert NOTE not in flown(written, *more).notes


def test_a_throttle_that_is_raised_starts_a_mission_by_itself(written: Log) -> None:
    raised = ("RCIN", 20_850_000, 1500, 1500, 1600, 1500, 1200, 0)
    assert NOTE in flown(written, AUTO, without=()).notes, "the stick hardly moves until it climbs"
    assert NOTE not in flown(written, AUTO, raised, without=()).notes


def test_messages_that_were_dropped_are_told(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FORMATS, "DSF", ("QI", "TimeUS,Dp"))
    rows = [("DSF", t, count) for t, count in ((19_000_000, 7), (25_000_000, 12), (31_000_000, 40))]
    log = FlightLog(written(*rows))
    assert gaps.dropped(log) == 5, "in the flight, which ends at 30 s"
    assert any("could not write 5 messages of the flight" in note for note in inputs.of(log).notes)
    assert gaps.dropped(FlightLog(written())) == 0
