# SPDX-License-Identifier: BSD-3-Clause
"""Logs over MAVLink: listed, sent whole or in pieces, erased."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.client.endpoint import Endpoint
from sitl.simulation import Simulation
from tests.logs.dataflash.conftest import Run

ALL = 0xFFFFFFFF


@pytest.fixture
def run(tmp_path: Path) -> Run:
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(2.0)
    return run


def content(answers: list) -> dict[int, bytes]:
    return {m.ofs: bytes(m.data[: m.count]) for m in answers if hasattr(m, "ofs")}


def test_without_a_logger_there_are_no_logs() -> None:
    simulation, client = Simulation("erle_copter"), Endpoint()
    simulation.bridge.add_link(client.link)
    client.send("LOG_REQUEST_LIST", target_system=1, target_component=1, end=65535)
    client.send("LOG_REQUEST_DATA", target_system=1, target_component=1, id=1, count=90)
    simulation.advance(0.1)
    entry, data = (m.fields for m in client.receive() if m.name.startswith("LOG_"))
    assert (entry.num_logs, entry.size) == (0, 0)
    assert (data.id, data.count) == (1, 0)


def test_list_tells_size_and_time(run: Run) -> None:
    (entry,) = run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    assert (entry.id, entry.num_logs, entry.last_log_num) == (1, 1, 1)
    assert entry.time_utc == run.simulation.bridge.epoch_us // 1_000_000
    assert 0 < entry.size <= run.path.stat().st_size


def test_a_log_being_written_comes_whole_up_to_the_size_told(run: Run) -> None:
    (entry,) = run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    pieces = content(run.ask("LOG_REQUEST_DATA", 2.0, id=1, ofs=0, count=ALL))
    data = b"".join(pieces[at] for at in sorted(pieces))
    assert sorted(pieces) == list(range(0, entry.size, 90))
    assert data == run.path.read_bytes()[: entry.size]
    assert not run.ask("LOG_REQUEST_END")  # that was all


def test_a_piece_can_be_had_by_itself(run: Run) -> None:
    run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    (piece,) = run.ask("LOG_REQUEST_DATA", id=1, ofs=12_345, count=90)
    assert bytes(piece.data) == run.path.read_bytes()[12_345 : 12_345 + 90]
    (beyond,) = run.ask("LOG_REQUEST_DATA", id=1, ofs=1 << 30, count=90)
    (unknown,) = run.ask("LOG_REQUEST_DATA", id=7, ofs=0, count=90)
    assert beyond.count == unknown.count == 0


def test_a_transfer_can_be_stopped(run: Run) -> None:
    run.ask("LOG_REQUEST_DATA", 0.01, id=1, ofs=0, count=ALL)
    run.ask("LOG_REQUEST_END", 0.01)
    assert not run.ask("LOG_REQUEST_END")


def test_two_logs_after_a_reboot(run: Run) -> None:
    run.client.command(246, 1)
    run.simulation.advance(2.0)
    first, second = run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    assert (first.id, second.id, second.num_logs) == (1, 2, 2)
    assert second.time_utc >= first.time_utc + 2
    (only,) = run.ask("LOG_REQUEST_LIST", start=2, end=2)
    assert only.id == 2
    (piece,) = run.ask("LOG_REQUEST_DATA", id=2, ofs=0, count=90)
    assert bytes(piece.data[:3]) == b"\xa3\x95\x80"


def test_erase_forgets_but_deletes_no_file(run: Run) -> None:
    (before,) = run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    run.ask("LOG_ERASE")
    (after,) = run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    assert after.num_logs == 1 and after.size < before.size  # another that has just begun
    assert run.path.stat().st_size >= before.size


def test_a_snapshot_holds_the_transfer(run: Run) -> None:
    run.ask("LOG_REQUEST_LIST", start=0, end=65535)
    run.ask("LOG_REQUEST_DATA", 0.01, id=1, ofs=0, count=ALL)
    snapshot = run.simulation.snapshot()
    run.simulation.advance(0.05)
    once = content([m.fields for m in run.client.receive() if m.name == "LOG_DATA"])
    run.simulation.restore(snapshot)
    run.simulation.advance(0.05)
    again = content([m.fields for m in run.client.receive() if m.name == "LOG_DATA"])
    assert once and once == again
