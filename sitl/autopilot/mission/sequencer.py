# SPDX-License-Identifier: BSD-3-Clause
"""Gives the core one navigation command after the other, and runs the do-commands in between.

A navigation command (waypoint, landing, ...) is flown by the core, which says when it is complete. Then the
do-commands and conditions that follow it in the mission run: the first before the next navigation command begins, the
others once it is under way; those that a condition still holds back when that completes are passed over. At the
mission's end only the first runs. DO_JUMP sends the mission elsewhere, so many times. Behaviour and texts:
ArduPilot's missions
(https://ardupilot.org/copter/docs/common-planning-a-mission-with-waypoints-and-events.html).

All run state is in the vehicle's record (``nav.mission_*``, ``nav.jump_*``): a sequencer holds nothing but
the mission. Every method takes the vehicle's record ``v`` and returns what the outside should be told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

from ...core.mavlink import MavCmd, MavSeverity
from ..arming_checks import DISARMED
from ..estimation.estimator_events import EKF_ORIGIN_SET
from ..events import EVENT_RING
from ..modes import MODE_CHANGED
from ..navigation.command import give_none
from ..navigation.state import (
    BY_LANDING,
    COMMAND_ARRIVED,
    COMMAND_COMPLETE,
    COMPLETE,
    CONDITION_NONE,
    DETOUR_REQUEST,
    DO_COMMAND,
    JUMPS,
    LANDING,
    LEG_ENDING,
    LEG_REQUEST,
    LOITER_TIME,
    LOITER_UNLIMITED,
    NONE,
    OUTWARD,
    RETURN_PATH,
    RUNNING,
    SPEED_REQUEST,
    STOPPED,
    WAYPOINT,
    Nav,
)
from ..notes import CurrentChanged, ItemReached, Text
from ..state import Vehicle
from . import jumps, returning
from .item import COMMANDS, TERRAIN_FRAMES, UNREPORTED, MissionItem
from .item_runners import Commands
from .mission import Mission
from .notes import Note
from .time_of_day import seconds_until

LEGS = (WAYPOINT, LOITER_UNLIMITED, LOITER_TIME)
"""Kinds of commands that begin anew when a mission is uploaded, the same one too."""


class Holder(Protocol):
    """What has the vehicle and keeps its mission (and puts both into snapshots)."""

    @property
    def v(self) -> Vehicle:
        """The vehicle's record."""

    mission: Mission


