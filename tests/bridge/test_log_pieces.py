# SPDX-License-Identifier: BSD-3-Clause
"""Logs over MAVLink from a store of known bytes: what is listed, how pieces are cut, which request replaces which."""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import Bench

ALL = 0xFFFFFFFF


class Entry(NamedTuple):
    number: int
    time_utc: int
    size: int


class Store:
    """Logs whose bytes are their positions."""

    def __init__(self, *sizes: int) -> None:
        self.sizes = list(sizes)
        self.reads: list[tuple[int, int, int]] = []
        self.erased = 0

    def entries(self) -> list[Entry]:
        return [Entry(k, 1000 + k, size) for k, size in enumerate(self.sizes, 1)]

    def read(self, number: int, offset: int, count: int) -> bytes:
        self.reads.append((number, offset, count))
        return bytes(k % 251 for k in range(offset, min(offset + count, self.sizes[number - 1])))

    def erase(self) -> None:
        self.erased += 1
        self.sizes = []

    def close(self) -> None:
        pass


@pytest.fixture
def logs(bench: Bench) -> Store:
    store = Store(200, 10_000, 90)
    bench.bridge.logs = store  # type: ignore[assignment]
    bench.run(1.0)
    bench.client.receive()
    return store


def listed(bench: Bench, start: int, end: int) -> list[tuple[int, ...]]:
    found = bench.ask(mavlink.MAVLink_log_request_list_message(1, 1, start, end), "LOG_ENTRY")
    return [(m.id, m.num_logs, m.last_log_num, m.time_utc, m.size) for m in found]


def ask(bench: Bench, number: int, offset: int, count: int) -> list[Any]:
    return bench.ask(mavlink.MAVLink_log_request_data_message(1, 1, number, offset, count), "LOG_DATA")


def pieces(bench: Bench, seconds: float = 1.0) -> list[tuple[int, int, int]]:
    bench.run(seconds)
    bench.bridge.flush()
    return [(m.id, m.ofs, m.count) for m in bench.client.receive("LOG_DATA")]


@pytest.mark.parametrize(
    ("start", "end", "numbers", "last"),
    [(0, 65535, [1, 2, 3], 3), (1, 3, [1, 2, 3], 3), (2, 2, [2], 2), (3, 9, [3], 3), (0, 1, [1], 1)],
)
def test_logs_that_are_asked_for_are_listed(
    bench: Bench, logs: Store, start: int, end: int, numbers: list[int], last: int
) -> None:
    assert listed(bench, start, end) == [(n, 3, last, 1000 + n, logs.sizes[n - 1]) for n in numbers]


@pytest.mark.parametrize(("start", "end"), [(4, 9), (3, 2), (0, 0)])
def test_none_of_them_is_one_entry_that_tells_how_many_there_are(
    bench: Bench, logs: Store, start: int, end: int
) -> None:
    assert listed(bench, start, end) == [(0, 3, 0, 0, 0)]
    bench.bridge.logs = None
    assert listed(bench, 0, 65535) == [(0, 0, 0, 0, 0)]


@pytest.mark.parametrize(
    ("number", "offset", "count", "sent"),
    [
        (1, 0, ALL, [(0, 90), (90, 90), (180, 20)]),
        (1, 0, 90, [(0, 90)]),
        (1, 0, 91, [(0, 90), (90, 1)]),
        (1, 5, 100, [(5, 90), (95, 10)]),
        (1, 199, 90, [(199, 1)]),
        (3, 0, ALL, [(0, 90)]),  # its end: no more is asked for than was listed
    ],
)
def test_pieces_of_a_log(
    bench: Bench, logs: Store, number: int, offset: int, count: int, sent: list[tuple[int, int]]
) -> None:
    assert ask(bench, number, offset, count) == [], "they come with time"
    assert pieces(bench) == [(number, at, length) for at, length in sent]
    assert pieces(bench) == []


def test_the_bytes_are_those_of_the_log(bench: Bench, logs: Store) -> None:
    ask(bench, 2, 1000, 200)
    bench.run(0.1)
    bench.bridge.flush()
    got = b"".join(bytes(m.data[: m.count]) for m in bench.client.receive("LOG_DATA"))
    assert got == bytes(k % 251 for k in range(1000, 1200))


@pytest.mark.parametrize(("number", "offset", "count"), [(1, 200, 90), (1, 201, 90), (4, 0, 90), (0, 0, 90), (1, 0, 0)])
def test_nothing_to_send_is_answered_at_once_with_no_bytes(
    bench: Bench, logs: Store, number: int, offset: int, count: int
) -> None:
    (m,) = ask(bench, number, offset, count)
    assert (m.id, m.ofs, m.count) == (number, offset, 0)
    assert logs.reads == []


