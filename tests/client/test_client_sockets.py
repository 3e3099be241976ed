# SPDX-License-Identifier: BSD-3-Clause
"""The client by a socket: the same flight in lockstep, by the vehicle's own clock otherwise."""

from __future__ import annotations

import contextlib
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from sitl import Simulation
from sitl.client import Client, LinkLostError
from sitl.errors import OptionError
from sitl.simulation import Core


@contextlib.contextmanager
def served(folder: Path, *options: str) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """``sitl run copter`` in a process of its own; gives the address of its TCP port."""
    command = [sys.executable, "-m", "sitl", "run", "copter", "--tcp", "0", "--out", "none", "--quiet", *options]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            for line in process.stdout:
                if "tcp:" in line:
                    yield f"tcp:127.0.0.1:{int(line.rsplit(':', 1)[1])}", process
                    break
        finally:
            process.kill()


def hop(vehicle: Client) -> None:
    vehicle.wait_ready()
    vehicle.params["WPNAV_SPEED"] = 400
    vehicle.take_off(5)
    vehicle.goto(north=6, east=2, altitude=6)


def test_in_lockstep_it_is_the_flight_in_process(core: Core, tmp_path: Path) -> None:
    here = Client(Simulation("erle_copter", seed=3, core=core))
    hop(here)
    with served(tmp_path, "--lockstep", "--seed", "3") as (address, process):
        there = Client(address)
        hop(there)
        assert (there.describe(), there.attitude, there.now) == (here.describe(), here.attitude, here.now)
        assert there.texts == here.texts
        process.kill()
        process.wait()
        with pytest.raises(LinkLostError, match=f"connection {address} is lost"):
            there.delay(1)


def test_by_the_vehicles_own_clock(core: Core, tmp_path: Path) -> None:
    with served(tmp_path, "--speedup", "20") as (address, _):
        with pytest.warns(UserWarning, match="clock cannot be held"):
            vehicle = Client(address)
        hop(vehicle)
        assert vehicle.position.altitude == pytest.approx(6, abs=1.1)
        began = vehicle.now
        vehicle.delay(2)
        assert vehicle.now - began >= 1.99
        with pytest.raises(OptionError, match="not in this process"):
            vehicle.simulation.time_us  # noqa: B018
        vehicle.close()


def test_addresses_are_checked() -> None:
    with pytest.raises(OptionError, match="connection 'serial:COM1' is none of"):
        Client("serial:COM1")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(LinkLostError, match="refused"):
        Client(f"tcp:127.0.0.1:{port}")
