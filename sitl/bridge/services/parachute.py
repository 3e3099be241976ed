# SPDX-License-Identifier: BSD-3-Clause
"""The copter's parachute (CHUTE_*): released by command, switch or mission, or by itself in a fall.

Its output moves; the physics has no canopy, so that the vehicle falls on. Released in the air only, above
CHUTE_ALT_MIN, and only once: then the motors are stopped, and the vehicle cannot be armed until it boots again.
Out of control it falls; as with ArduPilot that counts when it begins above CHUTE_ALT_MIN, however low it ends.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol, cast

from ...autopilot import payload, relays
from ...autopilot.aux_switch import HIGH, LOW
from ...autopilot.mission.item import MissionItem
from ...core.constants import NEVER
from ...core.mavlink import MavResult, MavSeverity
from ..host import Host
from .outputs import OFF, ON, OutputService
from .payload import PayloadService
from .statustext import StatusTextService

DISABLE, ENABLE, RELEASE = 0, 1, 2
"""PARACHUTE_ACTION"""
EVERY_US = 100_000
"""So often a fall is looked for."""
FALLS_US = 1_000_000
"""A fall lasts so long before the parachute is released."""
OPEN_US = 2_000_000
"""So long the output stays at CHUTE_SERVO_ON, unless it is to stay there for ever."""
LEAN_ERROR_MAX = math.radians(30.0)
"""A vehicle that is further from the lean that it wants is out of control [rad]."""
HOLD_OPEN, KEEP_MOTORS = 1, 2
"""CHUTE_OPTIONS"""
PACKED, RELEASED, OPEN, DONE = range(4)
"""Stages."""


class State(NamedTuple):
    """What it does. Times since boot [us]."""

    stage: int = PACKED
    next_us: int = NEVER
    """End of the stage."""
    lost: int = 0
    """Tenths of a second out of control."""
    fallen: float = 0.0
    """How far it has sunk since that began [m]."""
    sinks_us: int = 0
    """Since when it sinks faster than CHUTE_CRT_SINK; 0: it does not."""


class Falling(Protocol):
    """What a firmware with a parachute reports of the vehicle."""

    def armed(self) -> bool: ...
    def is_landed(self) -> bool: ...
    def height(self) -> float: ...
    def sink_rate(self) -> float: ...
    def lean_error(self) -> float: ...
    def release_parachute(self, stop_motors: bool) -> None: ...


class ParachuteService(PayloadService):
    """The parachute."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._state = State()
        self._watch(0)
        if self._is_enabled():
            self._move(False)

    @property
    def _pilot(self) -> Falling:
        return cast(Falling, self.bridge.autopilot)

    def carry_out(self, item: MissionItem) -> None:
        """A mission's DO_PARACHUTE."""
        self.act(item.p1)

    def switched(self, function: int, position: int) -> None:
        """A switch was moved: one that enables, one that releases, or one of three positions that does both."""
        if function == payload.SWITCH_PARACHUTE_RELEASE:
            if position == HIGH:
                self.act(RELEASE)
            return
        three = function == payload.SWITCH_PARACHUTE
        self.act(ENABLE if position == HIGH or (three and position != LOW) else DISABLE)
        if three and position == HIGH:
            self.act(RELEASE)

    def act(self, action: float) -> int:
        """A PARACHUTE_ACTION. Its MAV_RESULT: releasing is accepted even where nothing comes of it."""
        if action not in (DISABLE, ENABLE, RELEASE):
            return MavResult.FAILED
        if action == RELEASE:
            self._release_by_command()
        elif "CHUTE_ENABLED" in self._values.table:
            self._values["CHUTE_ENABLED"] = action
            self.parameter_changed("CHUTE_ENABLED")
        return MavResult.ACCEPTED

    def parameter_changed(self, name: str) -> None:
        """A parachute that a client enables is there at once."""
        if name == "CHUTE_ENABLED":
            self._state = self._state._replace(lost=0, sinks_us=0)
            self._watch(self.bridge.now_us)

    def _is_enabled(self) -> bool:
        return self._value("CHUTE_ENABLED") > 0.0

    def _watch(self, now_us: int) -> None:
        self.due_us = now_us + EVERY_US if self._state.stage == PACKED and self._is_enabled() else self._state.next_us

    def _release_by_command(self) -> None:
        pilot, say = self._pilot, self.bridge.get(StatusTextService).say
        if not self._is_enabled() or self._state.stage != PACKED:
            return
        if pilot.is_landed():
            say(MavSeverity.INFO, "Parachute: Landed")
        elif self._is_low():
            say(MavSeverity.ALERT, "Parachute: Too low")
        else:
            self._release()

    def _is_low(self) -> bool:
        return bool(0.0 < self._values["CHUTE_ALT_MIN"] > self._pilot.height())

    def _release(self) -> None:
        self.bridge.get(StatusTextService).say(MavSeverity.INFO, "Parachute: Released")
        self._pilot.release_parachute(int(self._values["CHUTE_OPTIONS"]) & KEEP_MOTORS == 0)
        delay_us = round(min(max(self._values["CHUTE_DELAY_MS"], 0.0), 1e6) * 1e3)
        self._state = State(RELEASED, self.bridge.now_us + delay_us)
        self.due_us = self._state.next_us

    def _move(self, on: bool) -> None:
        kind = int(self._values["CHUTE_TYPE"])
        if 0 <= kind < relays.RELAYS:
            self.bridge.get(OutputService).set_relay(kind, ON if on else OFF)
        elif kind == payload.PARACHUTE_BY_SERVO:
            self._send(payload.PARACHUTE, self._values["CHUTE_SERVO_ON" if on else "CHUTE_SERVO_OFF"])

    def service(self, now_us: int) -> None:
        state = self._state
        if state.stage == PACKED:
            self._watch(now_us)
            if self._is_enabled():
                self._look_for_a_fall(now_us)
        elif state.stage == RELEASED and now_us >= state.next_us:
            self._move(True)
            stays = int(self._values["CHUTE_OPTIONS"]) & HOLD_OPEN
            self._state = State(DONE) if stays else State(OPEN, now_us + OPEN_US)
            self.due_us = self._state.next_us
        elif state.stage == OPEN and now_us >= state.next_us:
            self._move(False)
            self._state = State(DONE)
            self.due_us = NEVER

    def _look_for_a_fall(self, now_us: int) -> None:
        pilot = self._pilot
        if not pilot.armed() or pilot.is_landed():
            self._state = State()
            return
        sinks_us = self._state.sinks_us
        if 0.0 < self._values["CHUTE_CRT_SINK"] < pilot.sink_rate():
            sinks_us = sinks_us or now_us
        else:
            sinks_us = 0
        lost = self._state.lost
        fallen = self._state.fallen + pilot.sink_rate() * EVERY_US * 1e-6 if lost else 0.0
        out_of_control = pilot.lean_error() > LEAN_ERROR_MAX and (lost > 0 or not self._is_low())
        lost = lost + 1 if out_of_control else max(lost - 1, 0)
        if lost > 1 and fallen <= 0.0:
            lost = 0
        self._state = self._state._replace(lost=lost, fallen=fallen, sinks_us=sinks_us)
        sinks = sinks_us and now_us - sinks_us >= FALLS_US and not self._is_low()
        if lost * EVERY_US >= FALLS_US or sinks:
            self._release()
