# SPDX-License-Identifier: BSD-3-Clause
"""Names and needs of the modes; the texts that a recorded ArduRover says."""

from __future__ import annotations

import pytest

from sitl.autopilot.arming_checks import ARMED, DISARMED
from sitl.autopilot.aux_switch import AUX_SWITCH
from sitl.autopilot.failsafe_checks import FAILSAFE
from sitl.autopilot.modes import MODE_REFUSED, ModeResult
from sitl.autopilot.rover import failsafe
from sitl.autopilot.rover.crash import CRASH_HOLD
from sitl.autopilot.rover.event_list import EVENTS
from sitl.autopilot.rover.modes import mode_list, set_mode
from sitl.autopilot.rover.modes.acro import ACRO
from sitl.autopilot.rover.modes.circle import CIRCLE_ADAPTED
from sitl.autopilot.rover.modes.guided import GUIDED_TIMEOUT
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.rtl import DESTINATION_REACHED
from sitl.autopilot.smart_rtl_path import PATH_LOST
from tests.autopilot.rover.modes.driven_rover import Rover


def test_numbers_are_ardurovers() -> None:
    assert mode_list.NAMES == {
        0: "MANUAL", 1: "ACRO", 3: "STEERING", 4: "HOLD", 5: "LOITER", 6: "FOLLOW", 7: "SIMPLE", 8: "DOCK", 9: "CIRCLE",
        10: "AUTO", 11: "RTL", 12: "SMART_RTL", 15: "GUIDED", 16: "INITIALISING",
    }  # fmt: skip
    assert [n for n in range(30) if mode_list.is_known(n)] == sorted(mode_list.NAMES)


def test_only_hands_and_hold_do_without_a_position() -> None:
    free = [n for n in mode_list.NAMES if not mode_list.requires_position(n)]
    assert [mode_list.NAMES[n] for n in free] == ["MANUAL", "ACRO", "STEERING", "HOLD"]
    assert [n for n in free if not mode_list.requires_velocity(n, False)] == [MANUAL, HOLD]
    assert not mode_list.requires_velocity(ACRO, True)  # a skid-steered one turns without a speed


def test_ways_home_are_not_for_arming() -> None:
    refused = [mode_list.NAMES[n] for n in mode_list.NAMES if not mode_list.allows_arming(n)]
    assert refused == ["RTL", "SMART_RTL", "INITIALISING"]


@pytest.mark.parametrize(
    ("wanted", "got"), [(4, 4), (15, 15), (7, 7), (5, 16), (9, 16), (10, 16), (11, 16), (12, 16), (2, 16)]
)
def test_initial_mode_is_one_that_can_be_entered_at_power_on(wanted: int, got: int) -> None:
    """LOITER and CIRCLE need a place, the ways home need one, AUTO needs a mission."""
    ap = Rover(INITIAL_MODE=wanted, MODE_CH=0).ap
    assert ap.modes.number == got


@pytest.mark.parametrize(
    ("code", "a", "b", "said"),
    [
        (ARMED, 1, 0, [(6, "Throttle armed")]),
        (DISARMED, 1, 0, [(6, "Throttle disarmed")]),
        (GUIDED_TIMEOUT, 3, 0, [(4, "target not received last 3secs, stopping")]),
        (DESTINATION_REACHED, 11, 0, [(6, "Reached destination")]),
        (MODE_REFUSED, 99, ModeResult.NO_SUCH_MODE, [(4, "No such mode 99")]),
        (MODE_REFUSED, 11, ModeResult.INIT_FAILED, [(4, "Flight mode change failed")]),
        (
            MODE_REFUSED,
            10,
            ModeResult.NO_MISSION,
            [(5, "No Mission. Can't set AUTO."), (4, "Flight mode change failed")],
        ),
        (CRASH_HOLD, 0, 0, [(0, "Crash: Going to HOLD")]),
        (FAILSAFE, 1, 1, [(4, "Radio Failsafe")]),
        (FAILSAFE, 1, 0, [(6, "Radio Failsafe Cleared")]),
        (FAILSAFE, failsafe.CONTINUES, 1, [(4, "Failsafe - Continuing Auto Mode")]),
        (FAILSAFE, 5, 1, [(2, "EKF failsafe")]),
        (CIRCLE_ADAPTED, 1, 2.0, [(4, "Circle: radius increased to TURN_RADIUS ( 2.0)")]),
        (PATH_LOST, 1, 0, [(4, "SmartRTL deactivated: buffer full")]),
        (AUX_SWITCH, 7, 1, []),
    ],
)
def test_what_is_said(code: int, a: float, b: float, said: list[tuple[int, str]]) -> None:
    assert [(note.severity, note.text) for note in EVENTS[code].notes(None, a, b)] == said


@pytest.mark.parametrize("number", [*mode_list.NAMES, 2, 99])
@pytest.mark.parametrize("speed_known", [False, True])
def test_a_mode_is_refused_only_for_what_it_lacks(number: int, speed_known: bool) -> None:
    assert set_mode.refusal(number, True, speed_known, False) == (
        ModeResult.ACCEPTED if number in mode_list.NAMES else ModeResult.NO_SUCH_MODE
    )
    if number in mode_list.NAMES:
        needs = mode_list.requires_velocity(number, False)
        refused = mode_list.requires_position(number) or (needs and not speed_known)
        assert set_mode.refusal(number, False, speed_known, False) == (
            ModeResult.REQUIRES_POSITION if refused else ModeResult.ACCEPTED
        )
