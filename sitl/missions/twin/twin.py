# SPDX-License-Identifier: BSD-3-Clause
"""The twin of a log's flight: flown whole, in open segments and by the model alone, and with something changed."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from sitl import vehicles
from sitl.autopilot.params import parm_files
from sitl.core.algebra import euler_of
from sitl.core.compile import Progress
from sitl.core.geodesy import add_offset
from sitl.errors import OptionError
from sitl.logs.dataflash.motors import channels as motor_channels
from sitl.physics.engines import NATIVE
from sitl.scenario import Home, Scenario
from sitl.simulation import Core, Simulation
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import Airframe

from . import half_turns, inputs, legs, streams, taken_parameters
from .agreement import Agreement, Window, compare
from .flight_log import FlightLog, TwinError
from .half_turns import HalfTurn, heading
from .inputs import Inputs
from .judge import NOT_JUDGED, findings
from .log_flight import LOG_BITMASK, Change, Segments, TwinFlight

SEGMENT_S = 2.0
"""Length of an open segment."""
SETTLES_S = 0.3
"""Its beginning, which does not count: an estimated attitude errs by some tenths of a degree, and the controllers
find that out."""
MODEL_S = 0.5
"""Length of a segment in which the model alone flies."""
_ABOVE_M = 1.0
"""Segments are in the air, at least so high above the position of arming."""
WHOLE, LEGS, OPEN, MODEL, CHANGED = "", "legs.", "segments.", "model.", "changed."
"""Beginnings of the names of metrics."""


@dataclass
class Twin:
    """A log's flight and its twin, compared."""

    log: FlightLog
    frame: str
    flown: FlightLog
    changed: FlightLog | None
    """The twin with what is changed."""
    change: Change
    notes: list[str]
    """What was taken over and what was not, what ours lacks first."""
    went: list[str]
    """What went otherwise in the twin."""
    went_changed: list[str]
    whole: list[Agreement] = field(default_factory=list)
    """Over the whole flight, from arming to disarming."""
    legs: list[Agreement] = field(default_factory=list)
    """Over the whole flight, both from the beginning of each item of the mission."""
    segments: list[Agreement] = field(default_factory=list)
    """Of open segments: flown on from the logged state."""
    model: list[Agreement] = field(default_factory=list)
    """Of segments in which the model's motors do what the log's did."""
    difference: list[Agreement] = field(default_factory=list)
    """Of the changed twin from the twin."""
    opened: tuple[Window, ...] = ()
    """Open segments as they were flown."""

    @property
    def begins(self) -> tuple[float, ...]:
        """Of open segments, since arming by the log's time [s]."""
        return tuple(window.begin for window in self.opened)

    @property
    def findings(self) -> list[str]:
        """Where model or autopilot differ, in words."""
        if self.flown.stands:
            return [_STANDS, *findings((), self.segments, self.model)]
        return findings(self.whole, self.segments, self.model, self.legs)

    @property
    def differences(self) -> list[str]:
        """Those of the findings that are differences, not what could not be judged."""
        return [text for text in self.findings if not text.startswith(NOT_JUDGED)]

    def metrics(self) -> dict[str, float]:
        """All metrics by name: "height.rms", "roll_rate.vaf", "segments.roll_rate.vaf", "model.climb.rms" ..."""
        found: dict[str, float] = {}
        for part, agreements in (
            (WHOLE, self.whole), (LEGS, self.legs), (OPEN, self.segments), (MODEL, self.model),
            (CHANGED, self.difference),
        ):  # fmt: skip
            for one in agreements:
                name = part + one.quantity.name
                found |= {f"{name}.rms": one.rms, f"{name}.max": one.worst, f"{name}.bias": one.bias}
                found[f"{name}.vaf"] = one.vaf
        return found

    def to_json(self) -> dict[str, Any]:
        """All of it but the series."""
        return {
            "log": str(self.log.path), "firmware": self.log.columns.firmware, "flight": self.log.number,
            "frame": self.frame, "seconds": self.log.span.length, "aligned": "arming",
            "changed": self.change.words, "notes": self.notes, "twin": self.went,
            "changed_twin": self.went_changed, "findings": self.findings, "metrics": self.metrics(),
        }  # fmt: skip


