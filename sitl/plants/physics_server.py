# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle's physics for an autopilot elsewhere, over a MAVLink HIL link: what ``sitl physics`` runs.

It listens; one autopilot at a time connects. Between two autopilots, and while one is silent, time stands.
"""

from __future__ import annotations

import contextlib
import select
import socket
import time
from collections.abc import Callable

from ..autopilot.params.parameter import stored
from ..bridge.hil.physics_end import PhysicsEnd, text_frame
from ..bridge.hil.protocol import BASE_PORT
from ..bridge.links import LOCAL, LinkAddressError
from ..core.constants import TICK_S
from ..physics.carried import Carried
from ..vehicle.sim_parameters import PREFIX
from .hil_link import tune
from .local import LocalPlant, restart

_CATCH_UP_S = 0.05

PATIENCE_S = 5.0
"""Silence of the autopilot after which it is said that time stands [s of wall time]."""
WAIT_S = 0.2
"""Longest wait between two looks at what else happens [s of wall time]."""
LOOK_EXCHANGES = 400
"""Exchanges between two looks for a second autopilot."""
READ_BYTES = 1 << 16


def serve(
    plant: LocalPlant, address: str, instance: int, say: Callable[[str], None], running: Callable[[], bool]
) -> None:
    """Listen at "[HOST:]PORT" (nothing: port 4560 + instance of this machine) until ``running()`` is false.

    Raises:
        LinkAddressError: not an address, or one that cannot be opened.
    """
    host, _, port = address.rpartition(":")
    if address and not (port.isascii() and port.isdigit() and int(port) < 65536):
        raise LinkAddressError(f"tcp:{address}: {port!r} is not a port (0 .. 65535, 0 takes a free one)")
    server = PhysicsServer(plant, host or LOCAL, int(port or BASE_PORT + instance), say)
    say(f"MAVLink HIL on tcp:{server.address[0]}:{server.address[1]}")
    try:
        server.serve(running)
    finally:
        server.close()


class SimulatedPlant:
    """A plant without an autopilot, as the protocol's end takes it."""

    def __init__(self, plant: LocalPlant) -> None:
        self.plant = plant
        vehicle = plant.vehicle
        self.fleet, self.index, self.v = vehicle.fleet, vehicle.index, vehicle.v
        self._params, self._table = vehicle.v.autopilot.params, vehicle.kind.firmware.table
        self.tick = plant.tick

    def power_on(self) -> None:
        """Begin anew at time 0."""
        restart(self.plant)

    def set_parameter(self, name: str, value: float) -> float | None:
        """Set a SIM_ parameter. Before the first tick the world begins anew under it: its wind already blows."""
        if not name.startswith(PREFIX) or name not in self._table:
            return None
        parameter = self._table[name]
        if not parameter.has_effect:
            return None
        if parameter.refusal(value) is None:
            self._params[name] = stored(parameter, value)
            if int(self.v.tick) == 0:
                self.power_on()
            else:
                self.plant.parameter_changed(name)
        return float(self._params[name])

    def reseed(self, seed: int) -> None:
        """Another seed for all sensor noise from now on."""
        self.plant.reseed(seed)

    def truth(self) -> Carried:
        """Where the vehicle really is."""
        return self.plant.truth()


