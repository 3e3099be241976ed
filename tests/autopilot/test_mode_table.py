# SPDX-License-Identifier: BSD-3-Clause
"""What the tables of modes say, modes of other packages that cannot be taken, positions of the mode switch."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.autopilot import mode_switch, modes
from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.copter.modes import mode_list
from sitl.autopilot.copter.modes.state import Modes as CopterModes
from sitl.autopilot.copter.modes.state import PilotState
from sitl.autopilot.copter.parameters import Parameters
from sitl.autopilot.modes import (
    MODE_CHANGED,
    MODE_REFUSED,
    ModeReason,
    ModeResult,
    is_blocked,
    numbers,
    with_registered,
)
from sitl.autopilot.rover.modes import mode_list as rover
from sitl.autopilot.state import Modes, Radio
from sitl.core.extensions import ExtensionError

CUSTOM = {
    "STABILIZE": 0, "ACRO": 1, "ALT_HOLD": 2, "AUTO": 3, "GUIDED": 4, "LOITER": 5, "RTL": 6, "CIRCLE": 7, "LAND": 9,
    "DRIFT": 11, "FLIP": 14, "AUTOTUNE": 15, "POSHOLD": 16, "BRAKE": 17, "THROW": 18, "AVOID_ADSB": 19,
    "GUIDED_NOGPS": 20, "SMART_RTL": 21, "FLOWHOLD": 22, "FOLLOW": 23, "ZIGZAG": 24, "SYSTEMID": 25, "AUTO_RTL": 27,
    "TURTLE": 28,
}  # fmt: skip
"""COPTER_MODE of MAVLink."""
MANUAL = {"STABILIZE", "ACRO", "TURTLE", "SYSTEMID"}
CLIMB_STICK = {"ALT_HOLD", "LOITER", "POSHOLD", "FLOWHOLD", "ZIGZAG", "AUTOTUNE"}
BY_ITSELF = {"AUTO", "GUIDED", "RTL", "CIRCLE", "LAND", "BRAKE", "AVOID_ADSB", "GUIDED_NOGPS", "SMART_RTL", "FOLLOW"}
BY_ITSELF |= {"AUTO_RTL"}


def test_numbers_are_mavlinks() -> None:
    assert {name: number for number, name in mode_list.NAMES.items()} == CUSTOM


@pytest.mark.parametrize("name", CUSTOM)
def test_what_drives_the_throttle_and_who_flies(name: str) -> None:
    number = CUSTOM[name]
    assert mode_list.is_known(number) and not mode_list.is_known(number + 100)
    assert mode_list.has_manual_throttle(number) == (name in MANUAL)
    assert mode_list.has_climb_stick(number) == (name in CLIMB_STICK)
    assert mode_list.is_autonomous(number) == (name in BY_ITSELF)
    assert mode_list.requires_pilot(number) == (name in {"STABILIZE", "ACRO", "DRIFT", "TURTLE"})


@pytest.mark.parametrize(
    ("name", "any_throttle", "idles"), (("GUIDED", True, False), ("THROW", False, True), ("LOITER", False, False))
)
def test_who_arms_at_any_throttle_and_who_stays_armed(name: str, any_throttle: bool, idles: bool) -> None:
    number = CUSTOM[name]
    assert (mode_list.arms_at_any_throttle(number), mode_list.idles_armed(number)) == (any_throttle, idles)


ROVER = {
    "needs_velocity": {"STEERING"},
    "car_needs_velocity": {"ACRO"},
    "manual_input": {"MANUAL", "ACRO", "STEERING", "SIMPLE"},
    "autonomous": {"LOITER", "CIRCLE", "AUTO", "RTL", "SMART_RTL", "FOLLOW", "DOCK", "GUIDED"},
    "needs_pilot": set(),
}
ROVER_LACKS = {
    "controlled": {"MANUAL", "HOLD", "INITIALISING"},
    "armable": {"RTL", "SMART_RTL", "INITIALISING"},
    "selectable": {"INITIALISING"},
    "needs_position": {"MANUAL", "ACRO", "STEERING", "HOLD"},
}


@pytest.mark.parametrize("flag", (*ROVER, *ROVER_LACKS))
def test_what_a_rovers_modes_are(flag: str) -> None:
    """ArduRover's Mode: is_autopilot_mode, manual input, requires_velocity and so on."""
    have = {mode.name for mode in rover.MODES if getattr(mode, flag)}
    assert have == (ROVER[flag] if flag in ROVER else {mode.name for mode in rover.MODES} - ROVER_LACKS[flag])