def fly(
    path: str | Path,
    frame: str | Airframe,
    *,
    flight: int | None = None,
    seed: int = 0,
    physics: str = NATIVE,
    change: Change = Change(),  # noqa: B008 it is frozen
    wind: tuple[float, float] | None = None,
    segments: bool = True,
    core: Core | None = None,
    progress: Progress | None = None,
    keep: Path | None = None,
) -> Twin:
    """Fly the flight of a log again, and compare.

    Args:
        path: of the log, DataFlash.
        frame: airframe: its name, or the path of a file that defines it.
        flight: number of the flight in the log, from 1; None: the one that was armed longest.
        seed: of the twin's sensor noise and turbulence.
        physics: engine.
        change: with something in it, the flight is flown once more with that.
        wind: speed [m/s] and where it came from [deg] in the log's flight; None: as the log's estimator knew it.
        segments: fly open segments, too: of copters on native physics.
        core: of the kind of vehicle, if it is loaded already.
        progress: called for each unit that is compiled.
        keep: folder for the twins' own logs.

    Raises:
        TwinError, sitl.logs.tlog.LogError: the log has no flight that can be flown again, or its twin does not fly.
        OptionError, sitl.vehicles.AirframeError: an argument that cannot be taken, named.
    """
    with ExitStack() as stack:
        folder = keep if keep is not None else Path(stack.enter_context(tempfile.TemporaryDirectory()))
        return _Twins(path, frame, flight, seed, physics, change, wind, core, progress, folder).fly(segments)


