# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that may be real and a simulator on one link: the simulator proves nothing about the other."""

from __future__ import annotations

import contextlib
import socket
from typing import Any

import gymnasium as gym
import pytest

import sitl.envs  # noqa: F401
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client.endpoint import Endpoint
from sitl.client.proof import PARAMETER_NAME
from sitl.envs import NotASimulatorError
from sitl.simulation import Simulation
from tests.envs.test_reset_of_real_vehicles import (
    COPTER,
    DISARM,
    REBOOT,
    REQUEST_MESSAGE,
    RealVehicle,
    height,
    hovering,
)

SIMSTATE = 164
pytestmark = pytest.mark.filterwarnings("ignore:.*clock cannot be held")


class SharedLink(RealVehicle):
    """One behind a port with a simulator, of which another station asks all that proves it to be one, again and again.

    Args:
        simulation: the vehicle, which hides that it is simulated.
        system: MAVLink id of the simulator.
        is_first: whether what the simulator says comes before what the vehicle says.
    """

    def __init__(self, simulation: Simulation, system: int, is_first: bool) -> None:
        self.other = Simulation("erle_rover", params={"MAV_SYSID": system})
        self._is_first, self._system = is_first, system
        self._heard, self._station = Endpoint(), Endpoint(system=254)
        for end in (self._heard, self._station):
            self.other.bridge.add_link(end.link)
        self.asked: list[tuple[str, Any]] = []
        """Of the simulator, by the client."""
        super().__init__(simulation)

    def _advance(self) -> None:
        super()._advance()
        target = {"target_system": self._system, "target_component": 1}
        self._station.send("PARAM_REQUEST_LIST", **target)
        self._station.send("PARAM_REQUEST_READ", param_id=PARAMETER_NAME.encode(), param_index=-1, **target)
        self._station.command(REQUEST_MESSAGE, SIMSTATE, target=self._system)
        self.other.advance_to(self.other.time_us + self._step_us)

    def _said(self) -> bytes:
        """The client does not hear the simulator's HEARTBEAT: it means the other one."""
        said = self._heard.link.receive() + self._station.link.receive()
        others = b"".join(frame.raw for frame in Splitter().feed(said) if frame.kind.name != "HEARTBEAT")
        own = super()._said()
        return others + own if self._is_first else own + others

    def _take(self, frame: Any) -> None:
        fields = frame.kind.decode(frame.payload)
        if getattr(fields, "target_system", 0) in (0, self._system):
            self.asked.append((frame.kind.name, fields))
            self._heard.link.send(encode_v2(frame.kind, frame.payload, frame.sequence, 255, 190))
        super()._take(frame)


class SharedStream(SharedLink):
    """The same by TCP, as a router offers it."""

    connection = "tcp"

    def _open(self) -> socket.socket:
        self._server = socket.create_server(("127.0.0.1", 0))
        return _Accepted(self._server)

    def __exit__(self, *_: object) -> None:
        super().__exit__()
        self._server.close()


class _Accepted:
    """A server with one client, to be used like a socket for datagrams."""

    def __init__(self, server: socket.socket) -> None:
        self._server, self._client = server, None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._server, name)

    def settimeout(self, seconds: float) -> None:
        (self._client or self._server).settimeout(seconds)

    def recvfrom(self, size: int) -> tuple[bytes, Any]:
        if self._client is None:
            self._client, _ = self._server.accept()
            return b"", self._client
        data = self._client.recv(size)
        if not data:
            raise TimeoutError
        return data, self._client

    def sendto(self, data: bytes, peer: Any) -> None:
        with contextlib.suppress(OSError):
            peer.settimeout(None)
            peer.sendall(data)

    def close(self) -> None:
        if self._client is not None:
            self._client.close()


@pytest.mark.parametrize("is_first", [True, False])
@pytest.mark.parametrize("link", [SharedLink, SharedStream])
@pytest.mark.parametrize("system", [2, 1])
def test_an_airborne_vehicle_is_not_taken_for_the_simulator_beside_it(link, system, is_first):
    simulation = hovering()
    mode = int(simulation.v.autopilot.modes.number)
    with link(simulation, system, is_first) as vehicle:
        form = "tcp" if link is SharedStream else "udpout"
        env = gym.make(COPTER, connection=f"{form}:127.0.0.1:{vehicle.port}", patience=1.0)
        with pytest.raises(NotASimulatorError, match=r"armed, in mode 4"):
            env.reset(seed=1)
        env.close()
    assert vehicle.commands() <= {REQUEST_MESSAGE}
    assert not {DISARM, REBOOT} & {fields.command for name, fields in vehicle.asked if name.startswith("COMMAND")}
    assert simulation.v.autopilot.arming.armed == 1 and int(simulation.v.autopilot.modes.number) == mode
    assert vehicle.other.before_boot_us == 0
    simulation.advance(3.0)
    assert height(simulation) == pytest.approx(5.0, abs=0.5)