@pytest.mark.parametrize(
    ("flag", "names"),
    (
        ("idles_armed", {"THROW"}),
        ("ignores_simple", {"ACRO", "CIRCLE", "FLIP"}),
        ("arms_at_any_throttle", {"AUTO", "GUIDED", "GUIDED_NOGPS", "AUTO_RTL"}),
        ("manual_throttle", {"STABILIZE", "ACRO", "SYSTEMID", "TURTLE"}),
    ),
)
def test_what_a_copters_modes_are(flag: str, names: set[str]) -> None:
    assert {mode.name for mode in mode_list.MODES if getattr(mode, flag)} == names
    assert all(mode.selectable for mode in mode_list.MODES)


def test_standard_modes_are_mavlinks() -> None:
    """MAV_STANDARD_MODE: position and altitude hold, safe recovery, mission, land."""
    standard = {mode.name: mode.standard_mode for mode in mode_list.MODES if mode.standard_mode}
    assert standard == {"LOITER": 1, "ALT_HOLD": 4, "RTL": 5, "AUTO": 6, "LAND": 7}


def test_modes_of_the_copter_that_need_a_position() -> None:
    free = {
        "STABILIZE",
        "ACRO",
        "ALT_HOLD",
        "LAND",
        "FLIP",
        "AUTOTUNE",
        "GUIDED_NOGPS",
        "FLOWHOLD",
        "SYSTEMID",
        "TURTLE",
    }
    assert {mode.name for mode in mode_list.MODES if not mode_list.requires_position(mode.number)} == free


@pytest.mark.parametrize("name", ("RTL", "CIRCLE", "LAND", "BRAKE", "SMART_RTL", "FLIP", "FOLLOW", "AUTO_RTL"))
def test_modes_that_are_never_armed(name: str) -> None:
    for method in ArmingMethod:
        assert not mode_list.may_arm(CUSTOM[name], Parameters(), int(method))


@pytest.mark.parametrize("name", ("STABILIZE", "ALT_HOLD", "LOITER", "POSHOLD"))
def test_modes_that_are_armed_by_everybody(name: str) -> None:
    for method in ArmingMethod:
        assert mode_list.may_arm(CUSTOM[name], Parameters(), int(method))


@pytest.mark.parametrize(("name", "lands"), (("LAND", True), ("STABILIZE", False), ("LOITER", False), ("RTL", False)))
def test_modes_on_their_way_to_the_ground(name: str, lands: bool) -> None:
    assert bool(mode_list.is_landing(CUSTOM[name], CopterModes())) == lands
    assert not mode_list.is_taking_off(CUSTOM[name], CopterModes())


@pytest.mark.parametrize(("bit", "name"), ((0, "STABILIZE"), (1, "ACRO"), (5, "LOITER"), (6, "CIRCLE"), (9, "FLIP")))
def test_fltmode_gcsblock_forbids_modes_by_their_bits(bit: int, name: str) -> None:
    number = CUSTOM[name]
    assert is_blocked(number, mode_list.GCS_BLOCK, float(1 << bit))
    assert not is_blocked(number, mode_list.GCS_BLOCK, float(~(1 << bit) & 0xFFFFFF))
    assert not is_blocked(number, mode_list.GCS_BLOCK, 0.0)
    assert not is_blocked(CUSTOM["RTL"], mode_list.GCS_BLOCK, float(0xFFFFFF)), "RTL and LAND have no bit"


def test_numbers_of_modes_with_a_flag() -> None:
    listed: Any = (SimpleNamespace(number=3, fast=True), SimpleNamespace(number=4, fast=False))
    assert numbers(listed, "fast") == (3,)


@pytest.mark.parametrize(
    ("changes", "message"),
    (
        ({"number": -1}, "number -1 is not within 0 .. 16777215"),
        ({"number": 2**24}, "number 16777216 is not within 0 .. 16777215"),
        ({"number": 5}, r"NEW \(5\) takes the place of LOITER \(5\)"),
        ({"name": "LOITER"}, r"LOITER \(99\) takes the place of LOITER \(5\)"),
    ),
)
def test_a_mode_of_another_package_needs_a_number_and_a_name_of_its_own(
    changes: dict[str, Any], message: str, monkeypatch: Any
) -> None:
    own = mode_list.MODES
    found = replace(own[0], **{"number": 99, "name": "NEW", **changes})
    monkeypatch.setattr(modes, "_EXTENSIONS", SimpleNamespace(of=lambda firmware: [("x", "p.m:MODE", found)]))
    with pytest.raises(ExtensionError, match=f"mode p.m:MODE: {message}"):
        with_registered("copter", own)


@pytest.mark.parametrize("number", (0, 2**24 - 1, 99))
def test_a_mode_of_another_package_comes_last(number: int, monkeypatch: Any) -> None:
    own = tuple(mode for mode in mode_list.MODES if mode.number != number)
    found = replace(own[0], number=number, name="NEW")
    monkeypatch.setattr(modes, "_EXTENSIONS", SimpleNamespace(of=lambda firmware: [("x", "p.m:MODE", found)]))
    assert with_registered("copter", own) == (*own, found)