class _Twins:
    """The flights of one log."""

    def __init__(
        self,
        path: str | Path,
        frame: str | Airframe,
        flight: int | None,
        seed: int,
        physics: str,
        change: Change,
        wind: tuple[float, float] | None,
        core: Core | None,
        progress: Progress | None,
        folder: Path,
    ) -> None:
        self.log = log = FlightLog(path, flight)
        self.airframe = airframe = vehicles.load(frame)
        if airframe.kind != log.kind:
            raise OptionError(f"frame {airframe.name} is a {airframe.kind}, log {str(path)!r} is of a {log.kind}")
        self.kind = KINDS[airframe.kind]
        table = self.kind.firmware.table
        if unknown := [name for name in change.params if name not in table]:
            raise parm_files.ParameterError(parm_files.unknown(self.kind.name, unknown, table))
        parm_files.check(table, change.params, "--set")
        self.taken = taken_parameters.taken(log, table)
        self.taken.values.is_reported = True
        self.inputs: Inputs = inputs.of(log)
        self.wind = wind
        self.seed, self.physics, self.change, self.progress = seed, physics, change, progress
        self.core, self.folder = core, folder
        self.home: Home | None = None
        self.heavier = with_mass(airframe, change.mass) if change.mass else airframe

    def fly(self, segments: bool) -> Twin:
        """All of them."""
        then = Change(wind=self.wind)
        flown, flight = self._flown("twin", self.airframe, then)
        went = flight.notes
        changed: FlightLog | None = None
        went_changed: list[str] = []
        if self.change.words:
            both = self.change if self.change.wind is not None else replace(self.change, wind=self.wind)
            changed, flight = self._flown("changed", self.heavier, both)
            went_changed = flight.notes
        found = Twin(self.log, self.airframe.name, flown, changed, self.change, self._notes(), went, went_changed)
        quantities = streams.QUANTITIES[self.log.kind]
        all_of_it, in_step = [Window(0.0, self.log.span.length)], legs.windows(self.log, flown)
        turns = half_turns.opposite_turns(heading(self.log), heading(flown), in_step or all_of_it)
        found.whole = _compared(quantities, self.log, flown, all_of_it, turns)
        found.legs = _compared(quantities, self.log, flown, in_step, turns)
        found.went += legs.late(legs.steps(self.log, flown)) + half_turns.words(turns)
        if changed is not None:
            found.difference = _compared(quantities, flown, changed, all_of_it)
        if segments and not self._has_segments:
            found.notes.append("open segments are flown by copters on native physics only")
        elif segments:
            found.segments, opened, turns = self._segments("segments", SEGMENT_S, False, then)
            found.went += half_turns.words(turns, "in open segments ")
            found.model, *_ = self._segments("model", MODEL_S, True, then)
            found.opened = tuple(opened)
            by_motors = _BY_THRUST if self._outputs_hz < RATES_HZ else (*_BY_THRUST, *_BY_TORQUE)
            found.model = [one for one in found.model if one.quantity.name in by_motors]
            if by_motors == _BY_THRUST and found.model:
                found.notes.append(
                    f"motor outputs are logged {self._outputs_hz:.0f} times a second: at less than {RATES_HZ:.0f} they "
                    "tell of the model's thrust, not of its torques"
                )
        return found

    @property
    def _has_segments(self) -> bool:
        return self.log.kind == "copter" and self.physics == NATIVE

    def _notes(self) -> list[str]:
        log, notes = self.log, self.taken.notes()
        modes = self.kind.firmware.mode_names
        if missing := [mode for mode in self.inputs.modes if mode.number not in modes]:
            names = sorted({inputs.mode_name(log.kind, mode.number) for mode in missing})
            notes.insert(0, f"modes of the log not in this autopilot: {', '.join(names)} ({len(missing)} changes)")
        if log.kind == "copter":
            motors, rotors = len(motor_channels(log.columns)), len(self.airframe.rotors)  # type: ignore[attr-defined]
            if motors and motors != rotors:
                notes.insert(
                    0, f"the log is of a vehicle with {motors} motors, frame {self.airframe.name} has {rotors}"
                )
        if len(log.flights) > 1:
            notes.append(f"flight {log.number} of {len(log.flights)} in the log (--flight)")
        if not log.span.is_whole:
            notes.append(f"the log ends {log.span.length:.0f} s after arming, while armed: it is compared up to there")
        if log.columns.skipped:
            notes.append(f"the log is damaged: {log.columns.skipped} bytes of it are no messages")
        if log.columns.truncated:
            notes.append("the log is cut off within a message")
        if self.kind.flies:
            notes.append(self._wind_note())
        return notes + self.inputs.notes + ["both flights are aligned by the moment of arming"]

    def _wind_note(self) -> str:
        if self.wind is not None:
            return f"wind of the log's flight: {self.wind[0]:g} m/s from {self.wind[1]:g} deg, as given"
        if self.inputs.wind:
            fast = max(wind.speed for wind in self.inputs.wind)
            return f"wind as the log's estimator knew it, up to {fast:.1f} m/s"
        if any(name.startswith("SIM_WIND_SPD") and value for name, value in self.taken.values.items()):
            return "wind as the log's SIM_WIND_ parameters say"
        return "the log has no estimate of the wind: the twin flies in calm air (--logged-wind)"

    def _flown(
        self, name: str, airframe: Airframe, change: Change, segments: Segments | None = None
    ) -> tuple[FlightLog, TwinFlight]:
        is_open = segments is not None
        params = self.taken.values | {
            "LOG_BITMASK": LOG_BITMASK, "LOG_BACKEND_TYPE": 1.0, "LOG_DISARMED": 0.0, **change.params
        }  # fmt: skip
        home = self.log.home() if is_open else self._home(params)
        simulation = self._power_on(airframe, home, params, "truth" if is_open else "ekf")
        path = self.folder / f"{name}.bin"
        path.unlink(missing_ok=True)
        try:
            flight = TwinFlight(self.log, self.inputs, self.taken.changes, simulation, path, change, segments)
            flight.fly()
        finally:
            simulation.close()
        try:
            flown = FlightLog(path, must_move=not self._has_segments)
            return flown, flight
        except TwinError as error:
            why = "; ".join(flight.notes) or "it says no reason"
            raise TwinError(f"the twin of log {self.log.name!r} does not fly its flight: {error}: {why}") from None

    def _power_on(self, airframe: Airframe, home: Home, params: dict[str, float], estimator: str) -> Simulation:
        scenario = Scenario(
            airframe, home=home, seed=self.seed, params=params, physics=self.physics, estimator=estimator
        )
        simulation = Simulation(scenario, core=self.core, progress=self.progress)
        if self.physics == NATIVE:
            self.core = simulation.core
        return simulation

    def _home(self, params: dict[str, float]) -> Home:
        """Where the twin has to stand so that its estimate at arming is the log's: receivers err, and missions are at
        positions on the globe."""
        if self.home is not None:
            return self.home
        logged = self.log.home()
        simulation = self._power_on(self.airframe, logged, params, "ekf")
        try:
            TwinFlight(self.log, self.inputs, (), simulation, Path(), Change()).stand_by()
            estimate = simulation.v.autopilot.estimate
            there = add_offset(estimate.origin_lat, estimate.origin_lon, float(estimate.pos[0]), float(estimate.pos[1]))
            height = float(estimate.origin_alt) - float(estimate.pos[2])
            yaw = math.degrees(euler_of(estimate.q).yaw)
        finally:
            simulation.close()
        self.home = (
            2.0 * logged[0] - there.lat * 1e-7, 2.0 * logged[1] - there.lon * 1e-7, 2.0 * logged[2] - height,
            (2.0 * logged[3] - yaw) % 360.0,
        )  # fmt: skip
        return self.home

    def _segments(
        self, name: str, seconds: float, driven: bool, change: Change
    ) -> tuple[list[Agreement], list[Window], list[HalfTurn]]:
        """Agreement within segments, these as they were flown, and half turns that were flown the other way."""
        planned = self._windows(seconds)
        if not planned:
            return [], [], []
        flown, flight = self._flown(name, self.airframe, change, Segments(planned, driven))
        opened = flight.opened
        judged = opened if driven else [one._replace(begin=one.begin + SETTLES_S) for one in opened]
        turns = [] if driven else half_turns.opposite_turns(heading(self.log), heading(flown), judged)
        quantities = (*streams.QUANTITIES[self.log.kind], *([streams.THRUST] if driven else []))
        found = _compared(quantities, self.log, flown, judged, turns, each=True)
        return found, opened, turns

    @property
    def _outputs_hz(self) -> float:
        return self.log.table("RCOU").rate if self.log.has("RCOU") else 0.0

    def _windows(self, seconds: float) -> tuple[Window, ...]:
        """One after the other while the log's vehicle is in the air; each begins when rates were logged."""
        log = self.log
        table = log.estimate()
        time = log.since_arming(table)
        height = log.at_arming(time, table["PD"]) - table["PD"]
        high = (time >= 0.0) & (time <= log.span.length) & (height > _ABOVE_M)
        if not high.any():
            return ()
        name = "RATE" if log.has("RATE", "R") else "ATT"
        sampled = log.since_arming(log.table(name))
        begin, end = float(time[high][0]), float(time[high][-1])
        found: list[Window] = []
        while begin + seconds <= end:
            k = int(np.searchsorted(sampled, begin - 1e-6))
            if k >= len(sampled) or sampled[k] + seconds > end:
                break
            begin = float(sampled[k])
            after = int(np.searchsorted(sampled, begin + seconds - 1e-6))
            later = float(sampled[after]) if after < len(sampled) else begin + seconds
            if np.interp(begin, time, height) > _ABOVE_M and later - begin < 1.5 * seconds:
                found.append(Window(begin, later))
            begin = later
        return tuple(found)


