# SPDX-License-Identifier: BSD-3-Clause
"""Auxiliary functions: what switches (RCn_OPTION) and MAV_CMD_DO_AUX_FUNCTION do (shell side).

Each firmware lists its own in ``FIRMWARE/aux_functions.py``. The core reports when a switch was moved (``aux_switch``).
Numbers: https://ardupilot.org/copter/docs/common-auxiliary-functions.html
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from ..core.geodesy import add_offset
from ..core.mavlink import MavCmd, MavFrame, MavSeverity
from . import payload
from .arming_checks import ArmingMethod
from .aux_switch import AUX_SWITCH, HIGH, LOW, MIDDLE
from .estimation.sources import choose_set
from .events import EVENT_RING
from .fence.checks import ALL, switch_by_user
from .mission.item import MissionItem, home_item
from .mission.mission import Mission
from .mission.notes import Note
from .mission.sequencer import Sequencer
from .modes import ModeReason, shown
from .notes import Switched, Text

POSITIONS = {LOW: "LOW", MIDDLE: "MIDDLE", HIGH: "HIGH"}


class Holder(Protocol):
    """What has the vehicle."""

    @property
    def v(self) -> Any:
        """The vehicle's record."""

    sequencer: Sequencer


Action = Callable[[Holder, int], list[Note]]
"""Takes the vehicle and the switch's position, and gives what there is to report."""


@dataclass(frozen=True)
class AuxFunction:
    """A function that a switch can have."""

    number: int
    act: Action
    doc: str
    """One line."""
    name: str = ""
    """As ArduPilot's "RC7: SaveWaypoint HIGH" texts say it; "": the switch is moved in silence."""
    needs_change: bool = False
    """The position in which the switch is found at first does nothing."""


class AuxFunctions:
    """One vehicle's switches, with the functions of its firmware by number."""

    def __init__(self, holder: Holder, functions: Mapping[int, AuxFunction]) -> None:
        self._holder = holder
        self._functions = functions

    def attend(self) -> list[Note]:
        """Do what the switches ask that were moved since the last call."""
        ap = self._holder.v.autopilot
        ring, notes = ap.events, list[Note]()
        ap.rc.switch_events = max(ap.rc.switch_events, ring.count - EVENT_RING)
        while ap.rc.switch_events < ring.count:
            k = ap.rc.switch_events % EVENT_RING
            ap.rc.switch_events += 1
            if ring.code[k] == AUX_SWITCH:
                notes += self._moved(int(ring.a[k]), int(ring.b[k]))
        return notes

    def _moved(self, channel: int, position: int) -> list[Note]:
        number = int(self._holder.v.autopilot.params.RC[channel - 1].OPTION)
        function = self._functions.get(number)
        if function is None:
            return [_unknown(number)]
        if position < 0 and function.needs_change:
            return []
        notes: list[Note] = []
        if function.name:
            notes.append(Text(MavSeverity.INFO, f"RC{channel}: {function.name} {POSITIONS[abs(position)]}"))
        return notes + function.act(self._holder, abs(position))

    def run(self, number: int, position: int) -> tuple[bool, list[Note]]:
        """MAV_CMD_DO_AUX_FUNCTION: whether there is such a function, and what to report."""
        function = self._functions.get(number)
        if function is None:
            return False, [_unknown(number)]
        return True, function.act(self._holder, position)


def _unknown(number: int) -> Note:
    return Text(MavSeverity.INFO, f"Invalid channel option ({number})")


def by_number(functions: tuple[AuxFunction, ...]) -> dict[int, AuxFunction]:
    """The functions of a firmware.

    Raises:
        ValueError: a number is there twice.
    """
    found = {function.number: function for function in functions}
    if len(found) != len(functions):
        raise ValueError("an auxiliary function is listed twice")
    return found


# ---------------------------------------------------------------------- what functions of all firmwares do


