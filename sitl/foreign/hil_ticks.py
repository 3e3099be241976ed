# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle of ours at the HIL link of a PX4: the memory that the laws of ``hil_exchange`` work on, and who calls
them."""

from __future__ import annotations

import socket
import sys
from typing import Any

import numpy as np

from ..bridge.hil.physics_end import PhysicsEnd
from ..bridge.wire.frames import FRAME_MAX
from ..bridge.wire.port import PAYLOAD_BYTES
from ..core.constants import NEVER
from ..core.kernels import jit_disabled
from ..core.record_reader import addresses, locate
from ..core.system_call import function_address
from ..physics.native.ranging import list_near
from ..plants.local import LocalPlant
from ..vehicle.core_entry import unit_address
from .hil_exchange import INBOX_BYTES, IS_NEWS, IS_ODD, MARKS, HilExchange, conversed

_RECEIVE, _SEND = (
    (function_address("recv"), function_address("send"))
    if sys.platform == "linux" and sys.maxsize > 1 << 32
    else (0, 0)
)
_SIZES = {"b": 1, "B": 1, "?": 1, "h": 2, "H": 2, "i": 4, "I": 4, "f": 4, "q": 8, "Q": 8, "d": 8}
"""Code of ``struct`` -> bytes."""


class HilTicks:
    """Takes answers of a PX4 and steps one vehicle, many times in one call.

    Args:
        plant: its physics.
        end: our end of the link; its state is that of the exchange.
    """

    def __init__(self, plant: LocalPlant, end: PhysicsEnd) -> None:
        self.plant, self.end = plant, end
        self.is_quick = bool(_RECEIVE and _SEND) and plant.engine is None and not jit_disabled()
        """Whether ``go_on`` can be called."""
        if self.is_quick:
            self._prepare()

    def _prepare(self) -> None:
        vehicle, end = self.plant.vehicle, self.end
        self._memory = HilExchange.fleet(1)
        self._address: int = self._memory.ctypes.data
        self.exchange = x = HilExchange.of(self._memory, 0)
        fleet = vehicle.fleet
        x.records, x.vehicles, x.index = fleet.ctypes.data, len(fleet), vehicle.index
        x.clock, x.actuators, x.sensors, x.body, x.origin, x.obstacles = addresses(
            fleet, vehicle.index,
            "time_us", "actuators", "sensors", "physics.body", "physics.origin", "physics.obstacles",
        )  # fmt: skip
        x.lowest, x.highest = end.range
        at = fleet.ctypes.data + vehicle.index * fleet.dtype.itemsize
        marks = [locate(fleet.dtype, path) for path in end.measurements.marks]
        x.marks = len(marks)
        for n, (offset, code, _) in enumerate(marks):
            x.mark_at[n], x.mark_size[n] = at + offset, _SIZES[code]
        boxes = [np.zeros(size, "u1") for size in (8 * MARKS, INBOX_BYTES, PAYLOAD_BYTES, 2 * FRAME_MAX)]
        self._kept: list[np.ndarray[Any, Any]] = boxes
        x.seen, x.inbox, x.given, x.outbox = (box.ctypes.data for box in boxes)
        x.measure_us = NEVER
        x.receive, x.send = _RECEIVE, _SEND
        x.system, x.component = end.measurements.sender.system, end.measurements.sender.component
        self.plant.load_tick()
        x.step = unit_address(vehicle.kind.step, vehicle.kind)
        if self.plant.rangers is not None:
            x.list_near = unit_address(list_near, vehicle.kind)
        self._act = conversed.function()

    def load_state(self) -> None:
        """Take over what has been reported so far."""
        x, end = self.exchange, self.end
        x.began_us, x.sequence = end.clock.began_us, end.measurements.sender.sequence
        x.mag, x.baro, x.altitude = end.measurements.imu.sent
        x.truth_every_us, x.truth_due_us = end.truth_due

    def keep_state(self) -> None:
        """Hand over what has been told."""
        x, end = self.exchange, self.end
        end.measurements.sender.sequence = int(x.sequence)
        end.measurements.imu.sent = int(x.mag), int(x.baro), float(x.altitude)

    def go_on(self, connection: socket.socket, until_us: int, answers: int) -> bytes:
        """Wait for answers and step, up to a time and to so many answers; gives what came that is for ``end.feed``.

        Raises:
            OSError: the connection is closed.
        """
        x, plant, end = self.exchange, self.plant, self.end
        x.socket, x.until_us, x.answers = connection.fileno(), until_us, answers
        while x.answers > 0 and end.time_us < until_us and end.is_steady:
            self.load_state()
            if plant.rangers is not None:  # other ones after each power-on
                x.ranging, x.measure_us = plant.ranging, plant.rangers.due_us
            how = int(self._act(self._address))
            self.keep_state()
            if how == IS_NEWS:
                plant.measure()
            if x.taken:
                out = end.go_on_with(int(x.taken), bool(x.is_armed), int(x.truth_due_us), how == IS_NEWS)
                if out:
                    connection.sendall(out)
            if how == IS_ODD:
                return self._kept[1][: int(x.received)].tobytes()
            if how != IS_NEWS:
                break
        return b""
