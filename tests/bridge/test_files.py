# SPDX-License-Identifier: BSD-3-Clause
"""Folders and files by MAVLink FTP: what ArduPilot's serves, in its form."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from itertools import count
from typing import NamedTuple

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services import served_files
from sitl.bridge.services.ftp import MOST_WRITTEN, FtpService
from sitl.bridge.services.mission_protocol import MissionService
from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.core.mavlink import MavMissionType
from tests.bridge.fakes import Bench
from tests.bridge.test_parameters import ACK, BURST, NAK, OPEN, READ, fetch, request, unpack

TERMINATE, LIST, CREATE, WRITE, CRC = 1, 3, 6, 7, 14
INVALID_SIZE, END_OF_FILE, NOT_FOUND = 3, 6, 10
SEQUENCES = count(1000)
"""Each request has a number of its own: one that comes again is a copy."""
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
    names = "threads tasks dma memory uarts timers can_log can0_stats can1_stats"
    assert [entry.split("\t")[0] for entry in system[:9]] == [f"F{name}.txt" for name in names.split()]
    assert system[9:] == ["Fcrash_dump.bin\t100000", "Fstorage.bin\t16384"] and system[1] == "Ftasks.txt\t8"
    assert listed(bench, b"/@SYS/") == system
    assert [refusal(bench, path) for path in (b"nothing", b"@MISSION", b"logs", b"")] == [NOT_FOUND] * 3 + [
        INVALID_SIZE
    ]


def told(bench: Bench, opcode: int, path: bytes, **more: int) -> int:
    """The error that a request gets, 0: none."""
    (answer,) = bench.ask(request(opcode, path, sequence=next(SEQUENCES), **more))
    head, data = unpack(answer)
    return 0 if head[2] == ACK else data[0]


def test_clients_make_files_and_folders(bench: Bench) -> None:
    assert told(bench, 9, b"/notes") == 0 and told(bench, 9, b"notes") == 8, "there is one"
    assert told(bench, 6, b"notes/a.txt") == 0
    assert (told(bench, 7, b"hello", offset=0), told(bench, 7, b"!", offset=7), told(bench, 1, b"")) == (0, 0, 0)
    assert listed(bench, b"/") == ["D.", "D..", "D@SYS", "Dnotes"]
    assert listed(bench, b"/notes/") == ["D.", "D..", "Fa.txt\t8"]
    assert fetch(bench, b"notes/a.txt") == b"hello\0\0!"
    assert told(bench, 11, b"notes/a.txt") == told(bench, 7, b"J", offset=0) == 0 == told(bench, 1, b"")
    assert told(bench, 13, b"notes/a.txt\0b.txt") == 0 and fetch(bench, b"b.txt") == b"Jello\0\0!"
    assert told(bench, 13, b"notes\0papers") == 0 and told(bench, 13, b"b.txt\0papers/b.txt") == 0
    state = bench.bridge.snapshot()
    assert told(bench, 10, b"papers") == 1, "not empty"
    assert told(bench, 8, b"papers/b.txt") == 0 and told(bench, 10, b"papers") == 0
    assert listed(bench, b"/") == ["D.", "D..", "D@SYS"]
    bench.bridge.restore(state)
    assert listed(bench, b"papers") == ["D.", "D..", "Fb.txt\t8"]


@pytest.mark.parametrize(("opcode", "path", "error"), [
    (6, b"none/a.txt", 10), (6, b"@SYS/a.txt", 9), (6, b"logs/1.BIN", 9), (6, b"../a.txt", 1), (6, b"", 3),
    (9, b"..", 1), (9, b"a/../b", 1), (9, b"@PARAM", 9), (9, b"x" * 201, 1),
    (8, b"none", 10), (8, b"@SYS/tasks.txt", 9), (8, b"logs/1.BIN", 9), (10, b"logs", 9), (10, b"none", 10),
    (11, b"none", 10), (13, b"none\0a", 10), (13, b"one", 3), (13, b"@SYS/tasks.txt\0a", 9),
])  # fmt: skip
def test_what_is_not_a_clients_stays(bench: Bench, opcode: int, path: bytes, error: int) -> None:
    before = listed(bench, b"/")
    assert told(bench, opcode, path) == error
    assert listed(bench, b"/") == before


def test_clients_files_have_room_for_a_megabyte(bench: Bench) -> None:
    store = bench.bridge.get(FtpService)._clients
    assert store.create("a") == store.create("b") == 0
    assert store.write("a", bytes(1 << 19)) == store.write("b", bytes(1 << 19)) == 0
    assert store.write("b", bytes((1 << 19) + 1)) == 1 and store.write("a", b"") == 0
    assert store.make_folder("c") == store.create("c/a") == 0
    assert store.rename("c", "c/d") == store.rename("c", "a") == store.create("c") == store.remove("c") == 1
    for k in range(996):
        assert store.make_folder(str(k)) == 0
    assert store.create("more") == 1 and store.create("a") == 0


def test_logs_are_listed_and_read(bench: Bench) -> None:
    contents = [bytes(range(256)) * k for k in range(1, 41)]
    bench.bridge.logs = Logs(contents)
    assert "Dlogs" in listed(bench, b"/")
    assert listed(bench, b"logs") == [f"F{k:08d}.BIN\t{256 * k}" for k in range(1, 41)]  # several packets
    assert fetch(bench, b"logs/00000003.BIN") == contents[2]
    (answer,) = bench.ask(request(CRC, b"logs/00000002.BIN"))
    own = zlib.crc32(contents[1], 0xFFFFFFFF) ^ 0xFFFFFFFF
    assert unpack(answer)[1] == struct.pack("<I", own)
    for path in (b"logs/00000041.BIN", b"logs/00000000.BIN", b"logs/3.BIN", b"none"):
        assert told(bench, OPEN, path) == NOT_FOUND


def test_missions_are_read_as_files(bench: Bench) -> None:
    head = struct.Struct("<HHHHH")
    empty = fetch(bench, b"@MISSION/mission.dat")
    assert head.unpack_from(empty) == (0x763D, 0, 0, 0, 1) and len(empty) == head.size + 38, "home alone"
    items = tuple(
        MissionItem(POLYGON, 0, 3.0, 0.0, 0.0, 0.0, lat, 1491652370, 0.0, 1)
        for lat in (-353632620, -353630000, -353620000)
    )
    bench.bridge.get(MissionService)._replace(MavMissionType.FENCE, items)
    fence = fetch(bench, b"@MISSION/fence.dat")
    assert head.unpack_from(fence) == (0x763D, MavMissionType.FENCE, 0, 0, 3) and len(fence) == head.size + 3 * 38
    fields = [struct.unpack_from("<4fiifHHBBBBBB", fence, head.size + 38 * k) for k in range(3)]
    assert [(f[4], f[7], f[8], f[13]) for f in fields] == [
        (item.x, k, POLYGON, MavMissionType.FENCE) for k, item in enumerate(items)
    ]
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


def test_what_is_beyond_the_end_of_a_file_is_its_end(bench: Bench) -> None:
    assert told(bench, 6, b"a.txt") == told(bench, WRITE, b"hello") == 0
    for opcode in (READ, BURST):
        assert told(bench, opcode, b"", offset=5, size=10) == END_OF_FILE
    (answer,) = bench.ask(request(READ, offset=4, size=10, sequence=next(SEQUENCES)))
    assert unpack(answer)[1][:1] == b"o"


def test_a_file_that_is_read_is_not_written_and_none_is_summed_that_is_not_there(bench: Bench) -> None:
    assert told(bench, OPEN, b"@SYS/tasks.txt") == 0 and told(bench, WRITE, b"x") == 1
    assert told(bench, CRC, b"none") == NOT_FOUND and told(bench, CRC, b"@SYS/tasks.txt") == 0
    for opcode in (ACK, NAK):
        assert not bench.ask(request(opcode, b"", sequence=next(SEQUENCES))), "answers are not answered"


def test_a_file_is_no_longer_than_what_may_be_written(bench: Bench) -> None:
    assert told(bench, 6, b"a.bin") == 0
    assert told(bench, WRITE, b"x", offset=MOST_WRITTEN - 1) == 0
    assert told(bench, WRITE, b"x", offset=MOST_WRITTEN) == 1


def test_a_file_without_points_takes_all_of_them_away(bench: Bench) -> None:
    """A header alone is a whole file; less is none, and so is one that counts other points than it has."""
    head = struct.Struct("<HHHHH")
    service = bench.bridge.get(MissionService)
    rally = head.pack(0x763D, 2, 0, 0, 0)
    assert served_files.write(bench.bridge, "@MISSION/rally.dat", rally)
    assert not served_files.write(bench.bridge, "@MISSION/rally.dat", rally[:-1])
    for bad in (
        (0x763C, 2, 0, 0, 0),
        (0x763D, 1, 0, 0, 0),
        (0x763D, 2, 1, 0, 0),
        (0x763D, 2, 0, 1, 0),
        (0x763D, 2, 0, 0, 1),
    ):
        assert not served_files.write(bench.bridge, "@MISSION/rally.dat", head.pack(*bad)), bad
    assert not served_files.write(bench.bridge, "@MISSION/rally.dat", rally + bytes(38))
    assert service.items(MavMissionType.RALLY) == ()
