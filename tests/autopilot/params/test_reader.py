# SPDX-License-Identifier: BSD-3-Clause
"""Files of parameters as ground stations, people and programs write them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.params import parm_files
from sitl.autopilot.params.parm_files import ParameterError
from sitl.autopilot.params.reader import MAX_BYTES

FOLDER = Path(__file__).with_name("files")
FENCE = {"FENCE_ALT_MAX": 77.0, "FENCE_RADIUS": 700.0}


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("qgc.params", {**FENCE, "FENCE_ENABLE": 0.0}),
        ("mp.param", FENCE),
        ("equals.parm", FENCE),
        ("hex.parm", {**FENCE, "LOG_BITMASK": float(0x2BFFE)}),
        ("float32bound.parm", {"AUTOTUNE_AGGR": 0.1}),
    ],
)
def test_a_file_of_each_form_is_read_without_a_word(name: str, values: dict[str, float]) -> None:
    found = parm_files.load(FOLDER / name)
    assert found == values
    assert not parm_files.not_read(found)


@pytest.mark.parametrize(
    "line",
    [
        "RTL_ALT 2000",
        "  RTL_ALT\t2000  ",
        "RTL_ALT          2000.000000",
        "RTL_ALT,2000",
        "RTL_ALT,2000.0,comment",
        "RTL_ALT=2000",
        "RTL_ALT = 2000",
        "RTL_ALT , +2e3",
        "RTL_ALT 2000 # cm",
        "RTL_ALT 2000#cm",
        "RTL_ALT,2000\t#note, of somebody",
        "RTL_ALT 0x7D0",
        "RTL_ALT 0X7d0 # hexadecimal",
        "rtl_alt 2000",
        "1\t1\tRTL_ALT\t2000\t4",
        "1 1 RTL_ALT 2000.000000000000000000 9",
        "RTL_ALT 2000 @READONLY",
    ],
)
def test_the_line(line: str) -> None:
    assert parm_files.parse(line) == {"RTL_ALT": 2000.0}


@pytest.mark.parametrize("comment", ["# RTL_ALT 5", "  #RTL_ALT 5", "// RTL_ALT 5", "; RTL_ALT 5", "", "   ", "#"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_comments_and_ends_of_lines(comment: str, end: str) -> None:
    found = parm_files.parse(end.join([comment, "RTL_ALT 2000", comment, "LAND_SPEED 40", comment]))
    assert found == {"RTL_ALT": 2000.0, "LAND_SPEED": 40.0}
    assert not parm_files.not_read(found)


@pytest.mark.parametrize(
    "data",
    [
        "RTL_ALT 2000\n".encode("utf-8-sig"),
        "RTL_ALT 2000\n".encode("utf-16"),
        "# H\u00f6he\nRTL_ALT 2000\n".encode("latin-1"),
    ],
)
def test_byte_order_marks_and_other_encodings(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "x.param").write_bytes(data)
    assert parm_files.load(tmp_path / "x.param") == {"RTL_ALT": 2000.0}


def test_the_last_line_of_a_name_stands_and_is_told() -> None:
    found = parm_files.parse("RTL_ALT 2000\nLAND_SPEED 40\nRTL_ALT 1000\nLAND_SPEED 40", "x.parm")
    assert found == {"RTL_ALT": 1000.0, "LAND_SPEED": 40.0}
    assert found.remarks == ["x.parm, line 3: RTL_ALT is 1000, after 2000 in line 1"]


def test_lines_that_are_no_parameters_are_passed_over_and_named() -> None:
    junk = "Loading...\nSIM_TIDE_0.5\n<html>\n12 monkeys\n"
    found = parm_files.parse(f"{junk}RTL_ALT 2000\n", "x.parm")
    assert found == {"RTL_ALT": 2000.0}
    said = "x.parm: 4 lines are not NAME VALUE: line 1: 'Loading...', line 2: 'SIM_TIDE_0.5', line 3: '<html>', ..."
    assert found.remarks == [said]


def test_what_the_memory_of_the_real_autopilot_holds_is_left_out() -> None:
    found = parm_files.parse("FORMAT_VERSION 120\nMIS_TOTAL 9\nFENCE_TOTAL 5\nRALLY_TOTAL 2\nRTL_ALT 2000\n")
    assert found == {"RTL_ALT": 2000.0} and not found.remarks


def test_parameters_of_a_camera_or_gimbal_in_the_file_of_qgroundcontrol_are_left_out() -> None:
    found = parm_files.parse("1\t154\tRTL_ALT\t1\t9\n1\t1\tLAND_SPEED\t40\t4\n", "x.params")
    assert found == {"LAND_SPEED": 40.0}
    assert found.remarks == ["x.params: 1 parameters of components other than the autopilot are left out"]


def test_a_file_that_sets_nothing_says_so(tmp_path: Path) -> None:
    (tmp_path / "x.parm").write_text("# nothing\n\n")
    (said,) = parm_files.not_read(parm_files.load(tmp_path / "x.parm"))
    assert said == f"{tmp_path / 'x.parm'}: nothing was set: it has no parameters"


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "is not text"),
        (b"A_B 1\n" * (MAX_BYTES // 6 + 1), "is larger than 1000000 bytes"),
        (b"hello\nworld\n", "line 1: 'hello' is not NAME VALUE, and no other line is"),
        (b'{"RTL_ALT": 2000}', "is not NAME VALUE"),
    ],
)
def test_what_is_no_file_of_parameters_is_refused(tmp_path: Path, data: bytes, says: str) -> None:
    (tmp_path / "x.parm").write_bytes(data)
    with pytest.raises(ParameterError, match=says) as refused:
        parm_files.load(tmp_path / "x.parm")
    assert str(tmp_path / "x.parm") in str(refused.value)


# ---------------------------------------------------------------------- includes


def test_an_included_file_is_read_where_it_stands(tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    (tmp_path / "a.parm").write_text("LAND_SPEED 40\nRTL_ALT 1\n@include below/b.parm # more\nWPNAV_SPEED 500\n")
    (tmp_path / "below" / "b.parm").write_text("RTL_ALT 2\nWPNAV_SPEED 2\n@include c.param\n")
    (tmp_path / "below" / "c.param").write_text("LAND_SPEED 50\n")
    found = parm_files.load(tmp_path / "a.parm")
    assert found == {"LAND_SPEED": 50.0, "RTL_ALT": 2.0, "WPNAV_SPEED": 500.0} and not parm_files.not_read(found)


def test_a_link_stands_for_the_file_that_it_leads_to(tmp_path: Path) -> None:
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "a.parm").write_text("@include b.parm\n")
    (tmp_path / "kept" / "b.parm").write_text("RTL_ALT 2000\n")
    (tmp_path / "now.parm").symlink_to(tmp_path / "kept" / "a.parm")
    assert parm_files.load(tmp_path / "now.parm") == {"RTL_ALT": 2000.0}


def test_a_file_that_is_not_there_is_named_and_the_rest_is_read() -> None:
    found = parm_files.load(FOLDER / "include.parm")
    assert found == {"FENCE_RADIUS": 700.0}
    (said,) = found.remarks
    assert said == f"{FOLDER / 'include.parm'}, line 1: @include 'other.parm' is not there; it is passed over"


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("a.parm", "includes itself"),
        ("../secret.parm", "leads out of the folder"),
        ("/etc/passwd", "leads out of the folder"),
        ("link.parm", "leads out of the folder"),
        ("notes.txt", r"is no file that ends in \.parm, \.param, \.params"),
        ("folder.parm", "is no file that ends in"),
        ("back.parm", "includes itself"),
        ("", "names no file"),
    ],
)
def test_what_is_not_included(tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "secret.parm").write_text("LAND_SPEED 1\n")
    folder = tmp_path / "given"
    (folder / "folder.parm").mkdir(parents=True)
    (folder / "notes.txt").write_text("LAND_SPEED 1\n")
    (folder / "back.parm").write_text("@include a.parm\n")
    (folder / "link.parm").symlink_to(tmp_path / "secret.parm")
    (folder / "a.parm").write_text(f"@include {name}\nRTL_ALT 2000\n")
    found = parm_files.load(folder / "a.parm")
    assert found == {"RTL_ALT": 2000.0}
    assert len(found.remarks) == 1 and re.search(why, found.remarks[0])


def test_includes_end(tmp_path: Path) -> None:
    for k in range(30):
        (tmp_path / f"{k}.parm").write_text(f"@include {k + 1}.parm\nRC{k}_TRIM 1500\n")
    found = parm_files.load(tmp_path / "0.parm")
    assert len(found) == 11 and "one too many: 50 includes, 10 within each other" in found.remarks[0]
    (tmp_path / "many.parm").write_text("@include one.parm\n" * 60 + "LAND_SPEED 40\n")
    (tmp_path / "one.parm").write_text("RTL_ALT 2000\n")
    found = parm_files.load(tmp_path / "many.parm")
    assert found == {"RTL_ALT": 2000.0, "LAND_SPEED": 40.0} and len(found.remarks) == 10


def test_other_directives_are_named() -> None:
    found = parm_files.parse("@DELETE\tRTL_ALT\nLAND_SPEED 40\n", "x.parm")
    assert found == {"LAND_SPEED": 40.0}
    assert found.remarks == ["x.parm, line 1: '@DELETE' is not known here, and passed over"]


_PIECES = [
    "RTL_ALT",
    "1",
    "0x",
    "@include",
    "@",
    "@READONLY",
    "=",
    ",",
    "\t",
    " ",
    "#",
    "\n",
    "\r",
    "é",
    "..",
    "9" * 400,
]
LINES = st.lists(st.sampled_from(_PIECES))


@given(LINES.map("".join))
def test_any_lines_are_read_or_refused_by_name(text: str) -> None:
    try:
        assert all(abs(value) < float("inf") for value in parm_files.parse(text, "any").values())
    except ParameterError as error:
        assert str(error).startswith("any, line ")
