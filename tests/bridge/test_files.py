# SPDX-License-Identifier: BSD-3-Clause
"""Folders and files by MAVLink FTP: what ArduPilot's serves, in its form."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from itertools import count
from typing import Any, NamedTuple

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services import served_files
from sitl.bridge.services.client_files import ClientFiles, State
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


def answers(bench: Bench, *asked: object) -> list[tuple[tuple[int, ...], bytes]]:
    """Heads and data of the answers to requests, without time passing."""
    return [unpack(m) for each in asked for m in bench.ask(each, "FILE_TRANSFER_PROTOCOL")]


def test_answers_name_what_they_answer(bench: Bench) -> None:
    """The number after the request's, its session, how many bytes, its opcode, its offset; numbers end at 65535."""
    assert answers(bench, request(0, sequence=65535, session=9)) == [((0, 9, ACK, 0, 0, 0, 0, 0), b"")]
    assert answers(bench, request(CREATE, b"a", sequence=1)) == [((2, 0, ACK, 0, CREATE, 0, 0, 0), b"")]
    (written,) = answers(bench, request(WRITE, b"hello", offset=300, sequence=2))
    assert written == ((3, 0, ACK, 4, WRITE, 0, 0, 300), struct.pack("<I", 5))
    (piece,) = answers(bench, request(READ, offset=10, size=0, sequence=3))
    assert piece == ((4, 0, ACK, 239, READ, 0, 0, 10), bytes(239)), "as much as there is room for"
    assert answers(bench, request(TERMINATE, offset=7, sequence=4)) == [((5, 0, ACK, 0, TERMINATE, 0, 0, 7), b"")]
    (names,) = answers(bench, request(LIST, b"/", offset=2, sequence=5))
    assert names == ((6, 0, ACK, 13, LIST, 0, 0, 2), b"D@SYS\0Fa\t305\0")
    assert answers(bench, request(15, size=10, sequence=6, session=3)) == [((7, 3, NAK, 1, 15, 0, 0, 0), b"\x04")]


@pytest.mark.parametrize(("size", "error"), [(239, 10), (240, 3)])
def test_no_request_has_more_than_239_bytes(bench: Bench, size: int, error: int) -> None:
    assert told(bench, OPEN, b"none", size=size) == error


def test_a_packet_of_a_list_is_filled_up(bench: Bench) -> None:
    store = bench.bridge.get(FtpService)._clients
    store.make_folder("n")
    for letter in "abc":
        store.create("n/" + letter * 112)
    (found,) = answers(bench, request(LIST, b"n"))
    assert found[0][3] == 239 and found[1].count(b"\0") == 4
    store.rename("n/" + "b" * 112, "n/" + "b" * 113)
    (found,) = answers(bench, request(LIST, b"n", sequence=9))
    assert found[0][3] == 123 and found[1].count(b"\0") == 3


@pytest.mark.parametrize(
    ("behind", "seconds", "answered"),
    [(16, 0.0, 0), (17, 0.0, 1), (1, 0.0, 0), (1, 1.0, 0), (1, 1.0025, 1), (-1, 0.0, 1)],
)
@pytest.mark.parametrize("last", [1000, 3])
def test_copies_of_what_opens_a_file_come_shortly_behind(
    bench: Bench, behind: int, seconds: float, answered: int, last: int
) -> None:
    """At most a second late, and behind at most sixteen others."""
    answers(bench, request(0, sequence=last))
    bench.run(seconds)
    sequence = (last - behind) & 0xFFFF
    assert len(answers(bench, request(LIST, b"/", sequence=sequence))) == 1, "a list may be asked for again"
    bench.run(2.0)
    answers(bench, request(0, sequence=last))
    bench.run(seconds)
    bench.client.receive()
    assert len(answers(bench, request(CREATE, b"a", sequence=sequence))) == answered


def test_others_on_the_link_have_no_part_in_a_session(bench: Bench) -> None:
    assert told(bench, CREATE, b"a") == 0
    bench.client.mav.srcComponent = 191
    assert told(bench, READ, b"", size=5) == 4
    bench.client.mav.srcComponent = 190
    assert told(bench, WRITE, b"x") == 0


def test_what_is_reset_is_not_taken(bench: Bench) -> None:
    bench.autopilot.items = (MissionItem(WAYPOINT),) * 2
    mission = fetch(bench, b"@MISSION/mission.dat")
    bench.autopilot.items = ()
    for opcode, session, items in ((2, 5, 0), (TERMINATE, 0, 2)):
        steps = (request(CREATE, b"@MISSION/mission.dat", sequence=next(SEQUENCES)),
                 request(WRITE, mission, sequence=next(SEQUENCES)),
                 request(TERMINATE, session=5, sequence=next(SEQUENCES)),
                 request(opcode, session=session, sequence=next(SEQUENCES)),
                 request(WRITE, b"x", sequence=next(SEQUENCES)))  # fmt: skip
        assert [head[2] for head, _ in answers(bench, *steps)] == [ACK] * 4 + [NAK]
        assert len(bench.autopilot.items) == items, "a session of another number was not ended"


def burst(bench: Bench, seconds: float) -> list[tuple[int, int, int]]:
    """Number, offset and completion of the packets that come."""
    bench.run(seconds)
    heads = [unpack(m)[0] for m in bench.client.receive("FILE_TRANSFER_PROTOCOL")]
    return [(head[0], head[7], head[5]) for head in heads]


