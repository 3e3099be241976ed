# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that does not prove to be a simulator is not reset: in the air, a reset would let it fall."""

from __future__ import annotations

import socket
import threading
from typing import Any

import gymnasium as gym
import pytest

import sitl.envs  # noqa: F401
from benchmarks.recorded.pilot import Pilot
from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client.endpoint import Endpoint
from sitl.envs import EnvOptionError, NotASimulatorError
from sitl.simulation import Simulation

ROVER, COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"
DISARM, MODE, REBOOT, REQUEST_MESSAGE, INTERVAL = 400, 176, 246, 512, 511
DENIED = 2
QUESTIONS = {"PARAM_REQUEST_READ", "COMMAND_LONG"}


def hovering() -> Simulation:
    """A copter that hovers 5 m above the ground."""
    simulation = Simulation("erle_copter")
    pilot = Pilot(simulation)
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=5.0)
    pilot.fly(10.0)
    simulation.bridge.remove_link(pilot.connection.endpoint.link)
    return simulation


def height(simulation: Simulation) -> float:
    return -float(simulation.v.autopilot.estimate.pos[2])


_STEP_US = 20_000
_SILENCE_US = 120_000  # longer than a step of an environment
_PATIENCE = 1.0  # with a client that flies [s of wall time]


class RealVehicle:
    """A simulation behind a UDP port, in a thread; what gives it away does not pass.

    Args:
        simulation: the vehicle as it is now, armed and in the air, say.
        hidden: whether its SIM_ parameters are kept from clients.
        unsent: messages that it does not send at an interval.
        step_us: time from one look at the socket to the next [us]; a look takes a millisecond of wall time, or more.
        waits: while its client is silent for longer than a step of an environment, time waits for the client's next
            set-point, if a set-point came last, and else goes on no faster than the wall clock: so a client that flies
            is not late where the machine is busy.
    """

    def __init__(
        self,
        simulation: Simulation,
        hidden: bool = True,
        unsent: tuple[str, ...] = (),
        step_us: int = _STEP_US,
        waits: bool = False,
    ) -> None:
        self.simulation, self.hidden, self._step_us, self._waits = simulation, hidden, step_us, waits
        self._unsent = {message(name).id for name in unsent}
        self.received: list[tuple[str, Any]] = []
        """Name and fields of each message that came from the client."""
        self._client, self._splitter, self._sequence = Endpoint(), Splitter(), 0
        simulation.bridge.add_link(self._client.link)
        self._socket = self._open()
        self.port = self._socket.getsockname()[1]
        self._stop, self._came = threading.Event(), threading.Event()
        self._refusals: list[bytes] = []
        self._thread = threading.Thread(target=self._serve)

    def _open(self) -> socket.socket:
        made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        made.bind(("127.0.0.1", 0))
        return made

    def _advance(self) -> None:
        self.simulation.advance_to(self.simulation.time_us + self._step_us)

    def _said(self) -> bytes:
        """All that is to be sent to the client."""
        return self._client.link.receive()

    def __enter__(self) -> RealVehicle:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
        self._socket.close()

    def _serve(self) -> None:
        peer, heard_us, is_flown = None, self.simulation.time_us, False
        while not self._stop.is_set():
            is_silent = self._waits and self.simulation.time_us - heard_us > _SILENCE_US
            pace = _PATIENCE if is_flown else self._step_us * 1e-6
            self._socket.settimeout(pace if is_silent else 0.001)
            try:
                data, peer = self._socket.recvfrom(1 << 16)
            except TimeoutError:
                is_flown = is_flown and not is_silent
            else:
                heard_us = self.simulation.time_us
                for frame in self._splitter.feed(data):
                    self._take(frame)
                    is_flown = frame.kind.name.startswith("SET_")
            self._advance()
            said = self._said() + b"".join(self._refusals)
            self._refusals.clear()
            for at in range(0, len(said) if peer else 0, 8192):
                self._socket.sendto(said[at : at + 8192], peer)

    def _take(self, frame: Any) -> None:
        fields = frame.kind.decode(frame.payload)
        self.received.append((frame.kind.name, fields))
        self._came.set()
        if self.hidden and frame.kind.name == "PARAM_REQUEST_READ" and fields.param_id.startswith(b"SIM_"):
            return
        if frame.kind.name == "COMMAND_LONG" and fields.command == INTERVAL and int(fields.param1) in self._unsent:
            ack = message("COMMAND_ACK")
            self._refusals.append(encode_v2(ack, ack.payload(command=INTERVAL, result=DENIED), 0, 1, 1))
            return
        self._client.link.send(encode_v2(frame.kind, frame.payload, self._sequence, 255, 190))
        self._sequence = (self._sequence + 1) & 0xFF

    def count(self, name: str) -> int:
        """How many messages of this name have come."""
        return sum(each == name for each, _ in self.received)

    def wait(self, seconds: float = 1.0) -> None:
        """Until a message comes, at most so long [s of wall time]."""
        self._came.wait(seconds)
        self._came.clear()

    def commands(self) -> set[int]:
        """Numbers of the commands that came."""
        return {int(fields.command) for name, fields in self.received if name in ("COMMAND_LONG", "COMMAND_INT")}


