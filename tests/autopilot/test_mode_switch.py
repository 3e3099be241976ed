# SPDX-License-Identifier: BSD-3-Clause
"""What both firmwares do alike: arming with the yaw stick, changes of the mode and what is said of them."""

from __future__ import annotations

import pytest

from sitl.autopilot import modes
from sitl.autopilot.copter.modes.state import PilotState
from sitl.autopilot.events import Events
from sitl.autopilot.mode_switch import RUDDER_US, is_rudder_held, rudder_command
from sitl.autopilot.modes import MODE_CHANGED, ModeReason, ModeResult
from sitl.autopilot.state import Modes

AUTO = 3


@pytest.mark.parametrize(
    ("stick", "armed", "permission", "command"),
    (
        (1.0, False, 2.0, 1),
        (1.0, False, 1.0, 1),
        (1.0, False, 0.0, 0),
        (1.0, True, 2.0, 0),
        (-1.0, True, 2.0, -1),
        (-1.0, True, 1.0, 0),
        (-1.0, False, 2.0, 0),
        (0.8, False, 2.0, 0),
    ),
)
def test_the_yaw_stick_at_its_end_arms_and_disarms(stick: float, armed: bool, permission: float, command: int) -> None:
    assert rudder_command(stick, armed, permission) == command


def test_the_stick_must_be_held() -> None:
    pilot = PilotState()
    assert not is_rudder_held(pilot, 1, 1_000_000)
    assert not is_rudder_held(pilot, 1, 1_000_000 + RUDDER_US - 1)
    assert is_rudder_held(pilot, 1, 1_000_000 + RUDDER_US)
    assert not is_rudder_held(pilot, 0, 1_000_000 + RUDDER_US)
    assert not is_rudder_held(pilot, 1, 1_000_000 + 2 * RUDDER_US)


def test_a_mode_begins_and_the_shell_is_told_at_once_of_the_one_that_flies_missions() -> None:
    state, events = Modes(), Events()
    for number, attention in ((5, False), (AUTO, True), (5, True), (6, False)):
        events.attention = False
        modes.enter(state, events, 0, number, ModeReason.GCS, AUTO)
        assert (state.number, events.attention) == (number, attention)
    assert (state.previous, state.reason, events.code[0]) == (5, ModeReason.GCS, MODE_CHANGED)


def test_a_mode_asks_for_another_once() -> None:
    state = Modes()
    assert modes.take_asked(state) == -1
    modes.ask(state, 0, ModeReason.MISSION_END)
    assert (modes.take_asked(state), state.wanted_reason) == (0, ModeReason.MISSION_END)
    assert modes.take_asked(state) == -1


@pytest.mark.parametrize(
    ("cause", "texts"),
    (
        (ModeResult.ACCEPTED, []),
        (ModeResult.NO_SUCH_MODE, ["No such mode 42"]),
        (ModeResult.REQUIRES_POSITION, ["failed"]),
        (ModeResult.MISSING_TAKEOFF, ["Auto: Missing Takeoff Cmd", "failed"]),
        (ModeResult.NO_MISSION, ["No Mission. Can't set AUTO.", "failed"]),
    ),
)
def test_why_a_mode_was_refused_is_said(cause: int, texts: list[str]) -> None:
    assert modes.refusal_texts(42, cause, "failed") == texts
