# SPDX-License-Identifier: BSD-3-Clause
"""Files are known by what they hold; one that is no log says what it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.errors import SitlError
from sitl.logs import forms
from sitl.logs.tlog import LogError
from sitl.missions.comparison.flight import read
from tests.logs.log_files import V36, binary, flight, telemetry, text, written


def test_logs_are_known_whatever_their_name(tmp_path: Path) -> None:
    for data, form in (
        (binary(flight(), V36), forms.DATAFLASH),
        (text(flight(), V36), forms.DATAFLASH),
        (telemetry(), forms.TLOG),
        (b"\x89SITLREC\r\n\x1a\x01", forms.RECORDING),
    ):
        assert forms.of(written(tmp_path / "flight.txt", data)) == form
    assert read(written(tmp_path / "flight.log", text(flight(), V36))).notes


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is empty"),
        (b"QGC WPL 110\n0 1 0 16", "is a mission"),
        (b"ULog\x01\x12\x35\x01", "a log of PX4"),
        (b"\x89PNG\r\n", "a picture"),
        (b"PK\x03\x04rest", "unpack it"),
        (b"time,roll,pitch\n1,2,3\n", "no log but a text: it begins with 'time,roll,pitch'"),
        (b"\xfd\x09\x00\x00\x07", "MAVLink without times"),
        (bytes(range(200, 0, -1)), "no log: it begins with the bytes c8 c7 c6 c5 c4 c3 c2 c1"),
    ],
)
def test_a_file_that_is_no_log_says_what_it_is(tmp_path: Path, data: bytes, words: str) -> None:
    path = written(tmp_path / "x.dat", data)
    with pytest.raises(LogError) as error:
        read(path)
    assert str(error.value).startswith(f"{str(path)!r} is ")
    assert words in str(error.value)
    assert str(error.value).endswith("flights are read from recordings (.rec), .tlog, .bin and .log")


def test_a_folder_and_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="is a folder"):
        read(tmp_path)
    with pytest.raises(SitlError, match="does not exist"):
        read(tmp_path / "none.bin")
