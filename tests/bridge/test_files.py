# SPDX-License-Identifier: BSD-3-Clause
"""Folders and files by MAVLink FTP: what ArduPilot's serves, in its form."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from typing import NamedTuple

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.mission import FENCE, MissionService
from tests.bridge.fakes import Bench
from tests.bridge.test_parameters import ACK, NAK, fetch, request, unpack

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
