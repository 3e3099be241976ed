# SPDX-License-Identifier: BSD-3-Clause
"""What of two flights is laid over each other: quantities, each with its unit, from the messages of a log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.logs.dataflash import motors as dataflash_motors

from .flight_log import FlightLog

Array = np.ndarray[Any, Any]


class Stream(NamedTuple):
    """A quantity over a flight."""

    time: Array
    """Since arming, shape (n,) [s]."""
    values: Array
    """Shape (n, columns), in the quantity's unit."""


@dataclass(frozen=True)
class Quantity:
    """A quantity that two flights have."""

    name: str
    """As limits and JSON have it."""
    title: str
    unit: str
    moves: float
    """In its unit: what moves less is noise and rounding, of which nothing is to be accounted for."""
    of: Callable[[FlightLog], Stream | None]
    """None: the log does not have it."""
    columns: tuple[str, ...] = ("",)
    """What its columns are."""
    is_angle: bool = False
    """In degrees, and turns round."""
    is_vector: bool = False
    """The root mean square is that of the vector's length, not that of a column."""
    adds_up: bool = False
    """In open segments it counts from the beginning of each."""
    is_asked: bool = False
    """The autopilot's, not the vehicle's: what it asks for."""
    turns: bool = False
    """Reports turning: it does not count where the twin turned the other way round."""


def _fields(name: str, *fields: str, scale: float = 1.0, instance: int | None = None) -> Callable[..., Stream | None]:
    def of(log: FlightLog) -> Stream | None:
        if not log.has(name, *fields):
            return None
        table = log.table(name, instance)
        if not len(table):
            return None
        return Stream(log.since_arming(table), np.stack([scale * table[field] for field in fields], 1))

    return of


def _from_arming(stream: Callable[[FlightLog], Stream | None], sign: float = 1.0) -> Callable[..., Stream | None]:
    """The same, counted from what it was when the vehicle was armed."""

    def of(log: FlightLog) -> Stream | None:
        found = stream(log)
        if found is None:
            return None
        first = np.array([log.at_arming(found.time, column) for column in found.values.T])
        return Stream(found.time, sign * (found.values - first))

    return of


def _estimate(*fields: str, scale: float = 1.0) -> Callable[[FlightLog], Stream | None]:
    def of(log: FlightLog) -> Stream | None:
        table = log.estimate()
        return Stream(log.since_arming(table), np.stack([scale * table[field] for field in fields], 1))

    return of


def _speed(log: FlightLog) -> Stream | None:
    table = log.estimate()
    return Stream(log.since_arming(table), arrays.hypot(table["VN"], table["VE"])[:, None])


_BY_STICK = (0, 1)
"""Modes whose throttle is the stick's: STABILIZE, ACRO."""


def _acceleration(field: str) -> Callable[[FlightLog], Stream | None]:
    """Upward; ArduPilot writes m/s^2 since 4.7, cm/s^2 before, and this simulator as its units say. None is asked for
    (ADes) where the stick is the throttle: the log repeats what was asked for last."""

    def of(log: FlightLog) -> Stream | None:
        in_metres = log.version >= (4, 7) and "gym-sitl" not in log.columns.firmware
        found = _fields("RATE", field, scale=1.0 if in_metres else 0.01)(log)
        mode = log.every("MODE")
        if found is None or field != "ADes" or mode is None or "ModeNum" not in mode:
            return found
        before = np.searchsorted(log.since_arming(mode), found.time, "right") - 1
        by_stick = np.isin(mode["ModeNum"][np.maximum(before, 0)], _BY_STICK)
        return Stream(found.time[~by_stick], found.values[~by_stick])

    return of


