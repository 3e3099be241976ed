# SPDX-License-Identifier: BSD-3-Clause
"""Parameters as typed records, the table made of them, and .parm files."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.copter.parameters import TABLE as COPTER
from sitl.autopilot.params import docs, files, parameters
from sitl.autopilot.params.parameter import INT8, ParameterGroup, group, numbered, param, rows
from sitl.autopilot.params.table import Table, stored
from sitl.autopilot.rover.parameters import TABLE as ROVER
from sitl.core.record_reader import UnknownFieldError, locate
from sitl.core.records import Floats, Records, as_dict
from sitl.vehicle.kinds import KINDS


class Gains(ParameterGroup):
    P: float = param(1.0, 0.0, 5.0, "1/s", "proportional gain")
    D: float = param(0.0, 0.0, 1.0, "", "derivative gain")


class Winch(ParameterGroup):
    TYPE: float = param(0, 0, 3, "", "0: none", INT8)
    RATE: Gains = group("Winch", P={"default": 2.0, "high": 9.0}, D={"doc": "Winch: none is needed"})


class Channel(ParameterGroup):
    MIN: float = param(1100, 800, 2200, "us", "Least pulse of channel {n}")


class Gps(ParameterGroup):
    DELAY_MS: float = param(0, 0, 350, "ms", "age of a fix")


class Twice(parameters.Parameters):
    GPS1: Gps


class Wrong(ParameterGroup):
    RATE: Gains = group("x", Q=1.0)


class Toy(parameters.Parameters):
    """A firmware with a winch."""

    WINCH: Winch
    MODE: Floats = param(5, 0, 9, "", "Mode at position {n}", INT8, count=2)
    CH: Records[Channel] = numbered(Channel, 2, MIN=(1000, 1200))
    SIM: parameters.Simulated


@pytest.mark.parametrize("table", [COPTER, ROVER, Table(Toy)])
def test_the_order_on_the_wire_is_the_order_in_memory(table):
    params = table.record()
    assert table.record.dtype.itemsize == 8 * len(table)
    for k, row in enumerate(table):
        assert locate(table.record.dtype, row.path) == (8 * k, "d", 1)
        params[row.name] = k
    assert list(memoryview(params._bytes).cast("d")) == list(range(len(table)))


def test_names_paths_and_changes():
    table = Table(Toy)
    own = [row for row in table if row.name.startswith(("WINCH", "MODE", "CH"))]
    assert [(row.name, row.path) for row in own] == [
        ("WINCH_TYPE", "WINCH.TYPE"),
        ("WINCH_RATE_P", "WINCH.RATE.P"),
        ("WINCH_RATE_D", "WINCH.RATE.D"),
        ("MODE1", "MODE[0]"),
        ("MODE2", "MODE[1]"),
        ("CH1_MIN", "CH[0].MIN"),
        ("CH2_MIN", "CH[1].MIN"),
    ]
    gain = table["WINCH_RATE_P"]
    assert gain[1:6] == (2.0, 0.0, 9.0, "1/s", "Winch: proportional gain")
    assert table["WINCH_RATE_D"].doc == "Winch: none is needed"
    assert table["MODE2"].doc == "Mode at position 2"
    assert (table["CH2_MIN"].default, table["CH2_MIN"].doc) == (1200, "Least pulse of channel 2")
    assert gain.refusal(10.0) == "WINCH_RATE_P: 10 is outside 0 .. 9 1/s"
    # Declared again, a group goes to its new place; what the firmware does not name comes first.
    assert table.names()[0] == "ARMING_RUDDER" and table.names()[-1].startswith("SIM_")


def test_a_parameter_by_its_full_name_is_the_one_at_its_path():
    params = Table(Toy).record()
    params.WINCH_RATE_P = 0.5
    params["CH2_MIN"] = 900
    assert (params.WINCH.RATE.P, params.CH[1].MIN) == (0.5, 900.0)
    params.WINCH.RATE.P = 0.75
    assert params.WINCH_RATE_P == params["WINCH_RATE_P"] == 0.75
    with pytest.raises(AttributeError):
        params.WINCH_RATE_Q = 1.0


def test_what_cannot_be():
    with pytest.raises(ValueError, match=r"RATE\.: \['Q'\] changed, which Gains does not have"):
        list(rows(Wrong))
    with pytest.raises(ValueError, match=r"parameters defined twice: \['GPS1_DELAY_MS'\]"):
        Table(Twice)
    with pytest.raises(UnknownFieldError, match=r"no element \[2\] of 'MODE'"):
        locate(Toy.dtype, "MODE[2]")


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
