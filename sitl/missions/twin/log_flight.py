# SPDX-License-Identifier: BSD-3-Clause
"""Flies a log's flight on one simulation, in lockstep, from power-on, and keeps an on-board log of it."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.autopilot.modes import shown
from sitl.autopilot.params.parm_files import ParameterError
from sitl.core.constants import TICK_US
from sitl.core.vectors import Vec3
from sitl.drop_in.stick_port import FOR_EVER_US
from sitl.logs.dataflash import bits, copter_messages, rover_messages
from sitl.logs.kind import mode_name
from sitl.physics.native.battery import OPEN_CIRCUIT
from sitl.run.runner import open_dataflash
from sitl.simulation import Simulation

from ..station import Station, StationError
from . import legs
from .agreement import Window
from .flight_log import FlightLog, TwinError
from .inputs import Inputs, Message, Mode, Wind
from .state import LoggedState

READY_S = 120.0
"""A vehicle that is not ready by then will not be [simulated s]."""
_LATEST_ARMING_S = 60.0
"""A log's vehicle that waited longer since power-on need not be waited for: its twin arms this long after it is ready,
at most."""
_FORCED = 21196.0
_ARM, _SET_MODE = 400, 176
_GRACE_S = 1.0
"""So long a twin has to change its mode by itself, where the log's vehicle did, before it is told to."""
_LANDING_S = 20.0
"""Time to come to its end for a twin whose log's vehicle is disarmed [simulated s]."""
_LATE_S = 0.1
"""What ends nearer to the log's end is no note."""
_STICK_S = 0.02
"""Between two frames of a receiver."""
_STEERED = 4
"""The first channels are sticks, which move; the others are switches."""
_SEVERE = 4
"""MAV_SEVERITY_WARNING"""
_SHOWN = 4
_PATIENCE_S = 3.0
"""So long an open segment waits for a twin that has not come to the log's item of the mission [s]."""
_STEP_US = 20_000
_LEAST_SHARE = 0.5
"""A segment of which less is left is not flown: the twin is ahead of it."""


class _Listener:
    """The vehicle's texts, with the moments at which it said them."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self.texts: list[tuple[int, str]] = []
        """(Time [us], text)"""

    def said(self, severity: int, text: str) -> None:
        """A text was sent."""
        self.texts.append((self._simulation.time_us, text))

    def parameter_set(self, name: str) -> None:
        """No text."""

    def reached(self, seq: int) -> None:
        """No text."""

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: Any, result: int) -> None:
        """No text."""


@dataclass(frozen=True)
class Segments:
    """Open segments: the vehicle is put into the logged state at the beginning of each."""

    windows: tuple[Window, ...]
    driven: bool = False
    """The rotors do what the log's motors did, whatever the autopilot wants: the model alone flies."""


@dataclass(frozen=True)
class Change:
    """What is otherwise than in the log."""

    params: Mapping[str, float] = field(default_factory=dict)
    """By name, from power-on."""
    wind: tuple[float, float] | None = None
    """Speed [m/s] and where it comes from [deg], in place of the log's."""
    faults: tuple[str, ...] = ()
    """Times in them are since arming."""
    mass: str = ""
    """Of the vehicle [kg]: "2.1", or what is added to the airframe's: "+0.5"."""

    @property
    def words(self) -> list[str]:
        """What is otherwise."""
        found = [f"{name} = {value:g}" for name, value in self.params.items()]
        if self.wind is not None:
            found.append(f"wind of {self.wind[0]:g} m/s from {self.wind[1]:g} deg")
        if self.mass:
            found.append(f"mass {self.mass} kg")
        return found + [f"fault {fault}" for fault in self.faults]


