# SPDX-License-Identifier: BSD-3-Clause
"""The physics' end of the link: bytes of an autopilot in, bytes of ticks out. No sockets, no clock.

Two kinds of autopilots are served. Ours answers with the time of the tick that it answers, so an answer that comes
twice is known as such. PX4, known by its HEARTBEAT, sends nothing but that until it has booted: until it answers,
physics has to go on by itself (``freewheels``), and so it has for any autopilot without lockstep. Its rotor controls
are parts of each motor's range, which the airframe's actuators have between ``control_min`` and ``control_max``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from ...core.constants import TICK_US
from ...core.mavlink import MavAutopilot, MavCmd, MavResult, MavSeverity
from ...physics.carried import Carried
from ..dialect import message
from ..frame import Frame, Splitter
from . import controls, rc_inputs, truth
from .controls import ForeignClock
from .measurements import Measurements
from .protocol import RESEED, RefusedError
from .sensor import SENSOR_KIND

HEARTBEAT, ACK, COMMAND, COMMAND_INT, PARAM_SET, PARAM_VALUE, TEXT = (
    message(name)
    for name in ("HEARTBEAT", "COMMAND_ACK", "COMMAND_LONG", "COMMAND_INT", "PARAM_SET", "PARAM_VALUE", "STATUSTEXT")
)


class Simulated(Protocol):
    """A vehicle's physics."""

    fleet: np.ndarray[Any, Any]
    index: int
    v: Any
    """View of the record ``fleet[index]``."""

    def tick(self) -> None:
        """Go one tick further under the record's actuators."""

    def power_on(self) -> None:
        """Begin anew at time 0; parameters stay."""

    def set_parameter(self, name: str, value: float) -> float | None:
        """Set a SIM_ parameter; gives the value that it has now, None when there is none of this name."""

    def reseed(self, seed: int) -> None:
        """Another seed for all sensor noise from now on."""

    def truth(self) -> Carried:
        """Where the vehicle really is."""


def text_frame(measurements: Measurements, text: str) -> bytes:
    """A STATUSTEXT for an autopilot."""
    return measurements.sender.frame(TEXT, TEXT.payload(severity=MavSeverity.WARNING, text=text.encode()[:50]))


