# SPDX-License-Identifier: BSD-3-Clause
"""Physics in processes of their own, and beside the test in a thread."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from sitl.physics.native.power_on import DEFAULT_HOME
from sitl.plants.local import stand_alone
from sitl.plants.physics_server import PhysicsServer
from tests.bridge.hil.hil_peers import PhysicsProcess

Start = Callable[..., PhysicsProcess]
Beside = Callable[..., PhysicsServer]


@pytest.fixture
def physics() -> Iterator[Start]:
    """Starts ``sitl physics VEHICLE OPTIONS...``; all are ended after the test."""
    started: list[PhysicsProcess] = []

    def start(*options: str) -> PhysicsProcess:
        started.append(PhysicsProcess(*options))
        return started[-1]

    yield start
    for process in started:
        process.kill()


@pytest.fixture
def beside() -> Iterator[Beside]:
    """Starts a server in a thread of this process; what it says is in ``server.said``."""
    stopped = threading.Event()
    threads: list[threading.Thread] = []
    servers: list[PhysicsServer] = []

    def start(frame: str = "erle_copter", port: int = 0, **options: object) -> PhysicsServer:
        plant = stand_alone(frame, home=DEFAULT_HOME, **options)  # type: ignore[arg-type]
        said: list[str] = []
        server = PhysicsServer(plant, "127.0.0.1", port, said.append)
        server.said = said  # type: ignore[attr-defined]
        thread = threading.Thread(target=server.serve, args=(lambda: not stopped.is_set(),), daemon=True)
        thread.start()
        threads.append(thread)
        servers.append(server)
        return server

    yield start
    stopped.set()
    for thread in threads:
        thread.join(10.0)
    for server in servers:
        server.close()
