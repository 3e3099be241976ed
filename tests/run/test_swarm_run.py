# SPDX-License-Identifier: BSD-3-Clause
"""A swarm is served as one vehicle is: time stands until clients grant it, and links are shared or own."""

from __future__ import annotations

import argparse
import socket
from pathlib import Path

import pytest

from sitl import Swarm
from sitl.bridge.dialect import message
from sitl.bridge.frame import Frame, Splitter, encode_v2
from sitl.bridge.links import InProcessLink, LinkAddressError
from sitl.bridge.services.command_protocol import GRANT
from sitl.cli import parser
from sitl.cli.swarm import moved, opened
from sitl.errors import OptionError
from sitl.run.swarm import serve_swarm, serve_swarm_lockstep


def grant(time_ms: int, target: int) -> bytes:
    kind = message("COMMAND_INT")
    fields = {"command": GRANT, "x": time_ms, "target_system": target, "target_component": 1}
    return encode_v2(kind, kind.payload(**fields), 0, 255, 190)


def acks(link: InProcessLink) -> list[tuple[int, int]]:
    """System and time [ms] of each answer to a grant."""
    frames: list[Frame] = Splitter().feed(link.receive())
    told = [(frame.system, frame.kind.decode(frame.payload)) for frame in frames if frame.kind.name == "COMMAND_ACK"]
    return [(system, ack.result_param2) for system, ack in told]


def options(*words: str) -> argparse.Namespace:
    return parser().parse_args(["run", "copter", "--quiet", "--out", "none", "--tcp", "0", *words])


class Slices:
    """Paces by nothing; notes when it was asked."""

    slice_us = 50_000

    def __init__(self) -> None:
        self.times: list[int] = []

    def after_slice(self, simulation: Swarm) -> None:
        self.times.append(simulation.time_us)


def test_a_run_goes_slice_by_slice_to_its_end() -> None:
    swarm, pace = Swarm("erle_copter", 2), Slices()
    serve_swarm(swarm, pace, until_us=120_000)
    assert pace.times == [50_000, 100_000, 120_000]
    assert [vehicle.time_us for vehicle in swarm.vehicles] == [120_000] * 2


def test_time_goes_as_far_as_it_is_granted() -> None:
    """A grant to all, then grants to each: the shorter one counts."""
    swarm, link = Swarm("erle_copter", 2), InProcessLink()
    swarm.router.add_link(link)
    says = [grant(500, 0), b"", grant(1000, 2), grant(700, 1), b""]
    times: list[int] = []
    answers: list[list[tuple[int, int]]] = []

    def running() -> bool:
        times.append(swarm.time_us // 1000)
        answers.append(acks(link))
        if not says:
            return False
        link.send(says.pop(0))
        return True

    serve_swarm_lockstep(swarm, running=running)
    assert times == [0, 500, 500, 500, 700, 700]
    assert answers == [[], [(1, 500), (2, 500)], [], [], [(1, 700)], []]


def test_links_are_shared_or_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for own, systems in (([], [{1, 2}]), (["--own-links"], [{1}, {2}])):
        with opened(options("--count", "2", "--log-dir", str(tmp_path), *own)) as (swarm, first_port, _):
            ports = [int(line.split()[2].rpartition(":")[2]) for line in links(capsys)]
            assert len(ports) == len(systems) and ports[0] == first_port
            for port, expected in zip(ports, systems, strict=True):
                with socket.create_connection(("127.0.0.1", port), 10.0) as client:
                    client.settimeout(10.0)
                    swarm.advance(2.5)
                    frames = Splitter().feed(client.recv(1 << 16))
                    assert {frame.system for frame in frames} == expected
        assert len(list(tmp_path.glob("*.tlog"))) >= 2


def links(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """Lines that say where a link is."""
    return [line for line in capsys.readouterr().out.splitlines() if line.startswith("MAVLink on tcp")]


def test_a_client_that_leaves_is_forgotten_by_all(tmp_path: Path) -> None:
    with opened(options("--count", "2", "--log-dir", str(tmp_path))) as (swarm, port, _):
        before = [len(vehicle.bridge.channels) for vehicle in swarm.vehicles]
        with socket.create_connection(("127.0.0.1", port), 10.0):
            swarm.advance(0.1)
            assert [len(vehicle.bridge.channels) for vehicle in swarm.vehicles] == [n + 1 for n in before]
        swarm.advance(0.1)
        assert [len(vehicle.bridge.channels) for vehicle in swarm.vehicles] == before


@pytest.mark.parametrize("words", [("--rec", "x.rec"), ("--instance", "1"), ("--from", "x.rec")])
def test_options_of_one_vehicle_are_refused(words: tuple[str, str], tmp_path: Path) -> None:
    with (
        pytest.raises(OptionError, match=words[0]),
        opened(options("--count", "2", "--log-dir", str(tmp_path), *words)),
    ):
        pass


def test_ports_of_later_vehicles_are_ports() -> None:
    assert moved("udp:127.0.0.1:14550", 30) == "udpout:127.0.0.1:14580"
    with pytest.raises(LinkAddressError, match="above 65535"):
        moved("udp:127.0.0.1:65530", 10)


@pytest.mark.parametrize("words", [("--count", "0"), ("--count", "251"), ("--spacing", "0"), ("--spacing", "far")])
def test_numbers_that_cannot_be_are_refused(words: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        options(*words)
    assert words[1] in capsys.readouterr().err
