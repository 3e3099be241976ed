# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in real time goes on while its client does something else; delays and waits count from now."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega

from sitl.client.client import Client
from sitl.client.connection import RealTime
from sitl.client.errors import WaitTimeoutError


class Vehicle:
    """A stream on which a vehicle tells its time, 0.1 s later each time that somebody listens."""

    name = "vehicle"
    listens = False

    def __init__(self) -> None:
        self._mav = ardupilotmega.MAVLink(None, srcSystem=1, srcComponent=1)
        self.time_s, self._waiting = 1.0, b""

    def go_on(self, seconds: float) -> None:
        """Time passes, and nobody listens."""
        for _ in range(round(seconds / 0.1)):
            self.time_s = round(self.time_s + 0.1, 1)
            message = self._mav.attitude_encode(round(1000 * self.time_s), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            self._waiting += message.pack(self._mav)

    def wait(self, seconds: float) -> bool:
        if seconds > 0.0:
            self.go_on(0.1)
        return bool(self._waiting)

    def receive(self) -> bytes:
        found, self._waiting = self._waiting, b""
        return found

    def send(self, data: bytes, *_: object) -> None: ...

    def flush(self) -> None: ...

    def close(self) -> None: ...


@pytest.fixture
def both():
    vehicle = Vehicle()
    link = RealTime(vehicle, None, 5.0)  # type: ignore[arg-type]
    link.inbox.system = 1
    client = Client(link)
    client.delay(1.0)
    return client, vehicle


def test_a_delay(both) -> None:
    client, vehicle = both
    vehicle.go_on(8.0)
    begun = vehicle.time_s
    client.delay(2.0)
    assert 2.0 <= round(vehicle.time_s - begun, 1) <= 2.2


def test_the_time_of_a_wait(both) -> None:
    client, vehicle = both
    vehicle.go_on(8.0)
    begun = vehicle.time_s
    with pytest.raises(WaitTimeoutError, match="waited 2 s for it"):
        client.wait(lambda _: False, timeout=2.0, what="it")
    assert 2.0 <= round(vehicle.time_s - begun, 1) <= 2.3
