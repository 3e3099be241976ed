# SPDX-License-Identifier: BSD-3-Clause
"""DataFlash logs as columns: what pymavlink reads, of whole and of damaged files."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.logs.dataflash import columns
from sitl.logs.dataflash.columns import Columns
from sitl.logs.tlog import LogError
from tests.logs.log_files import V32, V36, binary, flight, old_flight, text

from .conftest import read_log


@pytest.fixture(params=[columns._PIECE, 5000], ids=["at once", "in pieces"])
def piece(request, monkeypatch):
    monkeypatch.setattr(columns, "_PIECE", request.param)


@pytest.mark.usefixtures("piece")
def test_every_number_is_what_pymavlink_reads(driven) -> None:
    log, known = Columns(driven.path), read_log(driven.path)
    del known["*"]  # pymavlink's own: every message
    assert set(log) == set(known)
    for name, messages in known.items():
        table = log[name]
        assert len(table) == len(messages), name
        for field in table.fields:
            theirs = [getattr(message, field) for message in messages]
            if not isinstance(theirs[0], (str, bytes)):
                np.testing.assert_allclose(table[field], np.array(theirs, float), rtol=1e-12, err_msg=f"{name}.{field}")
    assert (log.skipped, log.left_out, log.truncated) == (0, 0, False)


def test_what_a_log_says_of_itself(driven) -> None:
    log = Columns(driven.path)
    assert log.kind == driven.kind
    assert log.firmware.startswith("ArduCopter V" if driven.kind == "copter" else "ArduRover V")
    assert log.parameters["LOG_BACKEND_TYPE"] == 1.0
    assert log["IMU"].units["AccX"] == "m/s/s"
    assert log["IMU"].rate == pytest.approx(25.0)
    assert len(log["IMU"].instance(0)) == len(log["IMU"]) and not len(log["IMU"].instance(1))


def test_only_what_is_asked_for_is_kept_and_progress_is_told(driven) -> None:
    told = []
    log = Columns(driven.path, ["ATT"], lambda done, total: told.append((done, total)))
    assert "ATT" in log and "PARM" in log and "IMU" not in log
    assert told[-1] == (driven.path.stat().st_size,) * 2
    with pytest.raises(LogError, match=r"has no IMU; it has .*ATT"):
        log["IMU"]
    with pytest.raises(LogError, match=r"ATT of this log has no field 'Rol'; it has TimeUS, "):
        log["ATT"]["Rol"]


def test_of_a_message_only_the_fields_that_are_asked_for_are_kept(driven) -> None:
    whole, some = Columns(driven.path), Columns(driven.path, {"ATT": ("Yaw", "Roll", "NoField"), "GPS": None})
    assert some["ATT"].fields == ("TimeUS", "Roll", "Yaw") and some["GPS"].fields == whole["GPS"].fields
    for field in ("TimeUS", "Roll", "Yaw"):
        assert np.array_equal(some["ATT"][field], whole["ATT"][field])
    assert some["ATT"].raw.nbytes < 0.6 * whole["ATT"].raw.nbytes
    with pytest.raises(LogError, match=r"ATT of this log has no field 'Pitch'; it has TimeUS, Roll, Yaw"):
        some["ATT"]["Pitch"]


@pytest.mark.usefixtures("piece")
def test_damaged_pieces_and_marks_within_messages_are_passed_over(driven, tmp_path) -> None:
    data = bytearray(driven.path.read_bytes())
    whole = Columns(driven.path)
    at = len(data) // 2
    data[at : at + 300] = bytes(300)
    path = tmp_path / "cut.bin"
    path.write_bytes(data[:-7])
    log = Columns(path)
    lost = sum(len(whole[name]) for name in whole) - sum(len(log[name]) for name in log)
    assert 1 < lost < 40
    assert log.truncated and log.skipped >= 300
    times = whole["ATT"].time
    assert np.isin(log["ATT"].time, times).all()


def test_a_message_with_an_impossible_time_is_left_out(driven, tmp_path) -> None:
    data = bytearray(driven.path.read_bytes())
    log = Columns(driven.path)
    stamp = int(log["ATT"].raw["TimeUS"][-3]).to_bytes(8, "little")
    number = int(log["FMT"].raw["Type"][log["FMT"]["Name"].tolist().index("ATT")])
    at = data.index(b"\xa3\x95" + bytes([number]) + stamp)
    data[at + 3 : at + 11] = (10**13).to_bytes(8, "little")
    path = tmp_path / "odd.bin"
    path.write_bytes(data)
    found = Columns(path)
    assert found.left_out == 1 and len(found["ATT"]) == len(log["ATT"]) - 1


def test_other_vehicles_are_named(driven, tmp_path) -> None:
    data = driven.path.read_bytes().replace(b"ArduCopter V", b"MArduPlane V").replace(b"ArduRover V", b"ArduPlane V")
    path = tmp_path / "plane.bin"
    path.write_bytes(data)
    with pytest.raises(LogError, match="is of a plane"):
        _ = Columns(path).kind


@pytest.mark.parametrize("content", [b"", b"no log", b"\xa3\x95\x80" + bytes(200)])
def test_what_is_no_log_is_said(tmp_path, content) -> None:
    path = tmp_path / "odd.bin"
    path.write_bytes(content)
    with pytest.raises(LogError, match=r"odd\.bin' (is no DataFlash log|does not say|has no)"):
        _ = Columns(path).kind


@pytest.mark.usefixtures("piece")
@pytest.mark.parametrize("form", [binary, text])
def test_messages_without_a_time_have_that_of_the_message_before(tmp_path, form) -> None:
    """ArduPilot 3.2: EV, MODE and MSG have none, and TimeMS of GPS is the time of the week."""
    path = tmp_path / "x.log"
    messages = [*old_flight(), ("EV", 11)]
    messages.insert(40, ("EV", 15))
    path.write_bytes(form(messages, V32))
    log = Columns(path)
    assert log["GPS"].time == pytest.approx(log["ATT"].time)
    assert log["MSG"].time.tolist() == [1.0], "before the first message with a time: the log's beginning"
    assert log["EV"].time.tolist() == pytest.approx([1.0, 1.9, 5.9])
    assert log["EV"].where(log["EV"]["Id"] == 11).time.tolist() == pytest.approx([5.9])
    some = Columns(path, {"GPS": ("Lat",), "EV": None})
    assert some["GPS"].time == pytest.approx(log["GPS"].time)
    assert some["EV"].time.tolist() == log["EV"].time.tolist(), "whatever messages are asked for"
    assert log.left_out == 0


def test_a_log_as_text_that_has_the_firmware_before_all_else(tmp_path) -> None:
    """ArduPilot 3.0, as the terminal wrote it: number of the log, firmware, and a format of MSG that is not used."""
    path = tmp_path / "x.log"
    path.write_bytes(b"9\n\nArduCopter V3.0.1\nFree RAM: 1696\nAPM 2\n" + text(old_flight()[1:], V32))
    log = Columns(path)
    assert (log.firmware, log.kind, log.version) == ("ArduCopter V3.0.1", "copter", (3, 0))


def test_a_log_that_pauses_between_flights_keeps_both(tmp_path) -> None:
    """LOG_DISARMED 0: nothing is written for as long as the vehicle stands between two flights."""
    later = [(name, t + 1_000_000_000, *rest) for name, t, *rest in flight(count=30)]
    odd = ("POS", 1 << 50, 0, 0, 0.0, 0.0, 0.0)
    path = tmp_path / "x.bin"
    path.write_bytes(binary([*flight(), odd, *later], V36))
    log = Columns(path)
    assert (len(log["ATT"]), log.left_out) == (80, 1)
    assert log["EV"].time.tolist() == [1.0, 1001.0]
