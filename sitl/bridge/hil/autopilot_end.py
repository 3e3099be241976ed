# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot's end of the link: bytes of the physics in, controls out. No sockets, no clock.

Its clock is HIL_SENSOR's. It sends controls for its present time once, and waits for the tick after it; what comes for
another time is either a repetition, which it lets pass, or another world.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...core.constants import TICK_US
from ...core.mavlink import MavAutopilot, MavCmd, MavParamType, MavState
from ...core.record_reader import RecordReader
from ..dialect import message
from ..frame import Frame, Splitter
from . import controls, truth
from .measurements import Inbox
from .protocol import AUTOPILOT, RESEED, RefusedError, Sender
from .sensor import SENSOR_KIND

HEARTBEAT, ACK, COMMAND, COMMAND_INT, PARAM_SET, TEXT = (
    message(name) for name in ("HEARTBEAT", "COMMAND_ACK", "COMMAND_LONG", "COMMAND_INT", "PARAM_SET", "STATUSTEXT")
)
_NOTES = 4
"""So many are kept while nobody shows them."""

WAITING, TAKEN, ELSEWHERE = range(3)
"""What ``feed`` found: not yet what is waited for; that; a world at another time than ours."""


class AutopilotEnd:
    """One vehicle's autopilot on a link to its physics.

    Args:
        fleet, index: the record, whose memory stays in place; it has the properties of its airframe.
        v: view of it.
        vehicle_type: MAV_TYPE for the heartbeat.
    """

    def __init__(self, fleet: np.ndarray[Any, Any], index: int, v: Any, vehicle_type: int = 2) -> None:
        reader = RecordReader(fleet, index)
        self._frame = Sender(*AUTOPILOT).frame
        self._inbox = Inbox(fleet, index, v)
        self._payload = controls.controls_writer(reader)
        self._clock = reader.field("time_us")
        self._type = vehicle_type
        self._splitter = Splitter()
        self._queue: list[bytes] = []
        self._sent = b""
        """Controls that are not answered yet."""
        self._expected = -1
        """Time of the tick that is waited for [us]; -1: the first that comes."""
        self._until_ack = 0
        """Command whose acknowledgement has to come first."""
        self.truth_us, self.truth = -1, truth.NOWHERE
        """Where the vehicle really is, as last reported, and when that was [us]."""
        self.refused = 0
        """Messages with numbers that cannot be right."""
        self.repeated = 0
        """Ticks that came again."""
        self.notes: list[str] = []
        """For people; who shows them empties the list."""
        self._complained = False

    @property
    def is_waiting(self) -> bool:
        """Whether controls have been sent and not been answered."""
        return bool(self._sent)

    # ------------------------------------------------------------------ out

    def hello(self, parameters: Mapping[str, float]) -> bytes:
        """The first words on a connection: who we are, and the world's parameters."""
        self._splitter = Splitter()
        self._inbox.forget()
        words = HEARTBEAT.payload(
            type=self._type,
            autopilot=MavAutopilot.ARDUPILOTMEGA,
            base_mode=1,
            system_status=MavState.ACTIVE,
            mavlink_version=3,
        )
        frames = [self._frame(HEARTBEAT, words), *(self._set(name, parameters[name]) for name in parameters)]
        return b"".join(frames)

    def _set(self, name: str, value: float) -> bytes:
        return self._frame(
            PARAM_SET, PARAM_SET.payload(param_id=name.encode(), param_value=value, param_type=MavParamType.REAL32)
        )

    def set_parameter(self, name: str, value: float) -> None:
        """Tell the physics before the next controls."""
        self._queue.append(self._set(name, value))

    def reseed(self, seed: int) -> None:
        """The same with another seed for its noise."""
        words = [_signed(seed), _signed(seed >> 32)]
        fields = COMMAND_INT.payload(command=RESEED, x=words[0], y=words[1])
        self._queue.append(self._frame(COMMAND_INT, fields))

    def ask_state(self) -> bytes:
        """Ask for all that the physics knows: to begin where it is."""
        self._begin(0)
        return self._command(MavCmd.REQUEST_MESSAGE, SENSOR_KIND.id)

    def ask_reboot(self) -> bytes:
        """Ask the physics to begin anew."""
        self._begin(MavCmd.PREFLIGHT_REBOOT_SHUTDOWN)
        return self._command(MavCmd.PREFLIGHT_REBOOT_SHUTDOWN, 1)

    def _begin(self, until_ack: int) -> None:
        """The next tick is taken whatever its time, once this command is acknowledged (0: at once)."""
        self._expected, self._until_ack, self._sent, self.truth_us = -1, until_ack, b"", -1
        self._queue.clear()

    def ask_truth(self) -> bytes:
        """Ask where the vehicle is."""
        return self._command(MavCmd.REQUEST_MESSAGE, truth.TRUTH_KIND.id)

    def _command(self, number: int, first: float) -> bytes:
        return self._frame(COMMAND, COMMAND.payload(command=number, param1=first))

    def controls(self) -> bytes:
        """The answer to the present tick; the same bytes again until the next tick has come."""
        if not self._sent:
            self._sent = self._frame(controls.KIND, self._payload())
            self._expected = self._clock() + TICK_US
            if self._queue:
                queue, self._queue = self._queue, []
                return b"".join(queue) + self._sent
        return self._sent

    # ------------------------------------------------------------------ in

    def feed(self, data: bytes) -> int:
        """Take bytes of the physics; WAITING, TAKEN (the tick is in the record) or ELSEWHERE."""
        found = WAITING
        for frame in self._splitter.feed(data):
            try:
                found = max(found, self._take(frame))
            except RefusedError as error:
                self.refused += 1
                if not self._complained:
                    self._complained = True
                    self.notes.append(f"refused: {error}; time stands until a good one comes")
        return found

    def _take(self, frame: Frame) -> int:
        kind = frame.kind
        if kind is SENSOR_KIND:
            return self._tick(frame.payload)
        if self._inbox.keep(kind.id, frame.payload):
            return WAITING
        if kind is truth.TRUTH_KIND:
            self.truth_us, self.truth = truth.read_truth(frame.payload)
        elif kind is ACK:
            if kind.decode(frame.payload).command == self._until_ack:
                self._until_ack = 0
                self._inbox.forget()
        elif kind is TEXT:
            del self.notes[:-_NOTES]
            self.notes.append("physics: " + kind.decode(frame.payload).text.decode("utf-8", "replace"))
        return WAITING

    def _tick(self, payload: bytes) -> int:
        values = self._inbox.end(payload)
        if values is None:
            return WAITING
        if self._until_ack:
            self._inbox.forget()
            return WAITING
        time_us = values[0]
        if self._expected < 0:
            self._inbox.take(values, is_all=True)
            self._expected = time_us
        elif self._sent and time_us == self._expected:
            self._inbox.take(values)
            self._sent = b""
            self._complained = False
        else:
            self._inbox.forget()
            if time_us == self._clock():
                self.repeated += 1
                return WAITING
            return ELSEWHERE
        return TAKEN


def _signed(word: int) -> int:
    """The low 32 bits as a signed number."""
    word &= 0xFFFFFFFF
    return word - (1 << 32) if word >> 31 else word
