# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that may be real and a simulator on one link: the simulator proves nothing about the other."""

from __future__ import annotations

import contextlib
import select
import socket
import threading
from typing import Any

import gymnasium as gym
import pytest

import sitl.envs  # noqa: F401
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client import connect
from sitl.client.endpoint import ACK, Endpoint
from sitl.client.proof import PARAMETER_NAME
from sitl.envs import NotASimulatorError
from sitl.simulation import Simulation
from tests.envs import lockstep_vehicle
from tests.envs.test_reset_of_real_vehicles import (
    COPTER,
    DISARM,
    REBOOT,
    REQUEST_MESSAGE,
    ROVER,
    RealVehicle,
    height,
    hovering,
)

SIMSTATE, UNSUPPORTED = 164, 3
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


class Unasked(SharedLink):
    """One with the simulator's ids, which no other station asks; what it says of itself may be lost or changed."""

    def _advance(self) -> None:
        RealVehicle._advance(self)
        self.other.advance_to(self.other.time_us + self._step_us)

    def _said(self) -> bytes:
        said = Splitter().feed(self._heard.link.receive())
        others = b"".join(frame.raw for frame in said if frame.kind.name != "HEARTBEAT")
        return others + b"".join(self.passed(frame) for frame in Splitter().feed(RealVehicle._said(self)))

    def passed(self, frame: Any) -> bytes:
        return frame.raw


class OlderFirmware(Unasked):
    """It does not know REQUEST_MESSAGE, and does not say whom it answers."""

    def passed(self, frame: Any) -> bytes:
        if frame.kind is not ACK:
            return b"" if frame.kind.name in ("SIMSTATE", "AUTOPILOT_VERSION") else frame.raw
        fields = frame.kind.decode(frame.payload)
        result = UNSUPPORTED if fields.command == REQUEST_MESSAGE else fields.result
        return encode_v2(ACK, ACK.payload(command=fields.command, result=result), frame.sequence, 1, 1)


class OneWay(Unasked):
    """Its telemetry comes, its answers are lost."""

    def passed(self, frame: Any) -> bytes:
        return frame.raw if frame.kind.name in ("HEARTBEAT", "ATTITUDE", "GLOBAL_POSITION_INT", "SYS_STATUS") else b""


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


@pytest.mark.parametrize(("link", "why"), [
    (Unasked, "more often than it is asked"),
    (OlderFirmware, r"refuses SIMSTATE or AUTOPILOT_VERSION \(MAV_RESULT 3\)|two vehicles seem to have the ids"),
    (OneWay, "two vehicles seem to have the ids of system 1"),
])  # fmt: skip
def test_an_airborne_vehicle_with_the_simulators_ids_is_noticed(link, why):
    simulation = hovering()
    with link(simulation, 1, True) as vehicle:
        env = gym.make(COPTER, connection=f"udpout:127.0.0.1:{vehicle.port}", patience=1.0)
        with pytest.raises(NotASimulatorError, match=why):
            env.reset(seed=1)
        env.close()
    assert vehicle.commands() <= {REQUEST_MESSAGE} and simulation.v.autopilot.arming.armed == 1


class Repeated(RealVehicle):
    """A simulator on a link that brings all that it says twice."""

    def _said(self) -> bytes:
        return b"".join(2 * frame.raw for frame in Splitter().feed(super()._said()))


class AskedTwice(RealVehicle):
    """A simulator on a link that brings it everything twice."""

    def _take(self, frame: Any) -> None:
        super()._take(frame)
        super()._take(frame)


def test_a_simulator_is_one_on_a_link_that_repeats_what_it_says():
    with Repeated(Simulation("erle_rover"), hidden=False) as vehicle:
        link = connect(f"udpout:127.0.0.1:{vehicle.port}", patience=1.0)
        assert link.is_simulator and link.prove(), link.doubt
        link.close()


def test_one_that_answers_each_question_twice_is_told_from_no_second_vehicle():
    with AskedTwice(Simulation("erle_rover"), hidden=False) as vehicle:
        link = connect(f"udpout:127.0.0.1:{vehicle.port}", patience=1.0)
        assert "or one on a link that repeats what it is asked" in link.doubt
        link.close()
    assert vehicle.commands() == {REQUEST_MESSAGE}  # not even its time was asked for


class Router:
    """Between a client and a simulator in lockstep, by TCP; a second vehicle may join.

    Args:
        port: of the simulator.
        second: the vehicle that joins, which hides that it is simulated.
        is_heard: whether its answers arrive; else only its telemetry does.
    """

    def __init__(self, port: int, second: Simulation, is_heard: bool) -> None:
        self._second, self._is_heard = second, is_heard
        self._server, self._simulator = socket.create_server(("127.0.0.1", 0)), ("127.0.0.1", port)
        self.port = self._server.getsockname()[1]
        self._end, self._splitter = Endpoint(), Splitter()
        second.bridge.add_link(self._end.link)
        self.joined, self._stop = threading.Event(), threading.Event()
        self.commands: set[int] = set()
        """That the second vehicle has got since it joined."""
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self) -> Router:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
        self._server.close()

    def _serve(self) -> None:
        client, _ = self._server.accept()
        with client, socket.create_connection(self._simulator) as simulator:
            while not self._stop.is_set():
                for end in select.select([client, simulator], [], [], 0.01)[0]:
                    data = end.recv(1 << 16)
                    if not data:
                        return
                    (client if end is simulator else simulator).sendall(data)
                    if end is client and self.joined.is_set():
                        self._hand_on(data)
                if self.joined.is_set():
                    self._second.advance_to(self._second.time_us + 20_000)
                    client.sendall(self._said())

    def _hand_on(self, data: bytes) -> None:
        for frame in self._splitter.feed(data):
            fields = frame.kind.decode(frame.payload)
            self.commands.add(getattr(fields, "command", 0))
            if not getattr(fields, "param_id", b"").startswith(b"SIM_"):
                self._end.link.send(frame.raw)

    def _said(self) -> bytes:
        frames = Splitter().feed(self._end.link.receive())
        return b"".join(each.raw for each in frames if self._is_heard or each.kind.name in ("HEARTBEAT", "ATTITUDE"))


@pytest.mark.parametrize("is_heard", [pytest.param(True, marks=pytest.mark.slow), False])
def test_a_vehicle_that_joins_a_lockstep_link_later_is_not_reset(tmp_path, is_heard):
    second = hovering()
    running = lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", "--lockstep")
    with running as (port, _), Router(port, second, is_heard) as router:
        env = gym.make(ROVER, connection=f"tcp:127.0.0.1:{router.port}", patience=5.0)
        env.reset(seed=1)
        env.step(env.action_space.sample())
        router.joined.set()
        with pytest.raises(NotASimulatorError, match=r"two vehicles|refuses"):
            env.reset(seed=2)
        env.close()
    assert not {DISARM, REBOOT} & router.commands
    assert second.v.autopilot.arming.armed == 1 and height(second) == pytest.approx(5.0, abs=1.0)