def test_an_airborne_vehicle_that_may_be_real_hears_only_questions_and_flies_on():
    simulation = hovering()
    mode = int(simulation.v.autopilot.modes.number)
    with RealVehicle(simulation) as vehicle:
        env = gym.make(COPTER, connection=f"udpout:127.0.0.1:{vehicle.port}", patience=1.0)
        for _ in range(2):
            with (
                pytest.warns(UserWarning, match="clock cannot be held"),
                pytest.raises(NotASimulatorError, match=r"armed, in mode 4.*SIM_WIND_SPD.*in the air.*reset=\"force\""),
            ):
                env.reset(seed=1)
        env.close()
    assert {name for name, _ in vehicle.received} == QUESTIONS
    assert vehicle.commands() == {REQUEST_MESSAGE}
    assert simulation.v.autopilot.arming.armed == 1
    assert int(simulation.v.autopilot.modes.number) == mode
    simulation.advance(5.0)
    assert height(simulation) == pytest.approx(5.0, abs=0.5)


def test_a_vehicle_on_the_ground_is_neither_armed_nor_rebooted():
    simulation = Simulation("erle_rover", world="maze_erlerover")
    with RealVehicle(simulation) as vehicle:
        env = gym.make(ROVER, connection=f"udpout:127.0.0.1:{vehicle.port}", patience=1.0)
        with (
            pytest.warns(UserWarning, match="clock cannot be held"),
            pytest.raises(NotASimulatorError, match="disarmed, in mode"),
        ):
            env.reset(seed=1)
        env.close()
    assert vehicle.commands() == {REQUEST_MESSAGE}
    assert simulation.before_boot_us == 0


@pytest.mark.parametrize(("hidden", "options"), [(True, {"reset": "force"}), (False, {})])
def test_a_simulator_is_reset_and_so_is_what_the_user_says(hidden, options):
    simulation = Simulation("erle_rover", world="maze_erlerover")
    simulation.advance(60.0)
    with RealVehicle(simulation, hidden) as vehicle:
        env = gym.make(ROVER, connection=f"udpout:127.0.0.1:{vehicle.port}", patience=2.0, **options)
        with pytest.warns(UserWarning, match="clock cannot be held"):
            env.reset(seed=1)
        env.close()
    assert {DISARM, MODE, REBOOT} <= vehicle.commands()
    assert simulation.before_boot_us > 0
    assert simulation.v.autopilot.arming.armed == 1


@pytest.mark.parametrize("value", ["Reboot", "", None, True])
def test_other_words_are_refused(value):
    with pytest.raises(EnvOptionError, match=r"reset .* is not known; it is one of reboot, force, none, return"):
        gym.make(ROVER, reset=value)
