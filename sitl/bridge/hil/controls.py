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
from ...core.mavlink import MavModeFlag
from ...core.record_reader import RecordReader, locate
from ..dialect import message
from .protocol import LATEST_US, LOCKSTEP, RefusedError, culprit, within

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
        return self.mode & MavModeFlag.SAFETY_ARMED != 0


def controls_writer(reader: RecordReader) -> Callable[[], bytes]:
    """A function that gives the payload for a record's actuators, as an answer to its present time."""
    read = reader.fields("time_us", "actuators.controls", "actuators.armed")
    pack = KIND.pack

    def payload() -> bytes:
        t, *outputs, armed = read()
        flag = MavModeFlag.SAFETY_ARMED if armed else 0
        return pack(t, LOCKSTEP, *outputs, MavModeFlag.CUSTOM_MODE_ENABLED | flag)

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
    """Actuator controls, 0 .. 1, at which the rotors of this airframe stand and turn fastest; of a rover those of no
    and of full throttle and steering."""
    if hasattr(airframe, "control_full"):
        return 0.0, float(airframe.control_full)
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
    address = start + locate(fleet.dtype, "actuators.controls")[0]
    armed = start + locate(fleet.dtype, "actuators.armed")[0]
    memory = fleet.view("u1").data
    write, write_armed = struct.Struct(f"<{OUTPUTS}f").pack_into, struct.Struct("<q").pack_into

    def put(controls: Controls) -> None:
        write(memory, address, *controls.outputs)
        write_armed(memory, armed, 1 if controls.mode & MavModeFlag.SAFETY_ARMED else 0)

    return put


LATE = 20
"""After so many silences, each after late answers alone, the clock must be another one than we think."""
LONGEST_WAIT_S, SHORTEST_WAIT_S = 0.2, 0.005
"""Wall time that a tick waits for its answer. It begins with the first, and each tick without an answer halves it: who
has been silent without a reason is not waited for in vain 400 times a second."""
TRUSTED = 400
"""After so many answers in a row it is doubled again."""
ALIKE = 4
"""After so many answers with as many ticks between them those ticks are not waited for."""
SILENT = 200
"""Ticks in a row without an answer; after that time stands: the autopilot is stopped, or gone."""
SILENT_ARMED = 16
"""The same in flight. A PX4 that was stopped loses the samples that it gets at once when it goes on, and what it knows
of its velocity with them: 9.8 m/s for a second of them. Its slowest loops run at every eighth tick."""
START_US = 4_000_000
"""Simulated time since the first answer in which an autopilot starts its modules, in wall time [us]."""


class ForeignClock:
    """Of one connection.

    What PX4 answers first may be a tick of some time ago, with others under way. Were each late answer a step, that
    many ticks would stay under way for good and its controls would always be so old: a step is only asked for once the
    present tick is answered. Until then time has to go on by itself, but it stands while late answers come: what cannot
    keep up with the wall clock, on a busy machine, would have more and more ticks under way.

    How late one is can be seen because PX4's clock is HIL_SENSOR's, from 1.14 on. An older one counts from the first
    tick that it got: all of its answers seem late, and it is in step after ``LATE`` silences.

    And PX4 may wait, too, for a tick that it has not got: its controls come when all that it calls lockstep components
    have run, and with IMU_INTEG_RATE below 400 its estimator does not run at each tick. So no tick waits for ever.
    A rover's loop runs at 100 Hz, so that every fourth tick is answered, and none while it is disarmed: the ticks
    between are not waited for, and a disarmed rover's time goes by the wall clock.

    Args:
        rests: whether a disarmed one does not answer.
    """

    def __init__(self, rests: bool = False) -> None:
        self._rests, self._is_armed = rests, True
        self._since = self._period = self._alike = 0
        self._answered_us = -1
        self._late = 0
        self._is_in_step, self._is_lockstep, self._catches_up = False, True, False
        self._in_step_us = 0
        self.began_us = 0
        """Our time at which its clock was 0, as its answers have it [us]."""
        self._answers = self._in_vain = 0
        self._longest_s = LONGEST_WAIT_S
        self.unanswered = 0
        """Ticks so far for which no answer came in time."""

    @property
    def holds(self) -> bool:
        """Whether time waits for its controls."""
        if not self._is_in_step:
            return self._catches_up
        return self._is_lockstep and not (self._rests and self.is_silent and not self._is_armed)

    @property
    def wait_s(self) -> float:
        """Wall time that the present tick waits for an answer [s]; none between two that are answered always."""
        is_between = self._alike >= ALIKE and (self._since + 1) % self._period != 0
        return 0.0 if is_between else self._longest_s

    @property
    def is_silent(self) -> bool:
        """Whether so many ticks in a row have had no answer that time has to stand."""
        return self._in_vain >= (SILENT_ARMED if self._is_armed else SILENT)

    @property
    def is_steady(self) -> bool:
        """Whether each tick is answered at once, and has been for a while."""
        return self.holds and self._period == 1 and self._alike >= ALIKE and self._longest_s == LONGEST_WAIT_S

    def was_answered(self, ticks: int, now_us: int, is_armed: bool) -> None:
        """So many ticks were answered at once, and the last answer has led to the tick of this time [us]."""
        self._is_armed, self._in_vain, self._since = is_armed, 0, 0
        self._alike, self._answers = self._alike + ticks, self._answers + ticks
        self._answered_us = now_us - TICK_US - self.began_us

    def is_starting(self, now_us: int) -> bool:
        """Whether its modules may still be starting at this time [us]."""
        return not self._is_in_step or now_us - self._in_step_us < START_US

    def gave_up(self) -> None:
        """The present tick has waited in vain."""
        if not self._is_in_step:
            self._catches_up = False
            self._late += 1
            return
        waited = self.wait_s > 0.0
        self.unanswered += 1
        self._in_vain += 1
        self._since += 1
        if waited:
            self._answers = 0
            self._longest_s = max(0.5 * self._longest_s, SHORTEST_WAIT_S)

    def asks_for_step(self, given: Controls, now_us: int) -> bool:
        """Whether controls that come at this time [us] are the answer to the present tick, for the first time."""
        self._is_lockstep, self._is_armed = given.is_lockstep, given.is_armed
        self._in_vain = 0
        is_new, self._answered_us = given.time_us > self._answered_us, max(given.time_us, self._answered_us)
        late_us = now_us - self.began_us - given.time_us
        if not self._is_in_step:
            if given.is_lockstep and late_us > 0 and late_us % TICK_US == 0 and self._late < LATE:
                self._catches_up = True
                return False
            self._is_in_step, self._in_step_us = True, now_us
            self.began_us, late_us = late_us, 0
        elif late_us < 0 and late_us % TICK_US == 0:  # it answers no tick that it has not got: it was late until now
            self.began_us, late_us = self.began_us + late_us, 0
        if not (is_new and given.is_lockstep) or (late_us > 0 and late_us % TICK_US == 0):
            self._alike = 0
            return False
        period, self._since = self._since + 1, 0
        self._alike = self._alike + 1 if period == self._period else 0
        self._period = period
        self._answers += 1
        if self._answers % TRUSTED == 0:
            self._longest_s = min(2.0 * self._longest_s, LONGEST_WAIT_S)
        return True