@pytest.mark.parametrize("thing", (5, object()))
def test_what_is_no_mode_is_refused(thing: object, monkeypatch: Any) -> None:
    monkeypatch.setattr(modes, "_EXTENSIONS", SimpleNamespace(of=lambda firmware: [("x", "p.m:MODE", thing)]))
    with pytest.raises(ExtensionError, match="is no CopterMode"):
        with_registered("copter", mode_list.MODES)


@pytest.mark.parametrize("name", ("", "Spin", "9lives", "a-b", "_a", "a b"))
def test_names_of_states_are_small_letters(name: str) -> None:
    with pytest.raises(ExtensionError, match="is not small letters, digits and _"):
        modes.register_state("copter", name, "p.m:STATE")


def test_reasons_are_ardupilots() -> None:
    """ModeReason of its logs."""
    numbers_of = {reason.name: int(reason) for reason in ModeReason}
    assert numbers_of == {
        "RC": 1, "GCS": 2, "RADIO_FAILSAFE": 3, "BATTERY_FAILSAFE": 4, "GCS_FAILSAFE": 5, "EKF_FAILSAFE": 6,
        "MISSION_END": 8, "THROTTLE_LAND_ESCAPE": 9, "FENCE_BREACHED": 10, "TERRAIN_FAILSAFE": 11, "FLIP_COMPLETE": 13,
        "THROW_COMPLETE": 16, "CRASH_FAILSAFE": 19, "FAILSAFE": 25, "INITIALISED": 26, "AUTO_RTL_EXIT": 44,
    }  # fmt: skip


def test_results_of_a_change_have_numbers_of_their_own() -> None:
    """Two of one number would be one member."""
    assert [int(result) for result in ModeResult] == list(range(14)) and ModeResult.ACCEPTED == 0


@pytest.mark.parametrize(("shown", "number"), ((0, 3), (27, 27)))
def test_clients_see_the_mode_that_is_shown(shown: int, number: int) -> None:
    state = Modes()
    state.number, state.shown = 3, shown
    assert modes.shown(state) == number


def test_changes_and_refusals_are_logged() -> None:
    """MODE (number, number, reason) and ERR of subsystem FLIGHT_MODE."""
    assert MODE_CHANGED.rows(None, 5.0, float(ModeReason.GCS)) == [("MODE", (5, 5, 2))]
    assert MODE_CHANGED.rows(None, 261.0, 257.0) == [("MODE", (5, 5, 1))], "a byte each"
    assert MODE_REFUSED.rows(None, 261.0, 3.0) == [("ERR", (10, 5))]


def test_a_mode_describes_itself_by_its_file() -> None:
    assert (
        mode_list.MODES[0].description == "the sticks are lean angles and a turn rate, the throttle drives the motors"
    )
    assert replace(mode_list.MODES[0], name="OTHER").description == ""


@pytest.mark.parametrize(
    ("pulse", "position"),
    (
        (900, -1), (901, 0), (1230, 0), (1231, 1), (1360, 1), (1361, 2), (1490, 2), (1491, 3), (1620, 3), (1621, 4),
        (1749, 4), (1750, 5), (2199, 5), (2200, -1), (0, -1),
    ),
)  # fmt: skip
def test_positions_of_the_mode_switch(pulse: int, position: int) -> None:
    """https://ardupilot.org/copter/docs/common-rc-transmitter-flight-mode-configuration.html"""
    assert mode_switch.position(pulse) == position


@pytest.mark.parametrize(
    ("channel", "works", "pulse", "moved"),
    (
        (5, 1, 2000, 5),
        (1, 1, 2000, 5),
        (18, 1, 2000, 5),
        (0, 1, 2000, -1),
        (19, 1, 2000, -1),
        (5, 0, 2000, -1),
        (5, 1, 0, -1),
    ),
)
def test_a_switch_that_stays_for_a_fifth_of_a_second_has_moved(
    channel: int, works: int, pulse: int, moved: int
) -> None:
    switch, rc = PilotState(), Radio()
    switch.switch_position = switch.switch_candidate = -1
    rc.receiver_ok = works
    rc.channels[:] = pulse
    assert mode_switch.moved_to(switch, rc, channel, 1_000_000) == -1
    assert mode_switch.moved_to(switch, rc, channel, 1_199_999) == -1
    assert mode_switch.moved_to(switch, rc, channel, 1_200_000) == moved
    assert mode_switch.moved_to(switch, rc, channel, 9_000_000) == -1, "once"


@pytest.mark.parametrize(
    ("stick", "armed", "command"), ((0.89, False, 1), (0.88, False, 0), (-0.89, True, -1), (-0.88, True, 0))
)
def test_a_stick_is_full_at_eight_ninths(stick: float, armed: bool, command: int) -> None:
    assert mode_switch.rudder_command(stick, armed, 2.0) == command
