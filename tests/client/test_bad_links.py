# SPDX-License-Identifier: BSD-3-Clause
"""All that a client does, over a link with 20 % loss, 200 +- 100 ms, duplicates and reordering."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from sitl.bridge.frame import Splitter
from sitl.bridge.links import LinkFaults
from sitl.client import Client, CommandRefusedError, FileRefusedError
from sitl.run import runner
from sitl.simulation import Core, Simulation

BAD = LinkFaults(loss=0.2, delay=(0.1, 0.3), duplicates=0.05, reordering=0.1)
FRAMES = {"copter": "erle_copter", "rover": "erle_rover"}


class Frames:
    """A tap: messages on the vehicle's side of the link, in and out."""

    def __init__(self) -> None:
        self.splitter, self.commands, self.acks = Splitter(), Counter[int](), Counter[int]()

    def frame(self, time_us: int, raw: bytes) -> None:
        for frame in self.splitter.feed(raw):
            if frame.kind.name in ("COMMAND_LONG", "COMMAND_INT"):
                self.commands[frame.kind.decode(frame.payload).command] += 1
            elif frame.kind.name == "COMMAND_ACK":
                self.acks[frame.kind.decode(frame.payload).command] += 1


@pytest.fixture(params=FRAMES)
def vehicle(request: pytest.FixtureRequest, core: Core) -> Iterator[Client]:
    simulation = Simulation(FRAMES[request.param], seed=1)
    client = Client(simulation, link_faults=BAD)
    yield client
    client.close()


def test_parameters(vehicle: Client) -> None:
    values = vehicle.params.read_all()
    assert len(values) == len(vehicle.simulation.parameters.listed()) and vehicle.now < 30.0
    del values["MIS_TOTAL"]  # it becomes 1 with home, while it reads
    assert values == pytest.approx({name: vehicle.simulation.parameters[name] for name in values}, nan_ok=True)
    for k in range(10):
        vehicle.params["FS_GCS_TIMEOUT"] = 5 + k
        assert vehicle.params["FS_GCS_TIMEOUT"] == 5 + k


def test_missions(vehicle: Client) -> None:
    vehicle.wait_ready(90.0)
    home = vehicle.item("NAV_WAYPOINT")
    items = [home, *(vehicle.item("NAV_WAYPOINT", 5.0 * k, 3.0, altitude=10 + k) for k in range(40))]
    begin = vehicle.now
    vehicle.upload(items)
    assert vehicle.now - begin < 120.0
    assert vehicle.simulation.mission.items[1:] == tuple(items[1:])
    begin = vehicle.now
    assert vehicle.download()[1:] == tuple(items[1:])
    assert vehicle.now - begin < 30.0
    vehicle.upload(items[:3])  # over the same link, right behind the other one
    assert len(vehicle.download()) == 3


def test_files(vehicle: Client) -> None:
    assert {"uarts.txt", "tasks.txt"} < set(vehicle.list_folder("@SYS"))
    begin = vehicle.now
    packed = vehicle.read_file("@PARAM/param.pck")
    assert int.from_bytes(packed[2:4], "little") == len(vehicle.simulation.parameters.listed())
    assert vehicle.now - begin < 60.0
    with pytest.raises(FileRefusedError, match="file nothing was refused: there is none of this name"):
        vehicle.read_file("nothing")


def test_logs(core: Core, tmp_path: Path) -> None:
    simulation = Simulation("erle_copter", seed=1, params={"LOG_DISARMED": 1})
    logger = runner.open_dataflash(simulation, tmp_path / "log.bin")
    vehicle = Client(simulation, link_faults=BAD)
    vehicle.delay(60.0)
    (log,) = vehicle.logs()
    assert log.size > 200_000
    begin = vehicle.now
    data = vehicle.download_log(log)
    assert vehicle.now - begin < 60.0
    vehicle.close()
    assert data == (tmp_path / "log.bin").read_bytes()[: log.size]
    assert logger is not None


def test_each_transmission_of_a_command_is_carried_out_and_answered_once(vehicle: Client) -> None:
    frames = Frames()
    vehicle.simulation.bridge.taps.append(frames)
    for k in range(30):
        vehicle.command("SET_MESSAGE_INTERVAL", 30, 1e6 / (1 + k))
        with pytest.raises(CommandRefusedError, match="unsupported"):
            vehicle.command(31999)
    vehicle.delay(1.0)
    assert frames.commands == frames.acks and frames.commands[31999] > 30


def test_a_guided_flight(core: Core) -> None:
    vehicle = Client(Simulation("erle_copter", seed=1), link_faults=BAD)
    vehicle.wait_ready(90.0)
    vehicle.take_off(10)
    for k in range(4):
        vehicle.goto(10.0 * (k % 2), 10.0 * (k // 2), 10 + k)
    vehicle.set_velocity(0.0, 2.0)
    vehicle.delay(5.0)
    assert vehicle.position.east > 15.0
    vehicle.land()
    vehicle.close()


def test_a_guided_drive(core: Core) -> None:
    vehicle = Client(Simulation("erle_rover", seed=1), link_faults=BAD)
    vehicle.wait_ready(90.0)
    vehicle.guided_and_armed()
    vehicle.goto(15.0, 5.0)
    there = vehicle.position
    vehicle.goto(0.0, 0.0, accuracy=2.0)
    back = vehicle.position
    vehicle.disarm()
    assert math.hypot(there.north - 15.0, there.east - 5.0) < 3.0 and math.hypot(back.north, back.east) < 3.0
    assert not vehicle.armed
    vehicle.close()