def test_twenty_pieces_each_two_and_a_half_milliseconds(bench: Bench, logs: Store) -> None:
    ask(bench, 2, 0, ALL)
    assert len(pieces(bench, 0.0025)) == 20
    assert len(pieces(bench, 0.0025)) == 20
    assert len(pieces(bench, 0.01)) == 72, "10 000 bytes are 112 pieces"
    assert logs.reads[0] == (2, 0, 1800)


def test_a_log_that_grows_is_sent_up_to_the_size_that_was_told(bench: Bench, logs: Store) -> None:
    listed(bench, 0, 65535)
    logs.sizes[0] = 500
    ask(bench, 1, 0, ALL)
    assert pieces(bench)[-1] == (1, 180, 20)
    listed(bench, 0, 65535)
    ask(bench, 1, 0, ALL)
    assert pieces(bench)[-1] == (1, 450, 50)


def test_a_log_that_was_cut_meanwhile_ends_with_a_short_piece(bench: Bench, logs: Store) -> None:
    listed(bench, 0, 65535)
    logs.sizes[1] = 180
    ask(bench, 2, 0, ALL)
    assert pieces(bench) == [(2, 0, 90), (2, 90, 90), (2, 180, 0)]


def test_a_large_request_replaces_what_is_under_way(bench: Bench, logs: Store) -> None:
    ask(bench, 2, 0, ALL)
    ask(bench, 1, 0, 1801)
    assert [number for number, _, _ in pieces(bench)] == [1, 1, 1]


def test_small_requests_come_one_after_the_other_before_a_large_one(bench: Bench, logs: Store) -> None:
    """A client fills gaps by them."""
    ask(bench, 2, 0, ALL)
    for offset in (90, 0, 90):
        ask(bench, 1, offset, 90)
    found = pieces(bench)
    assert found[:2] == [(1, 90, 90), (1, 0, 90)], "the same once more is one request"
    assert found[2] == (2, 0, 90) and len(found) == 2 + 112


def test_1800_bytes_are_small(bench: Bench, logs: Store) -> None:
    ask(bench, 2, 0, 1800)
    ask(bench, 2, 5000, 1800)
    assert len(pieces(bench)) == 40
    ask(bench, 2, 0, 1801)
    ask(bench, 2, 5000, 1801)
    assert pieces(bench)[0] == (2, 5000, 90)


def test_no_more_than_128_requests_wait(bench: Bench, logs: Store) -> None:
    for k in range(130):
        ask(bench, 2, k, 90)
    assert [offset for _, offset, _ in pieces(bench)] == list(range(128))


def test_the_end_of_a_download_and_of_all_logs(bench: Bench, logs: Store) -> None:
    ask(bench, 2, 0, ALL)
    bench.ask(mavlink.MAVLink_log_request_end_message(1, 1))
    assert pieces(bench) == [] and logs.erased == 0
    ask(bench, 2, 0, ALL)
    bench.ask(mavlink.MAVLink_log_erase_message(1, 1))
    assert pieces(bench) == [] and logs.erased == 1
    logs.sizes = [10, 50]  # a new one has the number of one that was erased
    assert [(m.ofs, m.count) for m in ask(bench, 2, 50, ALL)] == [(50, 0)]
    ask(bench, 2, 0, ALL)
    assert pieces(bench) == [(2, 0, 50)]
    logs.sizes = []
    assert listed(bench, 0, 65535) == [(0, 0, 0, 0, 0)]
    bench.bridge.logs = None
    bench.ask(mavlink.MAVLink_log_erase_message(1, 1))


def test_each_client_has_its_own_download(bench: Bench, logs: Store) -> None:
    other = bench.connect(system=254)
    ask(bench, 1, 0, ALL)
    other.send(mavlink.MAVLink_log_request_data_message(1, 1, 3, 0, ALL))
    bench.bridge.receive()
    other.send(mavlink.MAVLink_log_request_end_message(1, 1))
    bench.bridge.receive()
    assert len(pieces(bench)) == 3 and other.receive("LOG_DATA") == []


def test_a_snapshot_goes_on_with_a_download(bench: Bench, logs: Store) -> None:
    listed(bench, 0, 65535)
    ask(bench, 2, 0, ALL)
    bench.run(0.0025)
    kept, time_us = bench.bridge.snapshot(), int(bench.vehicle.v.time_us)
    logs.sizes[1] = 20_000
    rest = pieces(bench)
    bench.bridge.restore(kept)
    bench.vehicle.v.time_us = time_us
    assert pieces(bench)[-92:] == rest[-92:] and rest[-1] == (2, 9990, 10)
