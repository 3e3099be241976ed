# SPDX-License-Identifier: BSD-3-Clause
"""Folders and files by MAVLink FTP: what ArduPilot's serves, in its form."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from typing import NamedTuple

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.mission import FENCE, MissionService
from sitl.bridge.services.parameters import ParameterService
from tests.bridge.fakes import Bench
from tests.bridge.test_parameters import ACK, BURST, NAK, OPEN, READ, fetch, request, unpack

TERMINATE, LIST, CREATE, WRITE, CRC = 1, 3, 6, 7, 14
INVALID_SIZE, END_OF_FILE, NOT_FOUND = 3, 6, 10
WAYPOINT, POLYGON = 16, 5001


class Entry(NamedTuple):
    number: int
    time_utc: int
    size: int


class Logs:
    """A store with logs of these contents."""

    def __init__(self, contents: Sequence[bytes]) -> None:
        self.contents = contents

    def entries(self) -> Sequence[Entry]:
        return [Entry(k, 0, len(content)) for k, content in enumerate(self.contents, 1)]

    def read(self, number: int, offset: int, count: int) -> bytes:
        return self.contents[number - 1][offset : offset + count]

    def erase(self) -> None:
        self.contents = ()

    def close(self) -> None:
        pass


class Counted(Logs):
    """Notes how much of a log is asked for."""

    def __init__(self, contents: Sequence[bytes]) -> None:
        super().__init__(contents)
        self.asked: list[int] = []

    def read(self, number: int, offset: int, count: int) -> bytes:
        self.asked.append(count)
        return super().read(number, offset, count)


def listed(bench: Bench, path: bytes) -> list[str]:
    """All entries of a folder, a packet after the other."""
    found: list[str] = []
    while True:
        (answer,) = bench.ask(request(LIST, path, offset=len(found)))
        head, data = unpack(answer)
        if head[2] == NAK:
            assert data == bytes((END_OF_FILE,))
            return found
        assert head[2] == ACK
        found += data.decode().rstrip("\0").split("\0")


def refusal(bench: Bench, path: bytes) -> int:
    (answer,) = bench.ask(request(LIST, path))
    head, data = unpack(answer)
    assert head[2] == NAK
    return data[0]


def test_folders_are_listed(bench: Bench) -> None:
    assert listed(bench, b"/") == ["D.", "D..", "D@SYS"]
    system = listed(bench, b"@SYS")
    assert [entry.split("\t")[0] for entry in system] == ["Fuarts.txt", "Ftasks.txt"]
    assert listed(bench, b"/@SYS/") == system
    assert [refusal(bench, path) for path in (b"nothing", b"@MISSION", b"logs", b"")] == [NOT_FOUND] * 3 + [
        INVALID_SIZE
    ]


def test_logs_are_listed_and_read(bench: Bench) -> None:
    contents = [bytes(range(256)) * k for k in range(1, 41)]
    bench.bridge.logs = Logs(contents)
    assert "Dlogs" in listed(bench, b"/")
    assert listed(bench, b"logs") == [f"F{k:08d}.BIN\t{256 * k}" for k in range(1, 41)]  # several packets
    assert fetch(bench, b"logs/00000003.BIN") == contents[2]
    (answer,) = bench.ask(request(CRC, b"logs/00000002.BIN"))
    own = zlib.crc32(contents[1], 0xFFFFFFFF) ^ 0xFFFFFFFF
    assert unpack(answer)[1] == struct.pack("<I", own)


def test_missions_are_read_as_files(bench: Bench) -> None:
    head = struct.Struct("<HHHHH")
    empty = fetch(bench, b"@MISSION/mission.dat")
    assert head.unpack_from(empty) == (0x763D, 0, 0, 0, 1) and len(empty) == head.size + 38, "home alone"
    items = tuple(
        MissionItem(POLYGON, 0, 3.0, 0.0, 0.0, 0.0, lat, 1491652370, 0.0, 1)
        for lat in (-353632620, -353630000, -353620000)
    )
    bench.bridge.get(MissionService)._replace(FENCE, items)
    fence = fetch(bench, b"@MISSION/fence.dat")
    assert head.unpack_from(fence) == (0x763D, FENCE, 0, 0, 3) and len(fence) == head.size + 3 * 38
    fields = [struct.unpack_from("<4fiifHHBBBBBB", fence, head.size + 38 * k) for k in range(3)]
    assert [(f[4], f[7], f[8], f[13]) for f in fields] == [(item.x, k, POLYGON, FENCE) for k, item in enumerate(items)]
    assert fetch(bench, b"@MISSION/rally.dat") == head.pack(0x763D, 2, 0, 0, 0)


def put(bench: Bench, path: bytes, data: bytes) -> list[int]:
    """Write a file in pieces; results of the answers."""
    steps = [request(CREATE, path)]
    steps += [request(WRITE, data[at : at + 90], offset=at) for at in range(0, len(data), 90)]
    steps.append(request(TERMINATE))
    answers = [answer for step in steps for answer in bench.ask(step, "FILE_TRANSFER_PROTOCOL")]
    return [unpack(answer)[0][2] for answer in answers]


def test_missions_are_taken_as_files(bench: Bench) -> None:
    places = ((-353632620, 0.0), (-353630000, 15.0), (-353620000, 20.0), (-353610000, 20.0), (-353600000, 20.0))
    items = tuple(MissionItem(WAYPOINT, 3, 0.0, 0.0, 0.0, 0.0, lat, 1491652370, z, 1) for lat, z in places)
    service = bench.bridge.get(MissionService)
    service._replace(0, items)
    written = fetch(bench, b"@MISSION/mission.dat")
    service._replace(0, ())
    assert put(bench, b"@MISSION/mission.dat", written) == [ACK] * 5
    assert fetch(bench, b"@MISSION/mission.dat") == written
    for bad in (written[:-1], b"\0" * 10, written.replace(struct.pack("<H", WAYPOINT), struct.pack("<H", 9999))):
        assert put(bench, b"@MISSION/mission.dat", bad)[-1] == NAK
        assert fetch(bench, b"@MISSION/mission.dat") == written, "the old one stays"
    assert put(bench, b"@SYS/uarts.txt", b"x")[0] == NAK


def test_the_links_are_told(bench: Bench) -> None:
    first, *lines = fetch(bench, b"@SYS/uarts.txt").decode().splitlines()
    assert first == "UARTV1" and len(lines) == len(bench.bridge.channels) and lines[0].startswith("SERIAL0 TX=")


def test_the_answer_to_a_repeated_request_is_sent_again(bench: Bench) -> None:
    """A request with the number of the last one was not answered, as far as its client knows."""
    path = b"@MISSION/mission.dat"
    bench.autopilot.items = (MissionItem(WAYPOINT),) * 2
    mission = fetch(bench, path)
    bench.run(2.0)
    bench.client.receive()
    create, end = request(CREATE, path, sequence=101), request(TERMINATE, sequence=104)
    (answer,) = bench.ask(create)
    assert bench.ask(create)[0].payload == answer.payload
    bench.ask(request(WRITE, mission, sequence=102))
    assert not bench.ask(create)  # a late copy: nothing is created anew
    bench.ask(request(WRITE, b"", offset=len(mission), sequence=103))
    ended = bench.ask(end, "FILE_TRANSFER_PROTOCOL")[0]
    assert unpack(ended)[0][2] == ACK and len(bench.autopilot.items) == 2
    bench.autopilot.items = ()
    assert bench.ask(end)[0].payload == ended.payload and bench.autopilot.items == ()  # taken once
    bench.run(2.0)
    bench.client.receive()
    assert bench.ask(request(CREATE, path, sequence=100))  # a client that counts from another number


def test_parameters_are_packed_when_one_changes_and_not_for_every_request(bench: Bench) -> None:
    service = bench.bridge.get(ParameterService)
    first = service.packed(False)
    assert service.packed(False) is first
    assert service.packed(True) is service.packed(True) is not first
    bench.vehicle.v.autopilot.params.WPNAV.SPEED = 437.0  # by the core, which tells nobody
    second = service.packed(False)
    assert second is not first and struct.pack("<f", 437.0) in second
    bench.vehicle.parameters["WPNAV_SPEED"] = 1e9  # out of range: kept beside the record
    third = service.packed(False)
    assert third is not second and struct.pack("<f", 1e9) in third
    (answer,) = bench.ask(request(CRC, b"@PARAM/param.pck"))
    (again,) = bench.ask(request(CRC, b"@PARAM/param.pck", sequence=20))
    own = struct.pack("<I", zlib.crc32(third, 0xFFFFFFFF) ^ 0xFFFFFFFF)
    assert unpack(answer)[1] == unpack(again)[1] == own


def test_a_log_is_read_in_pieces_and_not_whole_when_it_is_opened(bench: Bench) -> None:
    logs = bench.bridge.logs = Counted([bytes(1000) + bytes(range(256)) * 10])
    (answer,) = bench.ask(request(OPEN, b"logs/00000001.BIN"))
    assert unpack(answer)[1] == struct.pack("<I", 3560) and logs.asked == []
    (answer,) = bench.ask(request(READ, b"", offset=1000))
    assert unpack(answer)[1][:4] == bytes(range(4)) and max(logs.asked) <= 239
    for sequence in (20, 30):
        bench.ask(request(CRC, b"logs/00000001.BIN", sequence=sequence))
    assert logs.asked.count(3560) == 1, "summed up once"


def test_a_burst_of_a_log_that_is_erased_ends(bench: Bench) -> None:
    logs = bench.bridge.logs = Counted([bytes(100_000)])
    bench.ask(request(OPEN, b"logs/00000001.BIN"))
    logs.contents = [b""]
    bench.client.send(request(BURST, size=239))
    bench.run(0.2)
    answers = bench.client.receive("FILE_TRANSFER_PROTOCOL")
    assert [unpack(answer)[0][5] for answer in answers] == [1], "one packet, the last"
