# SPDX-License-Identifier: BSD-3-Clause
"""Our SIM_ parameters beside an autopilot that has none like them: PX4, whose sensors are all of our physics.

Clients set and read them by MAVLink as those of our own autopilot or an ArduPilot: wind, failures of GPS and motors
and the like. What clients send about them does not reach the autopilot; the answer is the physics'.
"""

from __future__ import annotations

from collections import deque

from ..bridge.dialect import message
from ..bridge.frame import MARK_V1, MARK_V2, Splitter, encode_v2
from ..client.byte_socket import ByteStream
from ..core.mavlink import MavParamType
from ..plants.local import LocalPlant
from ..plants.physics_server import SimulatedPlant
from ..vehicle.sim_parameters import PREFIX

_SET, _READ, _VALUE = (message(name) for name in ("PARAM_SET", "PARAM_REQUEST_READ", "PARAM_VALUE"))
_ASKED = {kind.wire_id: kind for kind in (_SET, _READ)}
_ASKED_V1 = {kind.id: kind for kind in (_SET, _READ)}
_NOT_LISTED = 65535


class SimParameterPort:
    """Answers clients; what they set acts between two ticks (``act``).

    Args:
        plant: the physics.
    """

    def __init__(self, plant: LocalPlant) -> None:
        simulated = SimulatedPlant(plant)
        self._set, self._params = simulated.set_parameter, simulated.v.autopilot.params
        self._table = plant.vehicle.kind.firmware.table
        self._wanted: deque[tuple[str, float]] = deque()
        self._sequence = 0

    def answer(self, raw: bytes) -> bytes:
        """The answer to a frame of a client; b"": it is the autopilot's. In any thread."""
        asked = _ASKED.get(raw[7:10]) if raw[0] == MARK_V2 else _ASKED_V1.get(raw[5]) if raw[0] == MARK_V1 else None
        if asked is None:
            return b""
        out = b""
        for frame in Splitter().feed(raw):
            fields = frame.kind.decode(frame.payload)
            name = fields.param_id.decode("ascii", "replace")
            if not (name.startswith(PREFIX) and name in self._table and self._table[name].has_effect):
                continue
            value = float(self._params[name])
            if asked is _SET:
                if self._table[name].refusal(fields.param_value) is None:
                    value = float(fields.param_value)
                    self._wanted.append((name, value))
            self._sequence = self._sequence + 1 & 0xFF
            payload = _VALUE.payload(
                param_id=fields.param_id, param_value=value, param_type=MavParamType.REAL32, param_count=0,
                param_index=_NOT_LISTED,
            )  # fmt: skip
            out += encode_v2(_VALUE, payload, self._sequence, fields.target_system, 1)
        return out

    def over(self, stream: ByteStream) -> SimParameterStream:
        """A client's end of the way to the autopilot, with these parameters."""
        return SimParameterStream(stream, self)

    def act(self) -> None:
        """What was set since acts from now on; in the thread of the physics, between two ticks."""
        while self._wanted:
            self._set(*self._wanted.popleft())


class SimParameterStream:
    """See ``SimParameterPort.over``."""

    def __init__(self, stream: ByteStream, port: SimParameterPort) -> None:
        self._stream, self._answer = stream, port.answer
        self._answers = b""
        self.name, self.flush, self.write = stream.name, stream.flush, stream.write
        self.wait, self.limit, self.close = stream.wait, stream.limit, stream.close

    def send(self, data: bytes) -> None:
        """Keep a frame for ``flush``, unless it is answered here."""
        answer = self._answer(data)
        if answer:
            self._answers += answer
        else:
            self._stream.send(data)

    def receive(self) -> bytes:
        """All bytes that are there."""
        answers, self._answers = self._answers, b""
        return answers + self._stream.receive()
