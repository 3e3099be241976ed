# SPDX-License-Identifier: BSD-3-Clause
"""What clients on sockets and the logs of a run get, however far the core goes at a time."""

from __future__ import annotations

import socket
from itertools import pairwise
from pathlib import Path

import pytest
from pymavlink import mavutil

from sitl.bridge.dialect import message
from sitl.bridge.frame import Frame, Splitter, encode_v2
from sitl.bridge.links import UdpInLink
from sitl.bridge.links.tcp import QUEUE_BYTES
from sitl.bridge.links.udp import DATAGRAM_BYTES
from sitl.client.endpoint import Endpoint
from sitl.logs.tlog import read_tlog
from sitl.run import runner
from sitl.simulation import Core, Simulation

ALL_AT_4_HZ = encode_v2(
    message("REQUEST_DATA_STREAM"),
    message("REQUEST_DATA_STREAM").payload(target_system=1, target_component=1, req_message_rate=4, start_stop=1),
    0, 255, 190,
)  # fmt: skip


class Reader:
    """A client that asks for all streams at 4 Hz and then only reads."""

    def __init__(self, simulation: Simulation, sock: socket.socket) -> None:
        self.socket, self.pieces = sock, list[bytes]()
        sock.send(ALL_AT_4_HZ)
        heard = simulation.bridge.received
        while simulation.bridge.received == heard:
            simulation.bridge.wait(5.0)
            simulation.bridge.receive()
        sock.setblocking(False)

    def read(self) -> None:
        """Read what has come."""
        try:
            while data := self.socket.recv(1 << 20):
                self.pieces.append(data)
        except BlockingIOError:
            return

    def frames(self) -> list[Frame]:
        """All frames so far."""
        self.read()
        return list(Splitter().feed(b"".join(self.pieces)))


def connected(core: Core, count: int = 1) -> tuple[Simulation, list[Reader]]:
    """A vehicle and its clients over TCP."""
    simulation = Simulation(core=core)
    link = runner.tcp_server(0)
    simulation.bridge.add_link(link)
    return simulation, [Reader(simulation, socket.create_connection(link.local_address)) for _ in range(count)]


def without_gap(frames: list[Frame]) -> bool:
    return all((b.sequence - a.sequence) % 256 == 1 for a, b in pairwise(frames))


def count_of(frames: list[Frame], name: str) -> int:
    return sum(frame.kind.name == name for frame in frames)


@pytest.mark.parametrize("step_s", [0.02, 7.0])
def test_clients_get_all_telemetry_in_order(core: Core, step_s: float) -> None:
    simulation, readers = connected(core, 2)
    while simulation.time_us < 42_000_000:
        simulation.advance(step_s)
        for reader in readers:
            reader.read()
    for reader in readers:
        frames = reader.frames()
        assert without_gap(frames)
        assert count_of(frames, "ATTITUDE") == simulation.time_us // 250_000
    simulation.close()


def test_one_who_does_not_read_misses_telemetry_and_holds_up_nobody(core: Core) -> None:
    simulation, (slow, quick) = connected(core, 2)
    for _ in range(400):
        simulation.advance(20.0)
        quick.read()
    frames = quick.frames()
    assert without_gap(frames) and count_of(frames, "ATTITUDE") == 4 * 8000
    for _ in range(50):
        slow.read()
        simulation.bridge.flush()
    late = slow.frames()
    assert without_gap(late) and 0 < count_of(late, "ATTITUDE") < 4 * 8000
    assert sum(map(len, slow.pieces)) < 4 * QUEUE_BYTES and not simulation.bridge.dropped
    simulation.close()


def test_one_who_leaves_is_forgotten_and_the_others_go_on(core: Core) -> None:
    simulation, (leaving, staying) = connected(core, 2)
    simulation.advance(5.0)
    leaving.socket.close()
    for _ in range(10):
        simulation.advance(5.0)
    assert len(simulation.bridge.channels) == 1 and len(simulation.bridge.dropped) == 1
    assert without_gap(staying.frames()) and count_of(staying.frames(), "ATTITUDE") == 4 * 55
    simulation.close()


def test_datagrams_hold_whole_frames(core: Core) -> None:
    simulation = Simulation(core=core)
    link = UdpInLink()
    simulation.bridge.add_link(link)
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.connect(link.local_address)
    reader = Reader(simulation, sock)
    for _ in range(10):
        simulation.advance(2.0)
        reader.read()
    assert without_gap(reader.frames()) and count_of(reader.frames(), "ATTITUDE") == 4 * 20
    for datagram in reader.pieces:
        assert len(datagram) <= DATAGRAM_BYTES
        assert sum(len(frame.raw) for frame in Splitter().feed(datagram)) == len(datagram)
    simulation.close()


def test_udp_clients_are_streamed_to_from_their_beginning_and_after_a_reboot(core: Core) -> None:
    simulation = Simulation(core=core)
    link = UdpInLink()
    simulation.bridge.add_link(link)
    runner.stream_everything(simulation, link, 5)
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.connect(link.local_address)
    beat = message("HEARTBEAT")
    heard = simulation.bridge.received
    sock.send(encode_v2(beat, beat.payload(), 0, 255, 190))  # a client that asks for nothing
    while simulation.bridge.received == heard:
        simulation.bridge.wait(5.0)
        simulation.bridge.receive()
    sock.setblocking(False)
    for _ in range(2):
        pieces = list[bytes]()
        for _ in range(10):
            simulation.advance(1.0)
            while data := received(sock):
                pieces.append(data)
        frames = list(Splitter().feed(b"".join(pieces)))
        for name in ("ATTITUDE", "GPS_RAW_INT", "VFR_HUD", "SYS_STATUS"):
            assert count_of(frames, name) == 50, name
        simulation.request_reboot()
        simulation.advance(0.0)
    simulation.close()


