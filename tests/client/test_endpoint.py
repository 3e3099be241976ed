# SPDX-License-Identifier: BSD-3-Clause
"""What the client refuses to send, and its sockets: lockstep, the vehicle's clock, links that lose frames."""

from __future__ import annotations

import contextlib
import math
import random
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from sitl import Simulation
from sitl.bridge.dialect import FieldError, UnknownMessageError, message
from sitl.bridge.links.inprocess import InProcessLink
from sitl.client import Client, InProcess, LinkLostError, WaitTimeoutError
from sitl.client.endpoint import Endpoint
from sitl.errors import OptionError
from sitl.simulation import Core
from tests.ports import free_port


@pytest.mark.parametrize(("name", "field", "value", "allowed"), [
    ("COMMAND_LONG", "command", 70000, "0 .. 65535"),
    ("COMMAND_LONG", "target_system", -1, "0 .. 255"),
    ("COMMAND_LONG", "command", 400.0, "whole numbers"),
    ("COMMAND_LONG", "param2", 1e40, "single precision"),
    ("COMMAND_LONG", "param2", "1", "single precision"),
    ("COMMAND_INT", "x", 2**31, "-2147483648 .. 2147483647"),
    ("PARAM_SET", "param_id", "RTL_ALT", "bytes (b'...'), at most 16"),
    ("PLAY_TUNE", "tune", 5, "bytes (b'...'), at most 30"),
    ("ATT_POS_MOCAP", "q", (1.0, 0.0, 0.0, 0.0, 0.0), "at most 4 numbers"),
    ("ATT_POS_MOCAP", "q", (1.0, None), "at most 4 numbers"),
    ("ATT_POS_MOCAP", "q", 1.0, "a sequence"),
])  # fmt: skip
def test_a_value_that_does_not_fit_is_named(name: str, field: str, value: Any, allowed: str) -> None:
    client = Endpoint()
    with pytest.raises(FieldError) as caught:
        client.send(name, **{field: value})
    error = caught.value
    assert (error.message, error.field, error.value) == (name, field, value)
    assert f"{name}.{field} cannot be {value!r}" in str(error) and allowed in str(error)
    assert isinstance(error, ValueError)


def test_what_fits_is_packed() -> None:
    packed = message("ATT_POS_MOCAP").payload(q=(1.0, 0.5), x=-3.0)
    assert message("ATT_POS_MOCAP").decode(packed).q == (1.0, 0.5, 0.0, 0.0)
    with pytest.raises(UnknownMessageError, match="param9"):
        Endpoint().send("COMMAND_LONG", param9=1.0)


def test_a_command_has_seven_parameters() -> None:
    client = Endpoint()
    client.command(400, *range(7))
    with pytest.raises(FieldError, match=r"COMMAND_LONG\.param8 .*param1 \.\. param7"):
        client.command(400, *range(8))


@pytest.mark.parametrize("rate", [math.nan, math.inf, -1.0])
def test_a_rate_that_is_none_is_refused(rate: float) -> None:
    with pytest.raises(FieldError, match=r"ATTITUDE\.rate_hz"):
        Endpoint().set_interval("ATTITUDE", rate)


def test_rate_0_stops_a_message() -> None:
    client = Endpoint()
    for rate, interval in ((0.0, -1.0), (4.0, 250_000.0)):
        client.set_interval("ATTITUDE", rate)
        frame = client._splitter.feed(client.link.peers[0].take())[0]
        fields: Any = frame.kind.decode(frame.payload)
        assert (fields.command, fields.param1, fields.param2) == (511, 30.0, interval)


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
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # a first script is not told of what it did not ask for
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
    with pytest.raises(OptionError, match="connection 'http:COM1' is none of"):
        Client("http:COM1")
    for text, part in (("udp:127.0.0.1", "port"), ("tcp:5760", "host")):
        with pytest.raises(OptionError, match=f"connection '{text}': the {part} is missing"):
            Client(text)
    port = free_port()
    with pytest.raises(LinkLostError, match="refused"):
        Client(f"tcp:127.0.0.1:{port}")


class Losses:
    """Loses a share of the frames, by dice."""

    def __init__(self, share: float, seed: int) -> None:
        self.share, self.dice, self.lost = share, random.Random(seed), 0

    def __call__(self, frame: bytes) -> bool:
        lost = self.dice.random() < self.share
        self.lost += lost
        return lost


@pytest.mark.parametrize("seed", range(4))
def test_what_is_lost_is_sent_again(core: Core, seed: int) -> None:
    there, back = Losses(0.2, seed), Losses(0.2, 100 + seed)
    simulation = Simulation("erle_copter", seed=1, core=core)
    vehicle = Client(InProcess(simulation, link=InProcessLink(drop_to_client=back, drop_to_vehicle=there)))
    vehicle.wait_ready()
    vehicle.params.update(WPNAV_SPEED=700, RTL_ALT=1300)
    params = simulation.v.autopilot.params
    assert (params.WPNAV_SPEED, params.RTL_ALT) == (700, 1300)
    corners = [vehicle.item("NAV_WAYPOINT", float(k), 10.0, altitude=10) for k in range(20)]
    vehicle.upload([vehicle.item("NAV_WAYPOINT"), vehicle.item("NAV_TAKEOFF", altitude=10), *corners])
    assert len(simulation.mission) == 22
    assert [item.x for item in simulation.mission.items[2:]] == [item.x for item in corners]
    vehicle.set_mode("GUIDED")
    vehicle.arm()
    assert simulation.v.autopilot.arming.armed
    assert there.lost > 5 and back.lost > 50


def test_a_link_that_is_cut_ends_in_a_time_out(core: Core) -> None:
    there = Losses(0.0, 0)
    vehicle = Client(
        InProcess(Simulation("erle_copter", core=core), link=InProcessLink(drop_to_vehicle=there)), name="mute"
    )
    vehicle.delay(1)
    there.share = 1.0
    with pytest.raises(WaitTimeoutError, match="waited 5 s for an answer to arming") as failure:
        vehicle.arm()
    assert "mute at 6.0 s simulated" in str(failure.value)
    with pytest.raises(WaitTimeoutError, match="waited 5 s for the value of RTL_ALT"):
        vehicle.params["RTL_ALT"]
    assert there.lost > 12
