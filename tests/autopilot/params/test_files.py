# SPDX-License-Identifier: BSD-3-Clause
""".parm files and the parameter table."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.params import docs, files, table
from sitl.core.records import record


@pytest.fixture
def params():
    holder = np.zeros(1, record(("params", table.PARAMS_DTYPE))).view(np.recarray)[0].params
    table.set_defaults(holder)
    return holder


def test_reads_every_separator_and_comments() -> None:
    text = "# a file\nWPNAV_SPEED 500\nRTL_ALT,2000\nangle_max\t3000  # cdeg\n\n"
    assert files.parse(text) == {"WPNAV_SPEED": 500.0, "RTL_ALT": 2000.0, "ANGLE_MAX": 3000.0}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("WPNAV_SPEED 500\nRTL_ALT", r"x\.parm, line 2: expected 'NAME VALUE'"),
        ("RTL_ALT ten", r"x\.parm, line 1: 'ten' is not a number \(RTL_ALT\)"),
    ],
)
def test_a_bad_line_is_named(text: str, says: str) -> None:
    with pytest.raises(files.ParameterError, match=says):
        files.parse(text, "x.parm")


def test_a_file_that_is_not_there_is_named(tmp_path) -> None:
    with pytest.raises(files.ParameterError, match=r"none\.parm"):
        files.load(tmp_path / "none.parm")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1e9])
def test_a_refused_value_leaves_everything_as_it_was(params, value: float) -> None:
    before = params.tobytes()
    with pytest.raises(files.ParameterError, match="ANGLE_MAX"):
        files.apply(params, {"WPNAV_SPEED": 300.0, "ANGLE_MAX": value})
    assert params.tobytes() == before


def test_unknown_names_are_returned_and_the_rest_is_set(params) -> None:
    assert files.apply(params, {"WPNAV_SPEED": 300.0, "NO_SUCH": 1.0}) == ["NO_SUCH"]
    assert params.WPNAV_SPEED == 300.0


def test_saved_and_loaded_is_the_same_bits(params, tmp_path) -> None:
    params.ATC_RAT_RLL_P = table.stored(table.BY_NAME["ATC_RAT_RLL_P"], 0.1234567)
    before = params.tobytes()
    files.save(params, tmp_path / "all.parm")
    table.set_defaults(params)
    files.apply(params, files.load(tmp_path / "all.parm"))
    assert params.tobytes() == before


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_by_name(text: str) -> None:
    try:
        values = files.parse(text, "any")
    except files.ParameterError as error:
        assert str(error).startswith("any, line ")
    else:
        assert all(isinstance(v, float) for v in values.values())


def test_every_parameter_accepts_its_default_and_fits_the_wire() -> None:
    for p in table.TABLE:
        assert p.refusal(p.default) is None, p
        assert 1 <= len(p.name) <= 16, p
        assert p.low <= p.high, p
        assert p.doc, p


def test_the_documentation_page_has_every_parameter() -> None:
    page = docs.page()
    assert all(f"| {p.name} |" in page for p in table.TABLE)


KINDS = {"2": "int8", "4": "int16", "6": "int32", "9": "float"}


def test_defaults_and_types_are_those_of_arducopter() -> None:
    """ardupilot_defaults.csv: names, defaults and MAV_PARAM_TYPE that a real ArduCopter 4.7-dev reports.

    What it does not have (BATT_ with the monitor off) is from the same firmware with its SITL settings.
    """
    rows = csv.DictReader((Path(__file__).parent / "ardupilot_defaults.csv").read_text().splitlines())
    theirs = {row["name"]: (float(row["default"]), KINDS[row["mav_param_type"]]) for row in rows}
    for p in table.TABLE:
        if not p.name.startswith("SIM_"):
            assert p.name in theirs, p.name
        if p.name in theirs:
            assert (table.stored(p, p.default), p.kind) == (pytest.approx(theirs[p.name][0]), theirs[p.name][1]), p.name