class PhysicsEnd:
    """One vehicle's physics for one autopilot at a time.

    Args:
        simulated: the physics, at power-on.
        vehicle_type: MAV_TYPE; an autopilot of ours for another vehicle is not answered. 0: any.
    """

    def __init__(self, simulated: Simulated, vehicle_type: int = 0) -> None:
        self._simulated, self._type = simulated, vehicle_type
        self._v = simulated.v
        self._actuate = controls.actuators_writer(simulated.fleet, simulated.index)
        self.range = controls.rotor_range(simulated.v.physics.airframe)
        """Controls of rotors that stand and that turn fastest."""
        self.measurements = Measurements(simulated.fleet, simulated.index, simulated.v)
        self._frame = self.measurements.sender.frame
        self._tick = self.measurements.everything()
        self._now = int(simulated.v.time_us)
        self.ticks = 0
        """How many there have been, under whatever autopilot."""
        self.refused = 0
        """Messages with numbers that cannot be right."""
        self.repeated = 0
        """Answers that came again and got the same tick again."""
        self.notes: list[str] = []
        """For people; who shows them empties the list."""
        self._sticks: tuple[int, ...] = ()
        self.greet()

    def greet(self) -> None:
        """Another autopilot, or the same one again, is connected: nothing is known of it."""
        self._splitter = Splitter()
        self._is_foreign = self._is_stranger = self._complained = False
        self.clock = ForeignClock(hasattr(self._v.physics.airframe, "control_full"))
        self._truth_every_us, self._truth_due_us = 0, 0

    @property
    def time_us(self) -> int:
        """Simulated time that the physics stands at [us]."""
        return self._now

    @property
    def freewheels(self) -> bool:
        """Whether physics has to go on by itself at the pace of the wall clock."""
        return self._is_foreign and not self.clock.holds

    @property
    def wait_s(self) -> float | None:
        """Wall time that the present tick waits for an answer [s]; None: until it comes."""
        return self.clock.wait_s if self._is_foreign and self.clock.holds and not self.clock.is_silent else None

    @property
    def is_starting(self) -> bool:
        """Whether an autopilot that is not ours may still be starting: in wall time, which simulated time must not
        outrun."""
        return self._is_foreign and self.clock.is_starting(self._now)

    @property
    def is_steady(self) -> bool:
        """Whether a PX4 answers each tick, and nothing but the next answer is waited for."""
        return (
            self._is_foreign and self.clock.is_steady and not (self.is_starting or self._sticks or self._splitter.rest)
        )

    @property
    def truth_due(self) -> tuple[int, int]:
        """(Interval at which the truth is told, when it is due next) [us]; an interval of 0: never."""
        return self._truth_every_us, self._truth_due_us

    def go_on_with(self, ticks: int, is_armed: bool, truth_due_us: int, is_last_unsent: bool) -> bytes:
        """So many ticks were answered elsewhere; gives what the last of them has to report, unless it was reported."""
        sent = ticks - is_last_unsent
        self._complained = False
        self._now += sent * TICK_US
        self.ticks += sent
        self._truth_due_us = truth_due_us
        self.clock.was_answered(ticks, self._now + is_last_unsent * TICK_US, is_armed)
        return self._send() if is_last_unsent else b""

    @property
    def unanswered(self) -> int:
        """Ticks that an autopilot which is not ours has not answered in time."""
        return self.clock.unanswered

    def move_sticks(self, pulses: Sequence[int]) -> None:
        """A frame of a receiver on this side, up to twelve channels [us], for the next tick."""
        self._sticks = tuple(pulses)

    def go_on(self) -> bytes:
        """One tick without an answer."""
        if not self.freewheels:
            waited_s, before = self.clock.wait_s, self.clock.unanswered
            self.clock.gave_up()
            if before == 0 < self.clock.unanswered:
                self.notes.append(
                    f"the autopilot has not answered the tick at {1e-6 * self._now:.4f} s in "
                    f"{1e3 * waited_s:.0f} ms: time goes on without it, and this is not said again"
                )
        return self._step()

    def feed(self, data: bytes) -> bytes:
        """Take bytes of the autopilot; gives those that answer them."""
        out = b""
        for frame in self._splitter.feed(data):
            try:
                out += self._take(frame)
            except RefusedError as error:
                self.refused += 1
                if not self._complained:
                    self._complained = True
                    self.notes.append(f"refused: {error}; time stands until a good one comes")
                    out += text_frame(self.measurements, f"refused: {error}")
        return out

    def _take(self, frame: Frame) -> bytes:
        kind = frame.kind
        if self._is_stranger:
            return b""
        if kind is controls.KIND:
            return self._answer(controls.read_controls(frame.payload))
        if kind is HEARTBEAT:
            return self._meet(kind.decode(frame.payload))
        elif kind is COMMAND or kind is COMMAND_INT:
            return self._command(kind.decode(frame.payload), frame)
        elif kind is PARAM_SET:
            return self._parameter(kind.decode(frame.payload))
        return b""

    def _meet(self, heartbeat: Any) -> bytes:
        """Who is there?"""
        self._is_foreign = self.measurements.is_foreign = heartbeat.autopilot != MavAutopilot.ARDUPILOTMEGA
        self._is_stranger = not self._is_foreign and bool(self._type) and heartbeat.type != self._type
        if not self._is_stranger:
            return b""
        text = f"refused: MAV_TYPE {heartbeat.type}, this physics is of {self._type}"
        self.notes.append(text)
        return text_frame(self.measurements, text)

    def _answer(self, given: controls.Controls) -> bytes:
        """Controls: one tick further if they answer the present one."""
        self._complained = False
        if self._is_foreign:
            self._actuate(controls.stretch(given, *self.range))
            return self._step() if self.clock.asks_for_step(given, self._now) else b""
        if given.time_us == self._now:
            self._actuate(given)
            return self._step()
        if given.time_us == self._now - TICK_US:
            self.repeated += 1
            return self._tick
        return self.measurements.everything()  # of another world, or of this one before it began anew

    def _step(self) -> bytes:
        self._simulated.tick()
        return self._send()

    def _send(self) -> bytes:
        """What the next tick, which is done, has to report."""
        self._now += TICK_US
        self.ticks += 1
        self._tick = self.measurements.tick()
        if self._sticks:
            kind, payload = rc_inputs.frame_for(self._is_foreign, self._now, self._sticks)
            self._tick = self._frame(kind, payload) + self._tick
            self._sticks = ()
        if self._truth_every_us > 0 and self._truth_due_us <= self._now:
            self._truth_due_us = self._now + self._truth_every_us
            self._tick = self._truth() + self._tick
        return self._tick

    def _truth(self) -> bytes:
        return self._frame(truth.TRUTH_KIND, truth.truth_payload(self._now, self._simulated.truth()))

    def _parameter(self, fields: Any) -> bytes:
        name = fields.param_id.decode("ascii", "replace")
        value = self._simulated.set_parameter(name, fields.param_value)
        self._renew()
        if value is None:
            return b""
        return self._frame(
            PARAM_VALUE,
            PARAM_VALUE.payload(
                param_id=fields.param_id, param_value=value, param_type=9, param_count=1, param_index=65535
            ),
        )

    def _renew(self) -> None:
        """The physics may have begun anew."""
        if int(self._v.time_us) != self._now or self._now == 0:
            self._now = int(self._v.time_us)
            self._tick = self.measurements.everything()
            self._truth_due_us = 0

    def _command(self, fields: Any, frame: Frame) -> bytes:
        """Answer a command; what it asks for follows the acknowledgement."""
        number, result, more = fields.command, MavResult.ACCEPTED, b""
        if number == MavCmd.PREFLIGHT_REBOOT_SHUTDOWN:
            self._simulated.power_on()
            self._now = -1
            self._renew()
            more = self._tick
        elif number == RESEED and frame.kind is COMMAND_INT:
            self._simulated.reseed((fields.x & 0xFFFFFFFF) | (fields.y & 0xFFFFFFFF) << 32)
        elif number == MavCmd.REQUEST_MESSAGE and fields.param1 == truth.TRUTH_KIND.id:
            more = self._truth()
        elif number == MavCmd.REQUEST_MESSAGE and fields.param1 == SENSOR_KIND.id:
            more = self.measurements.everything()
        elif number == MavCmd.SET_MESSAGE_INTERVAL and fields.param1 == truth.TRUTH_KIND.id:
            if not abs(fields.param2) < 1e12:
                result = MavResult.DENIED
            else:
                self._truth_every_us = int(max(fields.param2, 0.0))
        elif number in (MavCmd.REQUEST_MESSAGE, MavCmd.SET_MESSAGE_INTERVAL):
            result = MavResult.DENIED
        else:
            result = MavResult.UNSUPPORTED
        ack = ACK.payload(command=number, result=result, target_system=frame.system, target_component=frame.component)
        return self._frame(ACK, ack) + more