def change_mode(number: int, name: str, mode: int, request: Callable[[Any, int, int], int]) -> AuxFunction:
    """A function that changes to ``mode``; any lower position goes back to that of the mode switch.

    ``request``: the firmware's law of mode changes.
    """

    def act(holder: Holder, position: int) -> list[Note]:
        modes = holder.v.autopilot.modes
        if position == HIGH:
            request(holder.v, mode, ModeReason.RC)
        elif shown(modes) == mode:
            modes.pilot.switch_position = modes.pilot.switch_candidate = -1  # the mode switch is read anew
        return []

    return AuxFunction(number, act, f"high: {name}; else the mode switch's mode again")


def arm_or_disarm(number: int, arming: Any) -> AuxFunction:
    """A function that arms and disarms; ``arming``: the firmware's module."""

    def act(holder: Holder, position: int) -> list[Note]:
        if position == HIGH:
            arming.try_arm(holder.v, ArmingMethod.SWITCH, False)
        elif position == LOW:
            arming.disarm(holder.v, ArmingMethod.SWITCH, False)
        return []

    return AuxFunction(number, act, "high: arms; low: disarms", needs_change=True)


def disarm(arming: Any) -> AuxFunction:
    """A function that disarms; ``arming``: the firmware's module."""

    def act(holder: Holder, position: int) -> list[Note]:
        if position == HIGH:
            arming.disarm(holder.v, ArmingMethod.SWITCH, False)
        return []

    return AuxFunction(81, act, "high: disarms", needs_change=True)


def arm_or_stop(arming: Any) -> AuxFunction:
    """A function that arms and stops the motors; ``arming``: the firmware's module."""

    def act(holder: Holder, position: int) -> list[Note]:
        holder.v.autopilot.arming.emergency_stop = position == LOW
        if position == HIGH:
            arming.try_arm(holder.v, ArmingMethod.SWITCH, False)
        return []

    return AuxFunction(
        165, act, "high: arms; low: motors stand, and cannot be armed; middle: they may", needs_change=True
    )


def _allow_overrides(holder: Holder, position: int) -> list[Note]:
    rc = holder.v.autopilot.rc
    if position == HIGH:
        rc.override_blocked = False
    elif position == LOW:
        rc.override_blocked = True
        for k in range(len(rc.override)):
            rc.override[k] = 0
    return []


def _stop_motors(holder: Holder, position: int) -> list[Note]:
    holder.v.autopilot.arming.emergency_stop = position == HIGH
    return []


def _reset_mission(holder: Holder, position: int) -> list[Note]:
    return holder.sequencer.reset(holder.v) if position == HIGH else []


def _clear_mission(holder: Holder, position: int) -> list[Note]:
    if position == HIGH and holder.sequencer.may_clear(holder.v):
        return holder.sequencer.set_mission(holder.v, Mission())
    return []


def item_here(holder: Holder, command: int = MavCmd.NAV_WAYPOINT) -> MissionItem:
    """A mission item of where the vehicle is, its height above home."""
    ap = holder.v.autopilot
    estimate = ap.estimate
    lat, lon = add_offset(estimate.origin_lat, estimate.origin_lon, estimate.pos.x, estimate.pos.y)
    return MissionItem(
        command, MavFrame.GLOBAL_RELATIVE_ALT, x=round(lat), y=round(lon), z=ap.home.pos.z - estimate.pos.z
    )


def append_items(holder: Holder, items: list[MissionItem]) -> None:
    """Put items at the mission's end, behind home if it is empty."""
    home = holder.v.autopilot.home
    before = holder.sequencer.mission.items or (home_item(home.lat, home.lon, home.alt),)
    holder.sequencer.extend_mission(holder.v, Mission((*before, *items)))


def _fence(holder: Holder, position: int) -> list[Note]:
    ap = holder.v.autopilot
    switch_by_user(ap.fence, position == HIGH, ALL, ap.params.FENCE, ap.events, holder.v.time_us)
    return []