class TwinFlight:
    """One flight.

    Args:
        log: the flight that is flown again.
        inputs: what was done in it.
        changes: (time, name, value) of parameters that were set in flight.
        simulation: at power-on.
        path: of the on-board log that is kept.
        change: what is otherwise.
        segments: for open segments: the simulation flies by its true state then.
    """

    def __init__(
        self,
        log: FlightLog,
        inputs: Inputs,
        changes: Sequence[tuple[float, str, float]],
        simulation: Simulation,
        path: Path,
        change: Change,
        segments: Segments | None = None,
    ) -> None:
        self.log, self.inputs, self.changes, self.path = log, inputs, changes, path
        self.simulation, self.change, self.segments = simulation, change, segments
        self.station = Station(simulation)
        self.notes: list[str] = []
        """What went otherwise than in the log."""
        self.opened: list[Window] = []
        """Open segments as they were flown: a twin that was late or early on its mission began them in step with it."""
        self._items = legs.begun_in(log) if segments is not None and not segments.driven else []
        self._listener = _Listener(simulation)
        self._armed_us = self._shift_us = 0
        self._position = Vec3(0.0, 0.0, 0.0)
        self._state = LoggedState(log) if segments is not None else None
        self._logged = [(time, mode_name(log.kind, number)) for time, number, _ in inputs.modes]

    def fly(self) -> None:
        """Fly all of it.

        Raises:
            TwinError: the twin is never ready, or cannot be armed.
        """
        open_dataflash(self.simulation, self.path)
        if self._items:
            self.simulation.bridge.listeners.append(self._listener)
        self.stand_by()
        self._arm()
        for time_us, act in self._timeline():
            self._until(time_us)
            act()
        self._end()

    def stand_by(self) -> None:
        """From power-on to the moment of arming.

        Raises:
            TwinError: the twin is never ready.
        """
        self._charge()
        self._hear(self._pulses(0.0))
        try:
            self.station.wait_ready(READY_S)
        except StationError as error:
            raise TwinError(f"the twin of log {self.log.name!r} is not ready to arm: {error}") from None
        self._wait()
        self._prepare()

    # ------------------------------------------------------------------ before arming

    def _wait(self) -> None:
        """Arm as long after power-on as the log's vehicle, if it did so soon enough: so noise is the same, too."""
        logged_us = round(self.log.span.armed * 1e6 / TICK_US) * TICK_US
        now_us = self.simulation.time_us
        is_soon = now_us + 400_000 < logged_us <= now_us + _LATEST_ARMING_S * 1e6
        self._armed_us = logged_us if is_soon else now_us + 2_000_000
        self.station_until(self._armed_us - 200_000)

    def station_until(self, time_us: int) -> None:
        """Let time pass, to a time since the start of the simulation [us]."""
        while self.simulation.time_us < time_us:
            self.station.step(time_us)

    def _prepare(self) -> None:
        """Mission, mode and wind as they were at arming."""
        for time, items in self.inputs.missions:
            if time <= 0.0:
                self._upload(items)
        winds = [(self.change.wind)] if self.change.wind is not None else [w[1:] for w in self.inputs.wind[:1]]
        for speed, direction in winds:
            self._blow(speed, direction)
        if self.inputs.modes:
            self._ask_mode(self.inputs.modes[0].number)
        self.station_until(self._armed_us)

    def _charge(self) -> None:
        """The battery has the rest voltage that the log's had at arming."""
        log = self.log
        if not log.has("BAT", "Volt", "Curr"):
            return
        table = log.table("BAT", 0)
        time = log.since_arming(table)
        volt, amps = (log.at_arming(time, table[name]) for name in ("Volt", "Curr"))
        battery, airframe = self.simulation.v.physics.battery, self.simulation.airframe
        resistance = float(airframe.value("battery_resistance"))
        rest = volt + max(amps, 0.0) * resistance
        if not (math.isfinite(rest) and rest > 1.0):
            return
        full = float(airframe.value("battery_voltage_full"))
        if float(airframe.value("battery_capacity")) > 0.0 and OPEN_CIRCUIT[1] * full <= rest <= full:
            battery.charge = float(np.interp(rest / full, OPEN_CIRCUIT, np.linspace(0.0, 1.0, len(OPEN_CIRCUIT))))
        elif abs(rest - full) > 0.005 * full:
            battery.full_voltage = rest
            if float(airframe.value("battery_capacity")) > 0.0:
                battery.charge = 1.0
                text = f"the battery is one of {rest:.1f} V, which that of the airframe never has"
                if text not in self.notes:  # it is charged at power-on, and again at arming
                    self.notes.append(text)

    def _arm(self) -> None:
        self._charge()
        self.station.connection.endpoint.command(_ARM, 1.0, _FORCED, target=self.simulation.bridge.system)
        self._until(TICK_US)
        if not self.station.armed:
            raise TwinError(f"the twin of log {self.log.name!r} cannot be armed{self.station.why()}")
        self._position = Vec3(*map(float, self.simulation.v.physics.body.pos))
        for fault in self.change.faults:
            self.simulation.fail(fault)

    # ------------------------------------------------------------------ in flight

    def _until(self, time_us: int) -> None:
        """Let time pass to a time since arming [us], as the log's flight counts it."""
        self.station_until(self._armed_us + self._shift_us + time_us)

    def _timeline(self) -> Iterator[tuple[int, Callable[[], None]]]:
        """All that is to be done, in the order of time since arming [us]."""

        def at(rows: Sequence[Any], act: Callable[[Any], None], order: int) -> Iterator[tuple[int, int, Any, Any]]:
            return ((round(row[0] * 1e6), order, act, row) for row in rows)

        log_end = round(self.log.span.length * 1e6)
        missions = [row for row in self.inputs.missions if row[0] > 0.0]
        modes = [
            mode if mode.chosen else Mode(mode.time + _GRACE_S, mode.number, False) for mode in self.inputs.modes[1:]
        ]
        changed = [row for row in self.changes if row[1] not in self.change.params]
        winds = [] if self.change.wind is not None else self.inputs.wind
        rows = heapq.merge(
            at(missions, lambda row: self._upload(row[1]), 0),
            at(changed, lambda row: self._set(row[1], row[2]), 1),
            at(winds, self._follow_wind, 2),
            at(sorted(modes), self._follow_mode, 3),
            at(self.inputs.messages, self._send, 4),
            at(self._stick_times(), lambda row: self._hear(self._pulses(row[0])), 5),
            at(self._segment_times(), self._segment, 6),
            key=lambda row: (row[0], row[1]),
        )
        for time_us, _, act, row in rows:
            if TICK_US < time_us <= log_end:
                yield time_us, (lambda act=act, row=row: act(row))  # type: ignore[misc]

    def _upload(self, items: tuple[Any, ...]) -> None:
        simulation = self.simulation
        try:
            mission = Mission.of(items, simulation.firmware.commands.taken)
        except MissionError as error:
            self.notes.append(f"the mission is not taken: {error}")
            return
        simulation.bridge.report(simulation.sequencer.set_mission(simulation.v, mission))

    def _set(self, name: str, value: float) -> None:
        """A parameter, as a ground station would."""
        self.station.connection.endpoint.send(
            "PARAM_SET", target_system=self.simulation.bridge.system, target_component=1,
            param_id=name.encode(), param_value=value, param_type=9,
        )  # fmt: skip

    def _blow(self, speed: float, direction: float) -> None:
        simulation = self.simulation
        if not simulation.kind.flies:
            if self.change.wind is not None:
                self.notes.append(f"wind has no effect on a {simulation.kind.name}")
            return
        for name, value in (("SIM_WIND_SPD", speed), ("SIM_WIND_DIR", direction)):
            try:
                simulation.parameters.update({name: value})
            except ParameterError as error:
                self.notes.append(str(error))
            simulation.parameter_changed(name)

    def _follow_wind(self, wind: Wind) -> None:
        self._blow(wind.speed, wind.direction)

    def _ask_mode(self, number: int) -> None:
        if number in self.simulation.firmware.mode_names:
            self.station.connection.endpoint.command(
                _SET_MODE, 1.0, float(number), target=self.simulation.bridge.system
            )

    def _follow_mode(self, mode: Mode) -> None:
        if int(shown(self.simulation.v.autopilot.modes)) == mode.number or not self.station.armed:
            return
        if not mode.chosen:
            if self._mode_then(mode.time) != mode.number:
                return  # the log's vehicle has left it again
            name = mode_name(self.log.kind, mode.number)
            at = mode.time - _GRACE_S
            self.notes.append(f"{at:.1f} s: the log's vehicle went into {name} by itself; the twin was told to")
        self._ask_mode(mode.number)

    def _mode_then(self, time: float) -> int:
        return next(mode.number for mode in reversed(self.inputs.modes) if mode.time <= time)

    def _send(self, message: Message) -> None:
        target = {"target_system": self.simulation.bridge.system, "target_component": 1}
        self.station.connection.endpoint.send(message.name, **target, **message.fields)

    def _stick_times(self) -> list[tuple[float]]:
        if self.inputs.sticks is None:
            return []
        time, pulses = self.inputs.sticks
        moves = np.any(np.diff(pulses, axis=0) != 0.0, axis=1)
        found: set[float] = set()
        for k in np.flatnonzero(moves).tolist():
            begin, end = time[k], time[k + 1]
            count = max(math.ceil((end - begin) / _STICK_S), 1)
            found.update(round(begin + (end - begin) * n / count, 4) for n in range(1, min(count, 50) + 1))
        return [(t,) for t in sorted(found)]

    def _pulses(self, time: float) -> list[int]:
        """Of the sticks between two samples by a straight line, of switches as they were last."""
        if self.inputs.sticks is None:
            return []
        times, pulses = self.inputs.sticks
        last = pulses[max(int(np.searchsorted(times, time + 1e-6, "right")) - 1, 0)]
        moving = [float(np.interp(time, times, column)) for column in pulses[:, :_STEERED].T]
        return [round(value) for value in (*moving, *last[_STEERED:])]

    def _hear(self, pulses: Sequence[int]) -> None:
        sensors = self.simulation.v.sensors
        if not pulses:
            return
        for k, pulse in enumerate(pulses[: len(sensors.rc_channels)]):
            sensors.rc_channels[k] = pulse
        sensors.rc_count += 1
        sensors.rc_time_us = FOR_EVER_US

    # ------------------------------------------------------------------ open segments

    def _segment_times(self) -> list[tuple[float, Window | None]]:
        """(Time, the segment that begins then); between them rotors are driven on."""
        if self.segments is None:
            return []
        found: list[tuple[float, Window | None]] = [(window.begin, window) for window in self.segments.windows]
        if self.segments.driven:
            begins = np.array([window.begin for window in self.segments.windows])
            end = self.segments.windows[-1].end
            steps = np.arange(begins[0], end, _STICK_S)
            far = np.abs(steps[:, None] - begins[None, :]).min(1) > 0.25 * _STICK_S
            found += [(float(t), None) for t in steps[far]]
        return sorted(found, key=lambda row: row[0])

    def _segment(self, row: tuple[float, Window | None]) -> None:
        assert self._state is not None and self.segments is not None
        time, window = row
        if not self.station.armed:
            return
        if window is None:
            self._state.drive(self.simulation, time)
            return
        if self._items:
            self._fall_in_step(time)
            time = max(time, self._since_arming_s - 1e-6 * self._shift_us)
        if window.end - time > _LEAST_SHARE * (window.end - window.begin):
            self._state.put(self.simulation, time, self._position, self.segments.driven)
            self.opened.append(Window(time, window.end, 1e-6 * self._shift_us))

    @property
    def _since_arming_s(self) -> float:
        """Of the twin."""
        return 1e-6 * (self.simulation.time_us - self._armed_us)

    def _fall_in_step(self, time: float) -> None:
        """Count time from the item of the mission that both are flying; wait for a twin that is behind.

        Args:
            time: of the log, since arming [s].
        """
        flown = [one.item for one in self._items if one.time <= time]
        begins = {one.item: one.time for one in self._items}
        patience = self._since_arming_s + _PATIENCE_S
        while True:
            texts = ((1e-6 * (at - self._armed_us), text) for at, text in self._listener.texts)
            there = [one for one in legs.begun(texts) if one.item in begins]
            if there:
                last = there[-1]
                self._shift_us = round(1e6 * (last.time - begins[last.item]) / TICK_US) * TICK_US
                if last.item not in flown[:-1]:
                    break  # the same item, or the twin is ahead
            elif not flown:
                break
            if not self.station.armed or self._since_arming_s >= patience:
                break
            self.station_until(self.simulation.time_us + _STEP_US)
        self._until(round(1e6 * time))

    # ------------------------------------------------------------------ the end

    def _end(self) -> None:
        log, simulation = self.log, self.simulation
        self._until(round(log.span.length * 1e6))
        if self._state is not None:
            return
        if log.span.is_whole and self.station.armed:
            if not simulation.kind.flies:
                self.station.connection.endpoint.command(_ARM, 0.0, target=simulation.bridge.system)
                self.station.step()
            elif self.station.passes(lambda: not self.station.armed, _LANDING_S):
                late = (simulation.time_us - self._armed_us) * 1e-6 - log.span.length
                if late >= _LATE_S:
                    self.notes.append(f"the twin is disarmed {late:.1f} s later than the log's vehicle")
            else:
                self.notes.append(f"the twin is still armed {_LANDING_S:g} s after the log's vehicle was disarmed")
        since = self._armed_us * 1e-6
        severe = [f"{t - since:.1f} s: {text}" for t, severity, text in self.station.texts
                  if severity <= _SEVERE and t >= since]  # fmt: skip
        if severe:
            more = f" (and {len(severe) - _SHOWN} more)" if len(severe) > _SHOWN else ""
            self.notes.append("the twin says: " + "; ".join(severe[:_SHOWN]) + more)


LOG_BITMASK = float(
    bits.ATTITUDE_FAST | bits.ATTITUDE | bits.GPS | bits.CONTROL | bits.NAVIGATION | bits.IMU | bits.BATTERY
    | bits.COMMANDS | copter_messages.RC_OUT | copter_messages.RC_IN | rover_messages.RC | rover_messages.STEERING
)  # fmt: skip
"""Of a twin: all that is compared, at the highest rate."""