def received(sock: socket.socket) -> bytes:
    """A datagram; nothing when there is none."""
    try:
        return sock.recv(1 << 16)
    except BlockingIOError:
        return b""


class StepByStep:
    """A tap that looks at every frame, and a logger that takes every sample itself."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation, self.logger = simulation, simulation.logger
        simulation.bridge.taps.append(self)
        simulation.logger = self
        self.frames = 0

    def frame(self, time_us: int, raw: bytes) -> None:
        self.frames += 1

    def before_run(self, in_core: bool) -> tuple[int, int]:
        assert self.logger is not None
        return self.logger.before_run(False)

    def after_run(self) -> None:
        assert self.logger is not None
        self.logger.after_run()


def logged(folder: Path, frame: str, step_s: float, step_by_step: bool) -> tuple[Path, Simulation]:
    """Logs of a vehicle that is armed, moves, and is disarmed again, with a client in the process."""
    simulation = Simulation(frame, seed=3, estimator="truth", params={"LOG_BITMASK": 0x7FFFF})
    folder.mkdir()
    log = runner.open_log(simulation, folder, "run")
    if step_by_step:
        StepByStep(simulation)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    flies = simulation.kind.flies

    def go_on(to_s: float) -> None:
        while simulation.time_us < to_s * 1e6:
            simulation.advance_to(min(simulation.time_us + round(step_s * 1e6), round(to_s * 1e6)))

    go_on(40.0)
    client.command(176, 1, 4 if flies else 15)
    client.command(400, 1)
    client.command(22, 0, 0, 0, 0, 0, 0, 5)
    go_on(160.0)
    assert simulation.v.autopilot.arming.armed or not flies
    client.command(176, 1, 9 if flies else 4)
    go_on(180.0)
    client.command(400, 0)
    go_on(200.0)
    client.command(400, 1)
    go_on(210.0)
    simulation.close()
    return log, simulation


@pytest.mark.parametrize("frame", ["erle_copter", "erle_rover"])
def test_logs_do_not_depend_on_how_far_the_core_goes(frame: str, tmp_path: Path) -> None:
    log, simulation = logged(tmp_path / "long", frame, 30.0, False)
    same, _ = logged(tmp_path / "short", frame, 0.05, True)
    assert log.with_suffix(".bin").stat().st_size > 100_000
    for ending in (".tlog", ".bin"):
        assert log.with_suffix(ending).read_bytes() == same.with_suffix(ending).read_bytes()
    splitter, epoch_ms = Splitter(), simulation.bridge.epoch_us // 1000
    stamps = [(stamp, frame) for stamp, raw in read_tlog(log) for frame in splitter.feed(raw)]
    of_vehicle = [frame for _, frame in stamps if frame.component == 1]
    assert without_gap(of_vehicle)
    for stamp, frame_then in stamps:
        if frame_then.kind.name == "ATTITUDE":
            assert frame_then.kind.decode(frame_then.payload).time_boot_ms == stamp // 1000 - epoch_ms


def test_a_log_holds_once_what_each_client_is_answered(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    log = runner.open_log(simulation, tmp_path, "run")
    first, second = Endpoint(), Endpoint(system=254)
    for client in (first, second):
        simulation.bridge.add_link(client.link)
    simulation.advance(2.0)
    first.send("PARAM_REQUEST_LIST", target_system=1, target_component=1)
    for client in (first, second):
        client.send("PARAM_REQUEST_READ", target_system=1, target_component=1, param_index=-1, param_id=b"RTL_ALT")
        client.command(512, message("AUTOPILOT_VERSION").id)
        client.command(512, message("SCALED_PRESSURE").id)
        client.send("MISSION_REQUEST_LIST", target_system=1, target_component=1)
        client.send("MISSION_REQUEST_INT", target_system=1, target_component=1, seq=5)  # refused by a MISSION_ACK
    simulation.advance(5.0)
    first.send("PARAM_SET", target_system=1, target_component=1, param_id=b"RTL_ALT", param_value=2200.0, param_type=9)
    simulation.advance(5.0)
    simulation.close()
    answers = {"PARAM_VALUE", "AUTOPILOT_VERSION", "COMMAND_ACK", "MISSION_COUNT", "MISSION_ACK"}
    told = [[m for m in client.receive() if m.name in answers] for client in (first, second)]
    assert {m.name for m in told[1]} == answers
    splitter = Splitter()
    logged = [f for _, raw in read_tlog(log) for f in splitter.feed(raw) if (f.system, f.component) == (1, 1)]
    assert without_gap(logged)
    for name in answers:
        of_clients = sum(m.name == name for one in told for m in one)
        assert count_of(logged, name) == of_clients - (name == "PARAM_VALUE"), name  # one was sent to both
    assert count_of(logged, "SCALED_PRESSURE") >= 2
    read = mavutil.mavlink_connection(str(log))
    while read.recv_match() is not None:
        pass
    assert read.params["RTL_ALT"] == 2200.0 and len(read.params) == len(simulation.bridge.vehicle.parameters.listed())
