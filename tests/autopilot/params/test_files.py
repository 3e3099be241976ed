# SPDX-License-Identifier: BSD-3-Clause
""".parm files and the parameter table."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.params import docs, files
from sitl.autopilot.params.table import Table, stored
from sitl.core.records import as_dict
from sitl.vehicle.kinds import KINDS


@pytest.fixture
def params():
    holder = TABLE.record()
    TABLE.set_defaults(holder)
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
    before = as_dict(params)
    with pytest.raises(files.ParameterError, match="ANGLE_MAX"):
        files.apply(TABLE, params, {"WPNAV_SPEED": 300.0, "ANGLE_MAX": value})
    assert as_dict(params) == before


def test_unknown_names_are_returned_and_the_rest_is_set(params) -> None:
    assert files.apply(TABLE, params, {"WPNAV_SPEED": 300.0, "NO_SUCH": 1.0}) == ["NO_SUCH"]
    assert params.WPNAV_SPEED == 300.0


def test_saved_and_loaded_is_the_same_bits(params, tmp_path) -> None:
    params.ATC_RAT_RLL_P = stored(TABLE["ATC_RAT_RLL_P"], 0.1234567)
    before = as_dict(params)
    files.save(TABLE, params, tmp_path / "all.parm")
    TABLE.set_defaults(params)
    files.apply(TABLE, params, files.load(tmp_path / "all.parm"))
    assert as_dict(params) == before


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_by_name(text: str) -> None:
    try:
        values = files.parse(text, "any")
    except files.ParameterError as error:
        assert str(error).startswith("any, line ")
    else:
        assert all(isinstance(v, float) for v in values.values())


@pytest.fixture(params=KINDS)
def table(request: pytest.FixtureRequest) -> Table:
    """Of each firmware."""
    return KINDS[request.param].firmware.table


def test_every_parameter_accepts_its_default_and_fits_the_wire(table: Table) -> None:
    for p in table:
        assert p.refusal(p.default) is None, p
        assert 1 <= len(p.name) <= 16, p
        assert p.low <= p.high, p
        assert p.doc, p


def test_the_documentation_page_has_every_parameter(table: Table) -> None:
    page = docs.page("copter", table)
    assert all(f"| {p.name} |" in page for p in table)


WIRE = {"2": "int8", "4": "int16", "6": "int32", "9": "float"}


@pytest.mark.parametrize("name", KINDS)
def test_defaults_and_types_are_those_of_ardupilot(name: str) -> None:
    """ardu*_defaults.csv: names, defaults and MAV_PARAM_TYPE that a real ArduPilot 4.7-dev reports.

    What it does not have (BATT_ with the monitor off) is from the same firmware with its SITL settings.
    """
    rows = csv.DictReader((Path(__file__).parent / f"ardu{name}_defaults.csv").read_text().splitlines())
    theirs = {row["name"]: (float(row["default"]), WIRE[row["mav_param_type"]]) for row in rows}
    for p in KINDS[name].firmware.table:
        if not p.name.startswith("SIM_"):
            assert p.name in theirs, p.name
        if p.name in theirs:
            assert (stored(p, p.default), p.kind) == (pytest.approx(theirs[p.name][0]), theirs[p.name][1]), p.name
