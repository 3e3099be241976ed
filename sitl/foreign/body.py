# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle of ours at the JSON interface: the memory that the laws of ``exchange`` work on, and who calls them."""

from __future__ import annotations

import socket
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.constants import NEVER
from ..core.kernels import jit_disabled
from ..core.record_reader import addresses
from ..core.system_call import function_address
from ..physics.native.ranging import list_near
from ..plants.local import LocalPlant
from ..vehicle.core_entry import unit_address
from .exchange import (
    ASKED,
    BEGIN,
    CONVERSE,
    DATAGRAMS,
    IS_DUE,
    LINE_SIZE,
    MMSGHDR,
    MOST_LINES,
    MOTION,
    NAME_SIZE,
    NOTE,
    NUMBERS,
    OUTPUTS,
    PIECES,
    REPORT,
    WAITS,
    Exchange,
    acted,
)

Array = np.ndarray[Any, Any]
_RECEIVE, _SEND = (
    (function_address("recvmmsg"), function_address("sendmmsg"))
    if sys.platform == "linux" and sys.maxsize > 1 << 32
    else (0, 0)
)
_FAR_US = 1 << 62


class BodyLines(Sequence[bytes]):
    """Steps one vehicle and reports it in JSON lines; as a sequence, the lines of the last step.

    Args:
        plant: its physics.
    """

    def __init__(self, plant: LocalPlant) -> None:
        self.plant, vehicle = plant, plant.vehicle
        self._memory = Exchange.fleet(1)
        self._address: int = self._memory.ctypes.data
        self.exchange = x = Exchange.of(self._memory, 0)
        fleet = vehicle.fleet
        x.records, x.vehicles, x.index = fleet.ctypes.data, len(fleet), vehicle.index
        x.clock, x.body, x.actuators, x.sensors, x.wind, x.obstacles = addresses(
            fleet, vehicle.index,
            "time_us", "physics.body", "actuators", "sensors", "physics.wind", "physics.obstacles",
        )  # fmt: skip
        x.is_reversible = vehicle.kind.has_reversible_outputs
        x.range_max = float(vehicle.airframe.value("rangefinder_max"))
        x.measure_us, x.until_us = NEVER, _FAR_US
        text = np.frombuffer(b"".join(PIECES), "u1").copy()
        x.piece_at[:] = np.cumsum([0, *map(len, PIECES)])
        self._text: Array = np.zeros((MOST_LINES, LINE_SIZE), "u1")
        self._vectors: Array = np.zeros((MOST_LINES, 2), "i8")
        self._vectors[:, 0] = self._text.ctypes.data + LINE_SIZE * np.arange(MOST_LINES)
        before, numbers = np.zeros(MOTION), np.zeros(NUMBERS)
        self._kept: list[Array] = [text, before, numbers, self._text, self._vectors]
        x.pieces, x.before, x.numbers, x.lines, x.vectors = (array.ctypes.data for array in self._kept)
        self._act = acted.function()
        self.is_quick = bool(_RECEIVE and _SEND) and plant.engine is None and not jit_disabled()
        """Whether ``converse`` can be called."""
        if self.is_quick:
            self._prepare()

    def _prepare(self) -> None:
        """All that ``converse`` needs besides."""
        x, plant = self.exchange, self.plant
        plant.load_tick()
        kind = plant.vehicle.kind
        x.step, x.receive, x.send = unit_address(kind.step, kind), _RECEIVE, _SEND
        if plant.rangers is not None:
            x.list_near = unit_address(list_near, kind)
        self._names: Array = np.zeros((DATAGRAMS, NAME_SIZE), "u1")
        self._frames: Array = np.zeros((DATAGRAMS, LINE_SIZE), "u1")
        self._named: tuple[str, int] | None = None
        self._peer: Array = np.zeros(NAME_SIZE, "u1")
        read, self._inbox, outbox = (
            np.zeros((DATAGRAMS, 2), "i8"),
            np.zeros((DATAGRAMS, MMSGHDR), "i8"),
            np.zeros((MOST_LINES, MMSGHDR), "i8"),
        )
        read[:, 0], read[:, 1] = self._frames.ctypes.data + LINE_SIZE * np.arange(DATAGRAMS), LINE_SIZE
        for box, names, vectors in ((self._inbox, self._names, read), (outbox, self._peer, self._vectors)):
            step = NAME_SIZE if box is self._inbox else 0
            box[:, 0] = names.ctypes.data + step * np.arange(len(box))
            box[:, 1] = NAME_SIZE
            box[:, 2] = vectors.ctypes.data + 16 * np.arange(len(box))
            box[:, 3] = 1
        x.inbox, x.outbox, x.names, x.frames = (a.ctypes.data for a in (self._inbox, outbox, self._names, self._frames))
        self._kept += [read, outbox]

    @property
    def is_asked(self) -> bool:
        """Whether a step is asked for."""
        return bool(self.exchange.stage != WAITS)

    def ask(self, rate: int, pulses: Sequence[int]) -> None:
        """A step is asked for.

        Args:
            rate: steps a second [Hz].
            pulses: outputs [us].
        """
        x = self.exchange
        x.rate, x.pulses[:], x.stage = rate, pulses[:OUTPUTS], ASKED

    def step(self, until_us: int | None) -> list[bytes]:
        """The step, at most until a time [us since power-on]; gives the lines that report it."""
        x, plant = self.exchange, self.plant
        x.until_us = _FAR_US if until_us is None else until_us
        self._act(self._address, BEGIN)
        for left in range(x.left, 0, -1):
            if left == 1:
                self._act(self._address, NOTE)
            plant.tick()
        x.left, x.stage = 0, WAITS
        self._act(self._address, REPORT)
        return list(self)

    def __len__(self) -> int:
        return int(self.exchange.parts)

    def __getitem__(self, number: Any) -> Any:
        if isinstance(number, slice):
            return [self[k] for k in range(len(self))[number]]
        if not 0 <= number < len(self):
            raise IndexError(f"line {number} of {len(self)}")
        return self._text[number, : self._vectors[number, 1]].tobytes()

    def converse(self, sock: socket.socket, peer: tuple[str, int], until_us: int | None, answers: int) -> int:
        """The step that is asked for, and those that follow; returns how it ended (``exchange.IS_ASKED``)."""
        x, plant = self.exchange, self.plant
        if peer != self._named:
            self._named, name = peer, _name(peer)
            self._peer[:8] = np.frombuffer(name, "u1")
            x.peer = int.from_bytes(name, sys.byteorder, signed=True)
        x.socket, x.answers, x.is_single = sock.fileno(), answers, answers == 1
        x.until_us = _FAR_US if until_us is None else until_us
        self._act(self._address, BEGIN)
        while True:
            if plant.rangers is not None:  # other ones after each power-on
                x.ranging, x.measure_us = plant.ranging, plant.rangers.due_us
            how = int(self._act(self._address, CONVERSE))
            if how != IS_DUE:
                return how
            plant.measure()

    def unjudged(self) -> list[tuple[bytes, tuple[str, int]]]:
        """Datagrams that ``converse`` has left, with their senders."""
        x, found = self.exchange, []
        for k in range(int(x.judged), int(x.received)):
            size = min(int(self._inbox[k, MMSGHDR - 1]) & 0xFFFFFFFF, LINE_SIZE)
            name = self._names[k].tobytes()
            found.append(
                (self._frames[k, :size].tobytes(), (socket.inet_ntoa(name[4:8]), int.from_bytes(name[2:4], "big")))
            )
        x.judged = x.received = 0
        return found


def _name(peer: tuple[str, int]) -> bytes:
    """The first 8 bytes of a ``struct sockaddr_in``."""
    return socket.AF_INET.to_bytes(2, sys.byteorder) + peer[1].to_bytes(2, "big") + socket.inet_aton(peer[0])
