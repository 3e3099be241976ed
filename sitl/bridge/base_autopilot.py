# SPDX-License-Identifier: BSD-3-Clause
"""The part of a firmware behind the MAVLink services that all firmwares share; each adds its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..autopilot import battery, home, modes, parameter_checks, sensor_calibration
from ..autopilot.arming_checks import ArmingMethod
from ..autopilot.estimation import aiding, sources
from ..autopilot.events import emit
from ..autopilot.mission.item import MissionItem
from ..autopilot.mission.mission import Mission
from ..autopilot.mission.notes import Note
from ..autopilot.mission.storage import stored_home
from ..autopilot.mission.validate import check_all
from ..autopilot.modes import ModeResult
from ..autopilot.navigation.state import RUNNING
from ..autopilot.notes import Text
from ..autopilot.radio_checks import PARAMETERS
from ..autopilot.shell_parameters import MODE_BLOCK, NEED_LOCATION
from ..core.mavlink import MavSeverity
from .autopilot_api import Vector, Vehicle

BY_GROUND_STATION = 2
"""Reason of a mode change (ArduPilot's number)."""


class BaseAutopilot:
    """The firmware's laws, called on the vehicle's record."""

    _arming: Any
    """The firmware's module of arming,"""
    _set_mode: Any
    """and of changing the mode."""
    _auto: int
    """Number of the mode that runs missions."""
    _checks: Sequence[parameter_checks.Check] = ()
    """Arming checks of parameters."""
    _block_order: Sequence[int] = ()
    """Numbers of the modes in the order of the bits of FLTMODE_GCSBLOCK."""

    def __init__(self, vehicle: Any) -> None:
        self._vehicle: Vehicle = vehicle
        self._v = vehicle.v
        self._sequencer = lambda: vehicle.sequencer
        self._aux = lambda: vehicle.aux
        self._notes: list[Note] = []
        values = vehicle.parameters
        names = parameter_checks.BOOT_NAMES if self._checks else ()
        self._boot_values = {name: values[name] for name in names}
        self.check_parameters()

    def take_notes(self) -> list[Note]:
        """What there is to report, once."""
        notes, self._notes = self._notes, []
        return notes

    def _say(self, severity: int, texts: list[str]) -> None:
        self._notes.extend(Text(severity, text) for text in texts)

    # ------------------------------------------------------------------ arming and modes

    def armed(self) -> bool:
        return bool(self._v.autopilot.arming.armed)

    def mode(self) -> int:
        return int(self._v.autopilot.modes.number)

    def arm(self, force: bool) -> bool:
        self.check_parameters()
        ok, texts = self._arming.arm(self._v, ArmingMethod.MAVLINK, force)
        if not (ok or force):
            texts = [*texts, *self._parameter_texts(self._arming.check(self._v) == 0, "Arm: ")]
        elif not force:
            texts = [f"Arm: {each.text}" for each in self._found if not each.forbids]
        self._say(MavSeverity.CRITICAL, self._worded(texts))
        return bool(ok)

    def disarm(self, force: bool) -> bool:
        return bool(self._arming.disarm(self._v, ArmingMethod.MAVLINK, force))

    def run_prearm_checks(self) -> None:
        self.check_parameters()
        self._say(MavSeverity.CRITICAL, self.prearm_texts(self._v, "PreArm: "))

    def refusal_texts(self, failed: int) -> list[str]:
        return self._arming_texts(self._v, failed, "Arm: ", arming=True)

    def prearm_texts(self, v: Any, prefix: str = "") -> list[str]:
        """What keeps a vehicle of this firmware from arming; ``v``: its record, or a copy of one."""
        return self._arming_texts(
            v, self._arming.check(v), prefix, reported=any(not each.forbids for each in self._found)
        )

    def check_parameters(self) -> None:
        """Make the arming checks of parameters, for the core to know."""
        self._found: list[parameter_checks.Found] = []
        if not self._checks:
            return
        v, values = self._v, self._vehicle.parameters
        mission = getattr(self._vehicle, "mission", None)
        commands = frozenset(item.command for item in mission.items) if mission is not None else frozenset()
        subject = parameter_checks.Subject(values, self._boot_values, v, commands)
        self._found = parameter_checks.look(subject, self._checks)
        bits = {
            sensor_calibration.PARAMETERS_BAD: any(f.forbids and not f.when_arming for f in self._found),
            sensor_calibration.SWITCHES_BAD: any(f.forbids and f.when_arming for f in self._found),
            sensor_calibration.NEEDS_LOCATION: values[NEED_LOCATION] != 0.0,
        }
        state = int(v.autopilot.calibrated.state)
        for bit, is_set in bits.items():
            state = state | bit if is_set else state & ~bit
        v.autopilot.calibrated.state = state

    def _parameter_texts(self, arming: bool, prefix: str) -> list[str]:
        """What is wrong with parameters, each after ``prefix``; ``arming``: with what counts at that moment."""
        return [prefix + each.text for each in self._found if arming or not each.when_arming]

    def _arming_texts(
        self, v: Any, failed: int, prefix: str, *, arming: bool = False, reported: bool = False
    ) -> list[str]:
        """Texts of failed checks, each after ``prefix``.

        Args:
            v: the vehicle's record, or a copy of one.
            failed: bits of the checks.
            prefix: "PreArm: ", "Arm: " or nothing.
            arming: at the moment of arming some parameters count that do not before.
            told: parameters have something to say that does not forbid arming.
        """
        said = list(self._arming.texts(v, failed, prefix))
        if failed & PARAMETERS or reported:
            said += self._parameter_texts(arming and self._arming.check(v) == 0, prefix)
        return self._worded(said)

    def _worded(self, texts: list[str]) -> list[str]:
        """Texts of failed checks, as the firmware says them with its present parameters."""
        return texts

    def set_mode(self, number: int) -> bool:
        if number != modes.shown(self._v.autopilot.modes) and self._is_blocked(number):
            return False
        return int(self._set_mode.request(self._v, number, BY_GROUND_STATION)) == 0  # refusals are events

    def _is_blocked(self, number: int) -> bool:
        """Whether FLTMODE_GCSBLOCK keeps ground stations from choosing a mode; reports it."""
        order, v = self._block_order, self._v
        blocked = number in order and modes.is_blocked(number, order, self._vehicle.parameters[MODE_BLOCK])
        if blocked:
            emit(v.autopilot.events, v.time_us, modes.MODE_REFUSED, float(number), float(ModeResult.GCS_BLOCKED))
        return blocked

    def run_aux_function(self, number: int, position: int) -> bool:
        ok, notes = self._aux().run(number, position)
        self._notes.extend(notes)
        return bool(ok)

    def gripper_is(self, there: bool, is_open: bool) -> None:
        """The gripper has moved, or is there no more: nothing depends on it."""

    def set_roi(self, stored: Vector | None) -> None:
        """Keep the nose on a point, NED [m], or (None) no longer: not in vehicles that steer with it."""

    def yaw_rate_target(self) -> float:
        """Rate of yaw that attitude control wants, for gimbals [rad/s]; 0 on the ground, and of vehicles without it."""
        return 0.0

    def change_reposition_speed(self, speed: float) -> bool:
        """DO_REPOSITION's speed [m/s]: means nothing to most."""
        return True

    # ------------------------------------------------------------------ home, origin, parameters

    def set_home_here(self) -> bool:
        ap = self._v.autopilot
        if not ap.estimate.position_ok or not home.set_here(ap.home, ap.estimate):
            return False
        ap.home.locked = True
        return True

    def set_home(self, lat: int, lon: int, alt: float) -> bool:
        return home.set_location(self._v.autopilot.home, self._v.autopilot.estimate, lat, lon, alt)

    def set_origin(self, lat: int, lon: int, alt: float) -> bool:
        ap = self._v.autopilot
        origin = aiding.Origin(int(lat), int(lon), float(alt))
        if ap.second_lane.runs:
            aiding.set_origin(ap.second_lane.ekf, ap.second_lane.estimate, ap.events, origin)
        return aiding.set_origin(ap.ekf, ap.estimate, ap.events, origin)

    def choose_sources(self, number: int) -> None:
        sources.choose_set(self._v.autopilot, number)

    def set_battery_left(self, percent: float) -> bool:
        ap = self._v.autopilot
        return battery.set_left(ap.battery, ap.params.BATT, percent)

    def parameter_changed(self, name: str) -> None:
        changed = getattr(self._vehicle, "parameter_changed", None)
        if changed is not None:
            changed(name)
        self.check_parameters()

    # ------------------------------------------------------------------ mission

    def mission_items(self) -> tuple[MissionItem, ...]:
        items = tuple(self._sequencer().mission.items)
        stored = self._v.autopilot.home
        if not items or not stored.is_set:
            return items
        return (stored_home(int(stored.lat), int(stored.lon), float(stored.alt)), *items[1:])

    def home_changed(self) -> None:
        stored, mission = self._v.autopilot.home, self._sequencer().mission
        if stored.is_set and not mission.items:  # home is item 0 of a mission that has no other
            alone = stored_home(int(stored.lat), int(stored.lon), float(stored.alt))
            self._sequencer().extend_mission(self._v, Mission((alone,)))

    def current_item(self) -> int:
        return int(self._v.autopilot.modes.nav.mission_current)

    def replace_mission(self, items: tuple[MissionItem, ...]) -> int:
        result, _ = check_all(items)
        if result == 0:
            self._notes.extend(self._sequencer().set_mission(self._v, Mission(items)))
        return int(result)

    def clear_mission(self) -> bool:
        if not self._sequencer().may_clear(self._v):
            return False
        self._notes.extend(self._sequencer().set_mission(self._v, Mission()))
        return True

    def set_current_item(self, seq: int, reset: bool = False) -> bool:
        ok, notes = self._sequencer().set_current(self._v, seq, reset)
        self._notes.extend(notes)
        return bool(ok)

    def jump_to_tag(self, tag: int) -> bool:
        seq = self._sequencer().mission.tagged(tag)
        return seq > 0 and self.set_current_item(seq)

    def start_mission(self) -> bool:
        nav = self._v.autopilot.modes.nav
        if self.mode() != self._auto:
            return self.set_mode(self._auto)  # it starts the mission: MODE_CHANGED reaches the sequencer
        if nav.mission_state != RUNNING:
            if not self._sequencer().mission.present:
                return False
            self._notes.extend(self._sequencer().start(self._v))
        return True