class PhysicsServer:
    """Listens for an autopilot and serves it.

    Args:
        plant: the vehicle's physics, at power-on.
        host, port: where it listens; port 0 takes a free one.
        say: called with what people should know.

    Raises:
        LinkAddressError: the port is taken or not allowed.
    """

    def __init__(self, plant: LocalPlant, host: str, port: int, say: Callable[[str], None] = lambda text: None) -> None:
        self.end = PhysicsEnd(SimulatedPlant(plant), plant.vehicle.kind.mav_type)
        self._say = say
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._socket.bind((host, port))
            self._socket.listen(4)
        except OSError as error:
            self._socket.close()
            raise LinkAddressError(f"tcp:{host}:{port} cannot be opened: {error.strerror or error}") from None
        self._socket.setblocking(False)
        self.address: tuple[str, int] = self._socket.getsockname()[:2]

    def serve(self, running: Callable[[], bool] = lambda: True) -> None:
        """Serve one autopilot after the other until ``running()`` is false."""
        while running():
            found = self._accept(WAIT_S)
            if found is not None:
                connection, name = found
                self._say(f"autopilot {name} has come at {self._time()}")
                with contextlib.closing(connection):
                    why = self._serve_one(connection, running)
                self._say(f"autopilot {name} has gone at {self._time()}: {why}; time stands")

    def close(self) -> None:
        """Listen no more."""
        self._socket.close()

    def _time(self) -> str:
        return f"{self.end.time_us * 1e-6:.4f} s"

    def _accept(self, wait_s: float) -> tuple[socket.socket, str] | None:
        if wait_s and not select.select([self._socket], [], [], wait_s)[0]:
            return None
        try:
            connection, address = self._socket.accept()
            tune(connection, WAIT_S)
        except OSError:  # nobody, or gone again
            return None
        return connection, f"{address[0]}:{address[1]}"

    def _refuse_others(self) -> None:
        """There is one autopilot already."""
        found = self._accept(0.0)
        if found is not None:
            connection, name = found
            self._say(f"autopilot {name} is refused: another one is connected")
            with contextlib.suppress(OSError):
                connection.sendall(text_frame(self.end.measurements, "refused: another autopilot is connected"))
            connection.close()

    def _serve_one(self, connection: socket.socket, running: Callable[[], bool]) -> str:
        """Serve a connection to its end; gives the reason of that."""
        end = self.end
        end.greet()
        receive, send, feed = connection.recv, connection.sendall, end.feed
        silence = Silence(self._say, self._time)
        exchanges, is_told = 0, False
        try:
            while running():
                wait_s = end.wait_s
                if wait_s is not None and not select.select([connection], [], [], wait_s)[0]:
                    send(end.go_on())
                    self._send()
                    continue
                try:
                    data = receive(READ_BYTES)
                except TimeoutError:
                    silence.goes_on()
                    self._refuse_others()
                    continue
                if not data:
                    return "it closed the connection"
                answer = feed(data)
                if answer:
                    send(answer)
                if silence.waits:
                    silence.is_over()
                if end.notes:
                    self._send()
                exchanges += 1
                if exchanges % LOOK_EXCHANGES == 0:
                    self._refuse_others()
                if end.freewheels:
                    if not is_told:
                        since = f"from {self._time()} on time goes by itself, in real time"
                        self._say(f"the autopilot does not drive yet: {since}")
                        is_told = True
                    self._freewheel(connection, running)
        except TimeoutError:
            return "it does not read"
        except OSError as error:
            return error.strerror or str(error)
        return "the physics ends"

    def _freewheel(self, connection: socket.socket, running: Callable[[], bool]) -> None:
        """Go on by itself, in real time, until the autopilot is booted and drives."""
        end = self.end
        due = time.monotonic()
        while end.freewheels and running():
            wait = due - time.monotonic()
            if wait <= 0.0:
                connection.sendall(end.go_on())
                due = max(due + TICK_S, due - wait - _CATCH_UP_S)
            if select.select([connection], [], [], max(wait, 0.0))[0]:
                data = connection.recv(READ_BYTES)
                if not data:
                    raise ConnectionResetError("it closed the connection")
                answer = end.feed(data)
                if answer:
                    connection.sendall(answer)
            self._send()
            self._refuse_others()
        if not end.freewheels:
            self._say(f"from {self._time()} on every tick waits for the autopilot")

    def _send(self) -> None:
        for text in self.end.notes:
            self._say(text)
        self.end.notes.clear()


class Silence:
    """Says once that the autopilot is silent, and when it is not any more."""

    def __init__(self, say: Callable[[str], None], at: Callable[[], str]) -> None:
        self._say, self._at = say, at
        self.waits = 0
        """Waits in vain since it was last received."""
        self._is_said = False

    def goes_on(self) -> None:
        """Another wait of WAIT_S in vain."""
        self.waits += 1
        if not self._is_said and self.waits * WAIT_S >= PATIENCE_S:
            self._is_said = True
            self._say(f"the autopilot is silent: time stands at {self._at()}")

    def is_over(self) -> None:
        """It was heard."""
        self.waits = 0
        if self._is_said:
            self._is_said = False
            self._say("the autopilot is back")