def motors(log: FlightLog) -> Stream | None:
    """Outputs of the motors [%], in the order of their numbers."""
    channels = dataflash_motors.channels(log.columns)
    if not channels or not log.has("RCOU", *(f"C{channel}" for channel in channels)):
        return None
    table = log.table("RCOU")
    low, high = dataflash_motors.pulses(log.columns.parameters)
    outputs = [100.0 * np.clip((table[f"C{channel}"] - low) / (high - low), 0.0, 1.0) for channel in channels]
    return Stream(log.since_arming(table), np.stack(outputs, 1))


_BATTERY = (
    Quantity("voltage", "battery voltage", "V", 0.05, _fields("BAT", "Volt", instance=0)),
    Quantity("current", "battery current", "A", 0.5, _fields("BAT", "Curr", instance=0)),
    Quantity("consumed", "charge drawn", "mAh", 1.0, _from_arming(_fields("BAT", "CurrTot", instance=0)),
             adds_up=True),
)  # fmt: skip
_POSITION = Quantity(
    "position", "horizontal position", "m", 0.3, _from_arming(_estimate("PN", "PE")), ("north", "east"),
    is_vector=True, adds_up=True,
)  # fmt: skip
_HEADING = Quantity("yaw", "heading", "deg", 2.0, _fields("ATT", "Yaw"), is_angle=True, turns=True)

COPTER = (
    Quantity("height", "height above the position of arming", "m", 0.3, _from_arming(_estimate("PD"), -1.0),
             adds_up=True),
    _POSITION,
    Quantity("climb", "climb rate", "m/s", 0.15, _estimate("VD", scale=-1.0)),
    Quantity("speed", "ground speed", "m/s", 0.2, _speed),
    Quantity("roll", "roll", "deg", 1.0, _fields("ATT", "Roll")),
    Quantity("pitch", "pitch", "deg", 1.0, _fields("ATT", "Pitch")),
    _HEADING,
    Quantity("roll_rate", "roll rate", "deg/s", 2.0, _fields("RATE", "R")),
    Quantity("pitch_rate", "pitch rate", "deg/s", 2.0, _fields("RATE", "P")),
    Quantity("yaw_rate", "yaw rate", "deg/s", 2.0, _fields("RATE", "Y"), turns=True),
    Quantity("acceleration", "upward acceleration", "m/s^2", 0.3, _acceleration("A")),
    Quantity("asked_roll", "desired roll", "deg", 1.0, _fields("ATT", "DesRoll"), is_asked=True),
    Quantity("asked_pitch", "desired pitch", "deg", 1.0, _fields("ATT", "DesPitch"), is_asked=True),
    Quantity("asked_acceleration", "desired upward acceleration", "m/s^2", 0.3,
             _acceleration("ADes"), is_asked=True),
    Quantity("throttle", "throttle output", "%", 1.0, _fields("CTUN", "ThO", scale=100.0)),
    Quantity("motors", "motor outputs", "%", 1.0, motors),
    *_BATTERY,
)  # fmt: skip

THRUST = Quantity("thrust", "thrust over mass", "m/s^2", 0.3, _fields("IMU", "AccZ", scale=-1.0, instance=0))
"""Of the model alone: unlike the upward acceleration it does not fall when the model leans by the log's outputs."""

ROVER = (
    _POSITION,
    Quantity("speed", "speed", "m/s", 0.1, _fields("THR", "Speed")),
    _HEADING,
    Quantity("yaw_rate", "turn rate", "deg/s", 2.0, _fields("STER", "TurnRate"), turns=True),
    Quantity("asked_speed", "desired speed", "m/s", 0.1, _fields("THR", "DesSpeed"), is_asked=True),
    Quantity(
        "asked_yaw_rate", "desired turn rate", "deg/s", 2.0, _fields("STER", "DesTurnRate"), is_asked=True, turns=True
    ),
    Quantity("throttle", "throttle output", "%", 2.0, _fields("THR", "ThrOut")),
    Quantity("steering", "steering output", "%", 2.0, _fields("STER", "SteerOut", scale=1.0 / 45.0), turns=True),
    *_BATTERY,
)
QUANTITIES = {"copter": COPTER, "rover": ROVER}
