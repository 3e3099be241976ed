# SPDX-License-Identifier: BSD-3-Clause
"""Links, clients that read too slowly, and clients that push the clock, are what they were."""

from __future__ import annotations

from pathlib import Path

from sitl.bridge.links.link import Link, Peer
from sitl.client.endpoint import Endpoint
from sitl.recording.entries import EntryKind
from sitl.recording.recorder import Recorder
from sitl.recording.recording import Recording, read
from sitl.recording.replay import Replay
from sitl.run import runner
from sitl.run.standstill import serve_lockstep
from sitl.simulation import Core, Simulation
from tests.recording.conftest import Frames


class SlowPeer(Peer):
    """Reads nothing for a while; what is unsent grows."""

    def __init__(self) -> None:
        super().__init__("slow")
        self.unsent = self.got = 0
        self.reads = True

    @property
    def congested(self) -> bool:
        return self.unsent > 3000

    def flush(self) -> None:
        self.unsent += sum(map(len, self.outbox))
        self.outbox.clear()
        if self.reads:
            self.got += self.unsent
            self.unsent = 0


def replayed(recording: Recording, core: Core) -> list[tuple[int, bytes]]:
    """All frames of a replay, which must be as recorded."""
    replay = Replay(recording, core=core)
    tap = Frames()
    replay.simulation.bridge.taps.append(tap)
    assert replay.run() == []
    return tap.frames


def test_a_client_that_reads_too_slowly(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "slow.rec")
    tap = Frames()
    simulation.bridge.taps.append(tap)
    peer, link = SlowPeer(), Link("slow")
    link.add_peer(peer)
    simulation.bridge.add_link(link)
    simulation.bridge.stream_to(link, {"EXTRA1": 10, "RAW_SENS": 10})
    for second in range(12):
        peer.reads = second not in (2, 3, 4, 7, 8)
        simulation.advance(1.0)
    simulation.close()
    recording = read(tmp_path / "slow.rec")
    assert [entry.data[0] for entry in recording.entries if entry.kind is EntryKind.CONGESTED] == [1, 0, 1, 0]
    assert replayed(recording, core) == tap.frames


def test_lockstep(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "lockstep.rec")
    tap = Frames()
    simulation.bridge.taps.append(tap)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    turns = iter(range(1, 14))

    def push() -> None:
        turn = next(turns, 0)
        if turn % 6:
            client.send("COMMAND_INT", target_system=1, target_component=1, command=31010, x=turn * 220)
        if turn == 7:
            client.command(246, 1)

    serve_lockstep(simulation, running=lambda: simulation.time_us < 2_600_000, on_slice=push)
    simulation.close()
    recording = read(tmp_path / "lockstep.rec")
    kinds = [entry.kind for entry in recording.entries]
    assert kinds.count(EntryKind.LOCKSTEP) == 1 and kinds.count(EntryKind.GRANTED) >= 9
    assert EntryKind.HEARTBEAT in kinds
    assert replayed(recording, core) == tap.frames


def test_the_log_of_a_replay_is_the_log_of_the_run(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "x.rec")
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    log = runner.open_log(simulation, tmp_path, "first")
    client.command(512, 148)
    simulation.advance(5.0)
    simulation.close()

    def writer(of: Simulation) -> runner.TlogWriter:
        found = runner.TlogWriter(tmp_path / "second.tlog", of.bridge.epoch_us)
        of.bridge.taps.append(runner.ClientFrames(found, of.bridge.system))
        return found

    replay = Replay(read(tmp_path / "x.rec"), core=core, log=writer)
    assert replay.run() == []
    replay.close()
    assert (tmp_path / "second.tlog").read_bytes() == log.read_bytes()


def test_on_board_logs_that_a_client_downloads(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core, params={"LOG_DISARMED": 1.0})
    Recorder(simulation, tmp_path / "x.rec")
    tap = Frames()
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    runner.open_log(simulation, tmp_path, "first")
    simulation.bridge.taps.append(tap)
    simulation.advance(3.0)
    client.send("LOG_REQUEST_LIST", target_system=1, target_component=1, end=0xFFFF)
    simulation.advance(0.5)
    client.send("LOG_REQUEST_DATA", target_system=1, target_component=1, id=1, count=20000)
    simulation.advance(2.0)
    simulation.close()
    assert sum(m.name == "LOG_DATA" for m in client.receive()) > 100
    recording = read(tmp_path / "x.rec")
    assert replayed(recording, core) == tap.frames
    replay = Replay(recording, core=core, bin_file=lambda: tmp_path / "second.bin")
    assert replay.run() == []
    replay.close()
    assert (tmp_path / "second.bin").read_bytes() == (tmp_path / "first.bin").read_bytes()