def _avoid_obstacles(holder: Holder, position: int) -> list[Note]:
    holder.v.autopilot.avoid.switched_off = position != HIGH
    return []


def _choose_sources(holder: Holder, position: int) -> list[Note]:
    choose_set(holder.v.autopilot, position - LOW)
    return [Text(MavSeverity.INFO, f"Using EKF Source Set {position - LOW + 1}")]


def _nothing(holder: Holder, position: int) -> list[Note]:
    return []


def without_effect(names: Mapping[int, str]) -> list[AuxFunction]:
    """Functions that are taken and told to do nothing, by number, with their names in texts."""

    def function(number: int, name: str) -> AuxFunction:
        note = Text(MavSeverity.INFO, f"Aux function {number} has no effect in this simulator")
        return AuxFunction(number, lambda holder, position: [note], "taken, without effect", name)

    return [function(number, name) for number, name in names.items()]


def fitted(number: int, doc: str, name: str = "") -> AuxFunction:
    """A function of something that is fitted to the vehicle, which is not the autopilot's."""
    return AuxFunction(number, lambda _, position: [Switched(number, position)], doc, name)


WITHOUT_EFFECT = {
    30: "", 38: "", 62: "CompassLearn", 65: "GPSDisable", 78: "RunCamControl", 79: "RunCamOSDControl",
    80: "VisOdomAlign", 85: "Generator", 100: "", 101: "", 102: "CamModeToggle", 103: "", 104: "",
    105: "GPSDisableYaw", 106: "DisableAirspeedUse", 110: "", 111: "", 113: "RetractMount2",
    156: "Torqeedo Clear Err", 158: "", 162: "FFT Notch Tuning", 164: "Pause Stream Logging", 171: "",
    177: "Mount LRF Enable",
}  # fmt: skip
"""Functions that ArduPilot takes in its simulator, of things that are not simulated here; and their names in texts."""
STICKS = {212: "roll", 213: "pitch", 214: "yaw"}

COMMON = (
    fitted(payload.SWITCH_CAMERA, "high: the camera takes a picture", "CameraTrigger"),
    AuxFunction(11, _fence, "high: all fences are on; else off", "Fence"),
    fitted(payload.SWITCH_SPRAYER, "high: the sprayer runs, disarmed as a test; else it does not", "Sprayer"),
    fitted(payload.SWITCH_GRIPPER, "high: the gripper closes; low: it opens"),
    AuxFunction(24, _reset_mission, "high: the mission goes back to its start", "MissionReset"),
    fitted(payload.SWITCH_FOLD, "high: the gimbal is folded; else MNT1_DEFLT_MODE", "RetractMount1"),
    AuxFunction(31, _stop_motors, "high: motors stand, and cannot be armed", "MotorEStop"),
    AuxFunction(40, _avoid_obstacles, "high: obstacles are avoided (AVOID_*); else they are not", "AvoidProximity"),
    AuxFunction(46, _allow_overrides, "high: RC_CHANNELS_OVERRIDE and MANUAL_CONTROL are heard; low: they are not"),
    AuxFunction(58, _clear_mission, "high: clears the mission, unless it is being run", "ClearWaypoint"),
    fitted(
        payload.SWITCH_LOCK, "high: the sticks' yaw of the gimbal counts from north; else from the nose", "MountLock"
    ),
    *(
        fitted(n, f"high: relay {k + 1} is on; low: it is off", f"Relay{k + 1}")
        for n, k in payload.SWITCH_RELAYS.items()
    ),
    AuxFunction(90, _choose_sources, "EK3_SRC1_* (low), EK3_SRC2_* (middle) or EK3_SRC3_* (high) from now on"),
    *without_effect(WITHOUT_EFFECT),
    *(AuxFunction(n, _nothing, f"{axis} of the gimbal, by the channel's stick") for n, axis in STICKS.items()),
)
"""Those that do the same in every firmware."""