def test_a_burst_is_ten_packets_in_ten_milliseconds(bench: Bench) -> None:
    bench.bridge.logs = Logs([bytes(100 * 25)])
    bench.run(0.0025)
    answers(bench, request(OPEN, b"logs/00000001.BIN", sequence=1))
    ask = request(BURST, size=100, sequence=65530)
    for _ in range(2):  # one that is asked for again is no copy
        answers(bench, ask)
        assert burst(bench, 0.0025) == [((65531 + k) & 0xFFFF, 100 * k, 0) for k in range(10)]
        assert burst(bench, 0.0075) == []
        held = bench.bridge.snapshot()
        rest = [((65531 + k) & 0xFFFF, 100 * k, k == 24) for k in range(10, 25)]
        assert burst(bench, 0.0025) == rest[:10] and burst(bench, 0.0075) == []
        assert burst(bench, 0.0025) == rest[10:] and burst(bench, 1.0) == []
        bench.bridge.restore(held)
        assert burst(bench, 0.02) == rest
    answers(bench, request(BURST, sequence=30, offset=2499, size=0))
    assert burst(bench, 0.02) == [(31, 2499, 1)]


def test_a_burst_waits_for_a_client_that_does_not_read(bench: Bench) -> None:
    bench.bridge.logs = Logs([bytes(239)])
    answers(bench, request(OPEN, b"logs/00000001.BIN", sequence=1), request(BURST, sequence=2))
    type(bench.bridge.channels[0].peer).congested = property(lambda self: True)  # type: ignore[assignment]
    try:
        assert burst(bench, 1.0) == []
    finally:
        del type(bench.bridge.channels[0].peer).congested
    assert burst(bench, 0.01) == [(3, 0, 1)]


@pytest.mark.parametrize(("data", "error"), [(b"\0a", 3), (b"a\0", 3), (b"a\0/", 3), (b"a", 3), (b"a\0b", 0)])
def test_two_paths_are_needed_to_rename(bench: Bench, data: bytes, error: int) -> None:
    assert told(bench, CREATE, b"a") == 0
    assert told(bench, 13, data) == error


def test_a_file_has_at_most_a_megabyte(bench: Bench) -> None:
    assert told(bench, CREATE, b"a.bin\0rest") == 0
    assert told(bench, WRITE, b"x", offset=(1 << 20) - 1) == 0
    assert told(bench, WRITE, b"xy", offset=(1 << 20) - 1) == 1
    assert told(bench, WRITE, b"y", offset=0) == 0
    assert listed(bench, b"/")[-1] == "Fa.bin\t1048576"


def test_a_long_log_is_summed_up_in_pieces(bench: Bench) -> None:
    content = bytes(range(251)) * 10_000
    bench.bridge.logs = Logs([content])
    ((_, found),) = answers(bench, request(CRC, b"logs/00000001.BIN"))
    assert found == struct.pack("<I", zlib.crc32(content, 0xFFFFFFFF) ^ 0xFFFFFFFF)


@pytest.mark.parametrize(
    ("change", "arguments", "error"),
    [
        ("create", ("x" * 200,), 0), ("create", ("x" * 201,), 1), ("create", ("a//b",), 1), ("create", ("./b",), 1),
        ("create", ("a/",), 1), ("create", ("file",), 0), ("create", ("folder",), 1), ("create", ("none/b",), 10),
        ("create", ("logsx",), 0), ("create", ("logs",), 9), ("create", ("file/b",), 10), ("create", ("a@",), 0),
        ("make_folder", ("file",), 8), ("make_folder", ("folder",), 8), ("make_folder", ("folder/in/more",), 0),
        ("remove", ("folder",), 1), ("remove", ("file",), 0), ("remove", ("@a",), 9), ("remove", ("none",), 10),
        ("remove_folder", ("file",), 1), ("remove_folder", ("folder",), 1), ("remove_folder", ("folder/in",), 0),
        ("remove_folder", ("logs",), 9), ("write", ("none", b""), 10), ("write", ("folder", b""), 10),
        ("rename", ("file", "folder/in/b"), 0), ("rename", ("file", "folder"), 1), ("rename", ("file", "filer"), 0),
        ("rename", ("folder", "file"), 1), ("rename", ("folder", "folder/b"), 1), ("rename", ("folder", "folders"), 1),
        ("rename", ("folder", "fold"), 0), ("rename", ("file", "logs/a"), 9), ("rename", ("logs/a", "file"), 9),
    ],
)  # fmt: skip
def test_what_can_be_done_with_files_and_folders(change: str, arguments: tuple[Any, ...], error: int) -> None:
    store = ClientFiles()
    store.restore(State(("folder", "folder/in", "folders"), (("file", b"1"), ("folder/a", b"22"))))
    before = store.state()
    assert getattr(store, change)(*arguments) == error
    assert error == 0 or store.state() == before


def test_a_folder_takes_along_what_is_in_it_and_a_file_the_place_of_another() -> None:
    store = ClientFiles()
    store.restore(State(("a", "a/b", "ab"), (("a/b/c", b"1"), ("ab/c", b"22"), ("aa", b"333"))))
    assert store.rename("a", "d") == 0
    assert store.state() == State(("ab", "d", "d/b"), (("ab/c", b"22"), ("aa", b"333"), ("d/b/c", b"1")))
    assert store.rename("aa", "ab/c") == 0 and store.read("ab/c") == b"333" and store.read("aa") is None
    assert store.listing("d/b") == ["Fc\t1"] and store.listing("d") == ["Db"] and store.listing("e") is None
    assert store.listing("") == ["Dab", "Dd"]