_STANDS = (
    "the twin never left the ground by what was done in the log's flight: its lift, or what it waits for, differs; "
    "open segments alone tell of it"
)
_BY_THRUST = ("height", "climb", "acceleration", "thrust", "voltage", "current")
"""Quantities that follow from the motors' outputs together."""
_BY_TORQUE = ("position", "speed", "roll", "pitch", "yaw", "roll_rate", "pitch_rate", "yaw_rate")
"""Those that follow from their differences."""
RATES_HZ = 20.0
"""Motor outputs that are logged less often say nothing of rates."""


def _compared(
    quantities: Iterable[streams.Quantity],
    log: FlightLog,
    flown: FlightLog,
    windows: Sequence[Window],
    turns: Sequence[HalfTurn] = (),
    each: bool = False,
) -> list[Agreement]:
    straight = half_turns.without(windows, turns, whole=each)
    found = (compare(q, log, flown, straight if q.turns else windows, each=each) for q in quantities)
    return [one for one in found if one is not None]


def with_mass(airframe: Airframe, text: str) -> Airframe:
    """An airframe of another mass [kg]: "2.1", or "+0.5" and "-0.2", which are added to its own.

    Raises:
        OptionError: it is no mass.
    """
    was = float(airframe.value("mass"))
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    mass = was + value if text.strip()[:1] in "+-" else value
    if not (math.isfinite(mass) and mass > 0.001):
        raise OptionError(
            f"mass {text!r}: a mass [kg] is needed, or what is added to the {was:g} kg of the airframe: +0.5"
        )
    return replace(airframe, properties={**airframe.properties, "mass": mass})
