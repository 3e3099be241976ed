# SPDX-License-Identifier: BSD-3-Clause
"""HIL_ACTUATOR_CONTROLS: what the autopilot answers to a tick.

``controls`` are the record's: 0 .. 1 a rotor, -1 .. 1 a servo or a wheel's motor. ``time_usec`` is that of the
HIL_SENSOR answered.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...core.constants import TICK_US
from ...core.record_reader import RecordReader, locate
from ..dialect import message
from .protocol import ARMED, CUSTOM_MODE, LATEST_US, LOCKSTEP, RefusedError, culprit, within

KIND = message("HIL_ACTUATOR_CONTROLS")
OUTPUTS = 16
_LIMITS = (10.0,) * OUTPUTS
_NAMES = tuple(f"controls[{k}]" for k in range(OUTPUTS))


class Controls(NamedTuple):
    """An answer, checked."""

    time_us: int
    flags: int
    outputs: tuple[float, ...]
    mode: int

    @property
    def is_lockstep(self) -> bool:
        """Whether the sender waits for the next tick."""
        return self.flags & LOCKSTEP != 0

    @property
    def is_armed(self) -> bool:
        """Whether motors may turn."""
        return self.mode & ARMED != 0


def controls_writer(reader: RecordReader) -> Callable[[], bytes]:
    """A function that gives the payload for a record's actuators, as an answer to its present time."""
    read = reader.fields("time_us", "actuators.controls", "actuators.armed")
    pack = KIND.pack

    def payload() -> bytes:
        t, *outputs, armed = read()
        return pack(t, LOCKSTEP, *outputs, CUSTOM_MODE | ARMED if armed else CUSTOM_MODE)

    return payload


def read_controls(payload: bytes) -> Controls:
    """The fields, checked.

    Raises:
        RefusedError: one of them is not finite or absurd.
    """
    t, flags, *outputs, mode = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
    if not within(outputs, _LIMITS):
        raise culprit(KIND.name, _NAMES, outputs, _LIMITS)
    if t >= LATEST_US:
        raise RefusedError(f"{KIND.name}.time_usec = {t}")
    return Controls(t, flags, tuple(outputs), mode)


def rotor_range(airframe: Any) -> tuple[float, float]:
    """Actuator controls, 0 .. 1, at which the rotors of this airframe stand and turn fastest; (0, 1) without rotors."""
    if not hasattr(airframe, "control_max"):
        return 0.0, 1.0
    return float(airframe.control_min), float(airframe.control_max)


def stretch(given: Controls, lowest: float, highest: float) -> Controls:
    """Parts of the rotors' range as actuator controls, 0 .. 1."""
    span = highest - lowest
    return given._replace(outputs=tuple([lowest + span * output for output in given.outputs]))


def actuators_writer(fleet: np.ndarray[Any, Any], index: int) -> Callable[[Controls], None]:
    """A function that puts an answer into a record's actuators."""
    start = index * fleet.dtype.itemsize
    place = start + locate(fleet.dtype, "actuators.controls")[0]
    armed = start + locate(fleet.dtype, "actuators.armed")[0]
    memory = fleet.view("u1").data
    write, write_armed = struct.Struct(f"<{OUTPUTS}f").pack_into, struct.Struct("<q").pack_into

    def put(controls: Controls) -> None:
        write(memory, place, *controls.outputs)
        write_armed(memory, armed, 1 if controls.mode & ARMED else 0)

    return put


LATE = 400
"""After so many late answers the clock must be another one than we think."""


class ForeignClock:
    """Of one connection.

    What PX4 answers first may be a tick of some time ago, with others under way. Were each late answer a step, that
    many ticks would stay under way for good and its controls would always be so old: a step is only asked for once the
    present tick is answered. Until then time has to go on by itself.
    """

    def __init__(self) -> None:
        self._first_us = self._answered_us = -1
        self._late = 0
        self._is_in_step, self._is_lockstep = False, True

    @property
    def holds(self) -> bool:
        """Whether time waits for its controls."""
        return self._is_in_step and self._is_lockstep

    def sent(self, now_us: int) -> None:
        """It got the tick of this time [us]."""
        if self._first_us < 0:
            self._first_us = now_us

    def asks_for_step(self, given: Controls, now_us: int) -> bool:
        """Whether controls that come at this time [us] are the answer to the present tick, for the first time."""
        self._is_lockstep = given.is_lockstep
        is_new, self._answered_us = given.time_us > self._answered_us, max(given.time_us, self._answered_us)
        if not self._is_in_step:
            late_us = now_us - self._first_us - given.time_us
            if late_us > 0 and late_us % TICK_US == 0 and self._late < LATE:
                self._late += 1
                return False
            self._is_in_step = True
        return is_new and given.is_lockstep