class Sequencer:
    """Runs one vehicle's mission with the commands of its firmware."""

    def __init__(self, holder: Holder, commands: Commands[Any], boot_us: Callable[[], int] = lambda: 0) -> None:
        """``boot_us``: Unix time of the last boot [us], for items that wait for a time of day."""
        self._holder = holder
        self.commands = commands
        self._boot_us = boot_us
        self._acts: dict[int, Callable[[Vehicle, float, float], list[Note]]] = {
            COMMAND_COMPLETE: self._command_complete,
            COMMAND_ARRIVED: self._command_arrived,
            LEG_ENDING: self._plan_leg,
            MODE_CHANGED: self._mode_changed,
            EKF_ORIGIN_SET: self._origin_set,
            returning.RETURN_WANTED: lambda v, how, flies: self.go_back(v, int(how), flies != 0.0),
            DISARMED: self._disarmed,
        }
        self._publish(holder.v)
        holder.v.autopilot.modes.nav.mission_events = holder.v.autopilot.events.count

    @property
    def mission(self) -> Mission:
        """The mission to fly."""
        return self._holder.mission

    def attend(self) -> list[Note]:
        """Handle the events that came since the last call; to be called when the core asks for attention."""
        v = self._holder.v
        ring, nav = v.autopilot.events, v.autopilot.modes.nav
        notes: list[Note] = []
        nav.mission_events = max(nav.mission_events, ring.count - EVENT_RING)
        while nav.mission_events < ring.count:
            k = nav.mission_events % EVENT_RING
            nav.mission_events += 1
            notes += self.on_event(v, int(ring.code[k]), float(ring.a[k]), float(ring.b[k]))
        return notes

    def _publish(self, v: Vehicle) -> None:
        """Tell the core what the mission is."""
        ap, mission = v.autopilot, self.mission
        ap.params.MIS.TOTAL = float(len(mission))
        ap.modes.mission_count = len(mission)
        ap.modes.mission_takes_off = _takes_off(mission)
        ap.modes.mission_lands = bool(returning.marks(mission, MavCmd.DO_LAND_START))
        ap.modes.mission_returns = returning.has_path(mission)
        ap.modes.mission_over_ground = any(
            item.frame in TERRAIN_FRAMES and item.command in COMMANDS and COMMANDS[item.command].has_location
            for item in mission.items[1:]
        )

    def set_mission(self, v: Vehicle, mission: Mission) -> list[Note]:
        """Take a new mission. One under way goes on with its present command; one that was left, at the same number.

        A leg begins anew. When its item is no longer there, the vehicle goes on to where it was going.

        Raises:
            MissionError: it holds what no firmware takes.
        """
        nav = v.autopilot.modes.nav
        seq = nav.command_seq
        self._holder.mission = Mission.of(mission.items)
        self._publish(v)
        jumps.keep(nav, {})
        notes: list[Note] = []
        if nav.mission_state == RUNNING:
            nav.condition_kind, nav.mission_do_next = CONDITION_NONE, 0
            is_leg = nav.command_kind in LEGS
            if is_leg and self.mission.get(seq) is not None:
                self._run_from(v, seq, notes)
                notes.append(Text(MavSeverity.CRITICAL, "Auto mission changed, restarted command"))
            else:
                self._look_ahead(v)
                if is_leg:
                    notes.append(Text(MavSeverity.CRITICAL, "Auto mission changed but failed to restart command"))
            return notes
        if not mission.present:
            nav.mission_state = STOPPED
            self._set_current(nav, 0, notes)
        return notes

    def extend_mission(self, v: Vehicle, mission: Mission) -> None:
        """Take a mission that begins as the present one and has more items; what is run of it stays as it is."""
        self._holder.mission = mission
        self._publish(v)

    def may_clear(self, v: Vehicle) -> bool:
        """Whether MISSION_CLEAR_ALL is taken: not while the mission runs."""
        return v.autopilot.modes.nav.mission_state != RUNNING

    def start(self, v: Vehicle) -> list[Note]:
        """AUTO was entered: start the mission, or go on where it was (MIS_RESTART, MISSION_SET_CURRENT).

        Before the estimator has an origin no location means anything: then it waits for that.
        """
        ap = v.autopilot
        nav = ap.modes.nav
        notes: list[Note] = []
        if not self.mission.present or not ap.estimate.origin_set:
            return notes
        restart = ap.params.MIS.RESTART == 1 and not nav.mission_resume
        if restart or nav.mission_state == COMPLETE or self.mission.get(nav.mission_current) is None:
            jumps.keep(nav, {})
            nav.mission_current = 0
        nav.mission_resume = False
        self.commands.enter(v)
        held_back = nav.mission_do_next != 0 and nav.mission_current != 0
        self._run_from(v, nav.mission_do if held_back else max(nav.mission_current, 1), notes)
        return notes

    def stop(self, v: Vehicle) -> list[Note]:
        """AUTO was left: the mission stops and can be resumed.

        Legs and speeds are the new mode's: it may be using them.
        """
        nav = v.autopilot.modes.nav
        if nav.mission_state == RUNNING:
            nav.mission_state = STOPPED
        nav.mission_part = OUTWARD
        nav.condition_kind = CONDITION_NONE
        give_none(nav)
        return []

    def reset(self, v: Vehicle) -> list[Note]:
        """Back to the first item, as at disarming; a running mission starts again."""
        nav = v.autopilot.modes.nav
        notes: list[Note] = []
        jumps.keep(nav, {})
        if nav.mission_state == RUNNING:
            give_none(nav)
            self.commands.reset(v)
            if self.mission.present:
                self._run_from(v, 1, notes)
                return notes
            nav.mission_state = STOPPED
        self._set_current(nav, 0, notes)
        return notes

    def set_current(self, v: Vehicle, seq: int, reset: bool = False) -> tuple[bool, list[Note]]:
        """MISSION_SET_CURRENT: (whether there is such an item, notes).

        0 is the mission's start; a mission that runs goes there at once, with ``reset`` in AUTO also one that is
        complete. Jumps are counted anew.
        """
        nav = v.autopilot.modes.nav
        notes: list[Note] = []
        if not self.mission.present or not 0 <= seq < len(self.mission):
            return (False, notes)
        jumps.keep(nav, {})
        if nav.mission_state == RUNNING or (reset and self._in_auto(v)):
            self._run_from(v, max(seq, 1), notes)
        else:
            nav.mission_state = STOPPED
            nav.mission_resume = True
            self._resume_at(nav, max(seq, 1), notes)
        return (True, notes)

    def go_back(self, v: Vehicle, how: int, at_once: bool) -> list[Note]:
        """Go to the mission's part that brings the vehicle back: ``at_once`` when AUTO flies, else when it begins.

        ``how``: BEST, BY_LANDING or BY_PATH; there must be one.
        """
        nav = v.autopilot.modes.nav
        leg = returning.nearest_leg(self.mission, v.autopilot) if how != BY_LANDING else 0
        seq = leg or returning.nearest_landing(self.mission, v.autopilot)
        notes: list[Note] = []
        jumps.keep(nav, {})
        if at_once and nav.mission_state != STOPPED:
            self._run_from(v, seq, notes)
        else:
            self._stand_at(nav, seq, notes)
        nav.mission_part = RETURN_PATH if leg else LANDING
        notes.append(Text(MavSeverity.INFO, "Return path started" if leg else "Landing sequence start"))
        return notes

    def change_speed(self, v: Vehicle, kind: int, speed: float) -> bool:
        """DO_CHANGE_SPEED [m/s] from outside while the mission runs: legs under way go on with the new limit."""
        return v.autopilot.modes.nav.mission_state == RUNNING and self.commands.change_speed(v, kind, speed)

    def on_event(self, v: Vehicle, code: int, a: float, b: float) -> list[Note]:
        """What an event of the core means for the mission."""
        act = self._acts.get(code)
        return [] if act is None else act(v, a, b)

    # --- what follows from events

    def _command_complete(self, v: Vehicle, what: float, number: float) -> list[Note]:
        nav = v.autopilot.modes.nav
        if nav.mission_state != RUNNING:
            return []
        if what == DO_COMMAND:
            return self._condition_met(v, int(number))
        return self._complete(v) if int(number) == nav.command_count else []

    def _command_arrived(self, v: Vehicle, what: float, count: float) -> list[Note]:
        nav = v.autopilot.modes.nav
        return self._arrived(v) if nav.mission_state == RUNNING and int(count) == nav.command_count else []

    def _plan_leg(self, v: Vehicle, request: float, b: float) -> list[Note]:
        planner = self.commands.planner
        if request == LEG_REQUEST:
            planner.serve(v.autopilot, v.time_us)
        elif request == DETOUR_REQUEST:
            planner.go_on(v.autopilot, v.time_us)
        elif request == SPEED_REQUEST:
            planner.change_speed(v.autopilot)
        return []

    def _mode_changed(self, v: Vehicle, mode: float, reason: float) -> list[Note]:
        nav, number = v.autopilot.modes.nav, int(mode)
        running = nav.mission_state == RUNNING
        if number == self.commands.auto:
            return [] if running and nav.command_kind != NONE else self.start(v)
        return self.stop(v) if running and number != self.commands.auto_return else []

    def _origin_set(self, v: Vehicle, imu: float, b: float) -> list[Note]:
        waits = v.autopilot.modes.nav.mission_state == STOPPED and self._in_auto(v)
        return self.start(v) if waits else []

    def _disarmed(self, v: Vehicle, method: float, b: float) -> list[Note]:
        return [] if self._in_auto(v) and self.commands.goes_on_disarmed else self.reset(v)

    def _in_auto(self, v: Vehicle) -> bool:
        return v.autopilot.modes.number == self.commands.auto

    # --- inside

    def _stand_at(self, nav: Nav, seq: int, notes: list[Note]) -> None:
        """Go on at item ``seq``, and what is done on the way to a navigation command there, when the mission runs."""
        nav.mission_state, nav.mission_resume = STOPPED, True
        following = jumps.next_nav(self.mission, seq, jumps.runs(nav), JUMPS) or seq
        notes += [
            Text(MavSeverity.INFO, f"Mission: {k} {self.mission.items[k].title}")
            for k in dict.fromkeys((seq, following))
        ]
        self._resume_at(nav, seq, notes)

    def _resume_at(self, nav: Nav, seq: int, notes: list[Note]) -> None:
        """The mission goes on at item ``seq``; current is the navigation command there, or the next one."""
        to = jumps.next_nav(self.mission, seq, jumps.runs(nav), JUMPS) or seq
        nav.mission_do, nav.mission_do_next = (seq, seq + 1) if to != seq else (0, 0)
        self._set_current(nav, to, notes)

    def _set_current(self, nav: Nav, seq: int, notes: list[Note]) -> None:
        if nav.mission_current != seq:
            nav.mission_current = seq
            notes.append(CurrentChanged(seq))

    def _run_from(self, v: Vehicle, seq: int, notes: list[Note]) -> None:
        """Run the mission from item ``seq``: do-commands that come first, then the navigation command."""
        nav = v.autopilot.modes.nav
        nav.mission_state, nav.mission_part = RUNNING, OUTWARD
        self._advance(v, seq, notes)

    def _complete(self, v: Vehicle) -> list[Note]:
        """The navigation command under way is done."""
        nav = v.autopilot.modes.nav
        seq = nav.command_seq
        item = self.mission.get(seq)
        nav.mission_reached = seq
        notes: list[Note] = [] if item is not None and item.command in UNREPORTED else [ItemReached(seq)]
        if item is not None:
            notes += self.commands.completed(v, seq, item)
        self._advance(v, seq + 1, notes)
        return notes

    def _arrived(self, v: Vehicle) -> list[Note]:
        """The navigation command under way has come to its location."""
        seq = v.autopilot.modes.nav.command_seq
        item = self.mission.get(seq)
        return [] if item is None else self.commands.arrived(v, seq, item)

    def _advance(self, v: Vehicle, seq: int, notes: list[Note]) -> None:
        """Go on to the next navigation command from ``seq`` on, and run the first do-command on the way to it;
        the mission is complete when there is none.
        """
        nav = v.autopilot.modes.nav
        nav.condition_kind, nav.mission_do, nav.mission_do_next = CONDITION_NONE, 0, 0
        counts = jumps.runs(nav)
        ends: list[Note] = []
        for _ in range(len(self.mission) + jumps.LONGEST):
            taken: list[tuple[int, int, int]] = []
            seq = jumps.following(self.mission, seq, counts, JUMPS, taken)
            notes.extend(
                Text(MavSeverity.INFO, f"Mission: {k} Jump {done}/{_often(times)}") for k, done, times in taken
            )
            item = self.mission.get(seq)
            if item is None:
                break
            if item.is_nav and item.command in self.commands.taken:
                jumps.keep(nav, counts)
                self._give(v, seq, notes, ends)
                return
            if item.is_nav:
                notes.append(Text(MavSeverity.INFO, f"Mission: {seq} {item.title}"))
            elif nav.mission_do_next == 0:
                ends = self._do(v, seq, notes)
                nav.mission_do_next = seq + 1
            seq += 1
        jumps.keep(nav, counts)
        nav.mission_state = COMPLETE
        nav.condition_kind, nav.mission_do_next = CONDITION_NONE, 0
        _end_first(notes, ends)
        notes += self.commands.finish(v)

    def _give(self, v: Vehicle, seq: int, notes: list[Note], ends: list[Note]) -> None:
        """Begin navigation command ``seq``, and run the other do-commands before it.

        ``ends``: what is reported of the first, which has run.
        """
        nav = v.autopilot.modes.nav
        item = self.mission.items[seq]
        if item.command in returning.LANDINGS:
            nav.mission_part = LANDING
        notes.append(Text(MavSeverity.INFO, f"Mission: {seq} {item.title}"))
        self._set_current(nav, seq, notes)
        notes += self.commands.give(v, seq, self._timed(v, item))
        _end_first(notes, ends)
        self._look_ahead(v)
        if nav.mission_do_next != 0 and nav.condition_kind == CONDITION_NONE:
            self._run_do(v, notes)

    def _timed(self, v: Vehicle, item: MissionItem) -> MissionItem:
        """A delay until a time of day as one of so many seconds."""
        if item.command != MavCmd.NAV_DELAY or item.p1 > 0.0:
            return item
        return item._replace(p1=seconds_until(item, self._boot_us() + v.time_us))

    def _look_ahead(self, v: Vehicle) -> None:
        """Plan the leg after the current one."""
        nav = v.autopilot.modes.nav
        counts = jumps.runs(nav)
        seq = jumps.next_nav(self.mission, nav.command_seq + 1, counts, JUMPS)
        after = jumps.next_nav(self.mission, seq + 1, counts, JUMPS) if seq != 0 else 0
        self.commands.look_ahead(v, self.mission.get(seq), self.mission.get(after))

    def _run_do(self, v: Vehicle, notes: list[Note]) -> None:
        """Run do-commands up to the next navigation command or a condition."""
        nav = v.autopilot.modes.nav
        counts = jumps.runs(nav)  # a copy: jumps were counted on the way to the navigation command
        seq = nav.mission_do_next
        for _ in range(len(self.mission) + jumps.LONGEST):
            seq = jumps.following(self.mission, seq, counts, JUMPS)
            item = self.mission.get(seq)
            if item is None or item.is_nav:
                break
            notes += self._do(v, seq, notes)
            seq += 1
            if nav.condition_kind != CONDITION_NONE:
                nav.mission_do_next = seq
                return
        nav.mission_do_next = 0

    def _do(self, v: Vehicle, seq: int, notes: list[Note]) -> list[Note]:
        """Run do-command ``seq``; what is reported when it is done."""
        item = self.mission.items[seq]
        notes.append(Text(MavSeverity.INFO, f"Mission: {seq} {item.title}"))
        nav = v.autopilot.modes.nav
        nav.mission_do = seq
        if item.command == MavCmd.DO_LAND_START:
            nav.mission_part = LANDING
        elif item.command == MavCmd.DO_RETURN_PATH_START and nav.mission_part == OUTWARD:
            nav.mission_part = RETURN_PATH
        if item.command in self.commands.taken:
            notes += self.commands.run(v, item)
        ends: list[Note] = []
        if self.commands.skips(item):
            ends.append(Text(MavSeverity.WARNING, f"Skipping invalid cmd #{item.command}"))
        if nav.condition_kind == CONDITION_NONE and item.command not in UNREPORTED:
            ends.append(ItemReached(seq))
        return ends

    def _condition_met(self, v: Vehicle, seq: int) -> list[Note]:
        nav = v.autopilot.modes.nav
        if seq != nav.mission_do or nav.mission_do_next == 0:
            return []
        notes: list[Note] = [ItemReached(seq)]
        self._run_do(v, notes)
        return notes


BEFORE_TAKE_OFF = 16
"""So many navigation commands are looked through for a take-off."""


def _takes_off(mission: Mission) -> bool:
    """Whether the mission begins with a take-off; delays may stand before it."""
    seq = 0
    for _ in range(BEFORE_TAKE_OFF):
        seq = jumps.next_nav(mission, seq + 1, {}, JUMPS)
        item = mission.get(seq)
        if item is None or item.command != MavCmd.NAV_DELAY:
            return item is not None and item.command in (MavCmd.NAV_TAKEOFF, MavCmd.NAV_VTOL_TAKEOFF)
    return False


def _end_first(notes: list[Note], ends: list[Note]) -> None:
    """The first do-command behind a navigation command is done when that is: clients are notified of the first
    alone."""
    if any(isinstance(note, ItemReached) for note in ends):
        notes[:] = [replace(note, is_sent=False) if isinstance(note, ItemReached) else note for note in notes]
    notes += ends


def _often(times: int) -> str:
    return "unlimited" if times == jumps.FOREVER else str(times)
