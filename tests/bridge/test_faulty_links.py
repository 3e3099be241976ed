# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles at the end of links with faults: the same seed gives the same bytes at the same simulated times."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.client import Client, InProcess
from sitl.client.endpoint import Endpoint
from sitl.core.constants import NEVER
from sitl.errors import OptionError
from sitl.fleet import Fleet
from sitl.recording.recorder import Recorder
from sitl.recording.recording import read
from sitl.recording.replay import Replay
from sitl.run.standstill import serve_lockstep
from sitl.simulation import Core, Simulation
from tests.test_fleet import command

BAD = LinkFaults(loss=0.2, delay=(0.1, 0.3), duplicates=0.1, reordering=0.1, corruption=1e-5, seed=3)
REQUEST, ATTITUDE = 512, 30


class Times:
    """A client's link that notes when what it hears has come."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation, self.link, self.heard = simulation, InProcessLink(), list[tuple[int, bytes]]()
        simulation.bridge.add_link(self.link)
        self.endpoint = Endpoint(self.link)

    def advance(self, us: int, step_us: int = 2_500) -> None:
        end = self.simulation.time_us + us
        while self.simulation.time_us < end:
            self.simulation.advance_to(min(self.simulation.time_us + step_us, end))
            if data := self.link.receive():
                self.heard.append((self.simulation.time_us, data))

    @property
    def bytes(self) -> bytes:
        return b"".join(data for _, data in self.heard)


@pytest.fixture
def simulation(core: Core) -> Simulation:
    return Simulation("erle_copter", core=core, seed=1)


def talk(simulation: Simulation, faults: LinkFaults | None, step_us: int) -> bytes:
    simulation.set_link_faults(faults)
    client = Times(simulation)
    client.endpoint.set_interval("ATTITUDE", 20)
    for _ in range(10):
        client.endpoint.command(REQUEST, ATTITUDE)
        client.endpoint.send("PARAM_REQUEST_READ", target_system=1, param_id=b"RTL_ALT", param_index=-1)
        client.advance(500_000, step_us)
    client.advance(2_000_000, step_us)
    return client.bytes


def test_how_far_each_call_advances_changes_nothing(core: Core) -> None:
    said = [talk(Simulation("erle_copter", core=core), BAD, step) for step in (2_500, 20_000, 500_000)]
    assert said[0] == said[1] == said[2]
    assert said[0] != talk(Simulation("erle_copter", core=core), replace(BAD, seed=4), 20_000)


def test_faults_that_do_nothing_change_no_byte(core: Core) -> None:
    plain, nothing = (talk(Simulation("erle_copter", core=core), f, 20_000) for f in (None, LinkFaults()))
    assert plain == nothing


def test_frames_arrive_when_they_should(simulation: Simulation) -> None:
    client = Times(simulation)
    simulation.set_link_faults(LinkFaults(delay=0.1), client.link)
    client.advance(1_000_000)
    client.heard.clear()
    client.endpoint.command(REQUEST, 148)  # AUTOPILOT_VERSION
    client.advance(1_000_000)
    when = next(time for time, data in client.heard if b"\x4d\x00\x00" in data[7:10])
    assert when == 1_200_000


def test_one_direction(simulation: Simulation) -> None:
    client = Times(simulation)
    simulation.set_link_faults(LinkFaults(loss=1.0, direction="to-vehicle"), client.link)
    client.endpoint.command(REQUEST, 148)
    client.advance(1_200_000)
    assert b"\xfd\x09" in client.bytes and b"\x4d\x00\x00" not in client.bytes  # HEARTBEAT, and no COMMAND_ACK
    simulation.set_link_faults(LinkFaults(loss=1.0, direction="to-client"), client.link)
    client.heard.clear()
    received = simulation.bridge.channels[0].port.received
    client.endpoint.command(REQUEST, 148)
    client.advance(1_200_000)
    assert client.bytes == b"" and simulation.bridge.channels[0].port.received == received + 1


def test_repaired_links_are_as_they_were(simulation: Simulation) -> None:
    board, client = simulation.bridge.board, Times(simulation)
    assert not board.is_watched()
    simulation.set_link_faults(LinkFaults(delay=0.5))
    client.advance(1_000_000)
    assert board.is_watched() and board.faults.due_us(board.channels) != NEVER
    simulation.set_link_faults(None)
    client.advance(600_000)
    assert not board.is_watched() and board.channels[0].peer.directions is None
    assert client.heard[-1][0] >= 1_500_000  # what was under way has come


def test_one_link_of_several(simulation: Simulation) -> None:
    good, bad = Times(simulation), Times(simulation)
    simulation.set_link_faults(LinkFaults(loss=1.0), bad.link)
    good.advance(2_000_000)
    assert good.bytes and not bad.link.receive()
    simulation.set_link_faults(LinkFaults(loss=1.0))
    good.heard.clear()
    later = Times(simulation)
    good.advance(2_000_000)
    assert not good.bytes and not later.link.receive()


def test_bandwidth_holds_telemetry_back_and_lets_answers_pass(simulation: Simulation) -> None:
    client = Times(simulation)
    simulation.set_link_faults(LinkFaults(bandwidth=1200.0))
    client.endpoint.set_interval("ATTITUDE", 320)  # 13 kB/s
    client.advance(10_000_000)
    assert 0.9 * 12_000 < len(client.bytes) <= 12_100
    client.heard.clear()
    asked = simulation.time_us
    client.endpoint.command(REQUEST, 148)
    client.advance(1_000_000)
    assert asked < next(time for time, data in client.heard if data[7:10] == b"\x4d\x00\x00") < asked + 500_000


def test_a_snapshot_holds_what_is_under_way(core: Core) -> None:
    client = Client(Simulation("erle_copter", core=core, seed=1), link_faults=BAD)
    client.delay(5.0)
    moment = client.snapshot()

    def future() -> list[tuple[float, str]]:
        client.send_command("DO_SET_MODE", 1, 4)
        client.delay(5.0)
        return [(text.time, text.text) for text in client.texts] + [(client.now, client.mode)]

    first = future()
    client.set_link_faults(None)
    client.delay(2.0)
    client.restore(moment)
    assert client.simulation.bridge.board.is_watched()
    assert future() == first


def test_a_reboot_keeps_the_faults(core: Core) -> None:
    client = Client(Simulation("erle_copter", core=core), link_faults=LinkFaults(delay=0.2))
    client.delay(2.0)
    client.reboot()
    client.delay(2.0)
    assert client.simulation.before_boot_us > 0 and client.telemetry.mode
    assert client.simulation.bridge.channels[0].peer.directions is not None


def test_a_recording_holds_what_the_vehicle_heard(core: Core, tmp_path: Path) -> None:
    simulation = Simulation("erle_copter", core=core, seed=1)
    recorder = Recorder(simulation, tmp_path / "bad.rec")
    client = Client(simulation, link_faults=replace(BAD, bandwidth=20_000.0))
    client.delay(3.0)
    client.params["RTL_ALT"] = 2000
    client.reboot()
    client.delay(5.05)
    client.params["RTL_ALT"] = 1500
    recorder.stopped = "done"
    simulation.close()
    replay = Replay(read(tmp_path / "bad.rec"), core=core)
    assert replay.run() == [] == replay.differences
    replay.close()


def test_a_fleet_flies_as_simulations_of_their_own(core: Core) -> None:
    fleet = Fleet("erle_copter", 3, core=core, seed=1)
    fleet.set_link_faults([1, 2], BAD)
    alone = []
    for index in range(3):
        simulation = Simulation("erle_copter", core=core, seed=1)
        link = InProcessLink()
        simulation.bridge.add_link(link)
        if index:
            simulation.set_link_faults(replace(BAD, seed=BAD.seed + index))
        alone.append((simulation, link))
    for step in range(60):
        for index, (simulation, link) in enumerate(alone):
            if step % 7 == index:
                link.send(command(REQUEST, 148))
                fleet.send(index, command(REQUEST, 148))
            simulation.advance(0.05)
        fleet.advance(0.05)
        for index, (_, link) in enumerate(alone):
            assert fleet.receive(index) == link.receive()
    fleet.set_link_faults(range(3), None)
    fleet.advance(1.0)
    fleet.advance(1.0)
    assert not fleet._faulty
    fleet.close()


def test_lockstep_goes_on_over_a_bad_link(simulation: Simulation) -> None:
    """Grants and their answers pass; a client's first questions pass while time stands."""
    endpoint = Endpoint()
    simulation.set_link_faults(LinkFaults(loss=0.5, delay=0.3))
    simulation.bridge.add_link(endpoint.link)
    heard: list[str] = []

    def says(k: int) -> bool:
        heard.extend(f"{m.name} {m.fields.command}" for m in endpoint.receive() if m.name == "COMMAND_ACK")
        endpoint.command(REQUEST, 148)
        if k > 1:
            endpoint.send("COMMAND_INT", target_system=1, target_component=1, command=31010, x=100 * k)
        return k < 40

    serve_lockstep(simulation, running=map(says, range(41)).__next__)
    assert heard[:2] == ["COMMAND_ACK 512"] * 2  # asked while time stood
    assert heard.count("COMMAND_ACK 31010") >= 37
    assert 3 < heard.count("COMMAND_ACK 512") < 25
    assert simulation.time_us >= 3_900_000


def test_a_vehicle_elsewhere_has_its_own_options(simulation: Simulation) -> None:
    with pytest.raises(OptionError, match="sitl run --link-loss"):
        Client("tcp:127.0.0.1:1", link_faults=BAD)
    assert isinstance(Client(simulation, link_faults=BAD).connection, InProcess)
