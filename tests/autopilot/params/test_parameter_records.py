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
from sitl.autopilot.params import docs, firmware_parameters, parm_files
from sitl.autopilot.params.parameter import INT8, ParameterGroup, group, numbered, param, rows, stored
from sitl.autopilot.params.table import Table, Values
from sitl.autopilot.rover.parameters import TABLE as ROVER
from sitl.core.record_reader import UnknownFieldError, locate
from sitl.core.records import Floats, Records
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


class Twice(firmware_parameters.Parameters):
    GPS1: Gps


class Wrong(ParameterGroup):
    RATE: Gains = group("x", Q=1.0)


class Toy(firmware_parameters.Parameters):
    """A firmware with a winch."""

    WINCH: Winch
    MODE: Floats = param(5, 0, 9, "", "Mode at position {n}", INT8, count=2)
    CH: Records[Channel] = numbered(Channel, 2, MIN=(1000, 1200))
    SIM: firmware_parameters.Simulated


@pytest.mark.parametrize("table", [COPTER, ROVER, Table(Toy)])
def test_rows_are_in_the_order_of_memory(table):
    params, places = table.record(), []
    for k, row in enumerate(table.with_effect):
        place, code, count = locate(table.record.dtype, row.path)
        assert (code, count) == ("d", 1)
        places.append(place // 8)
        params[row.name] = k
    memory = memoryview(params._bytes).cast("d")
    assert sorted(set(places)) == places
    assert [memory[place] for place in places] == list(range(len(table.with_effect)))
    assert sum(memory) == sum(range(len(table.with_effect))), "between groups there is nothing"


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
    assert table.names()[0] == "AHRS_TRIM_X" and table.names()[-1].startswith("SIM_")


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
    return Values(TABLE, holder)


def everything(values: Values) -> dict[str, float]:
    return {p.name: values[p.name] for p in TABLE}


def test_reads_every_separator_and_comments() -> None:
    text = "# a file\nWPNAV_SPEED 500\nRTL_ALT,2000\nangle_max\t3000  # cdeg\n\n"
    assert parm_files.parse(text) == {"WPNAV_SPEED": 500.0, "RTL_ALT": 2000.0, "ANGLE_MAX": 3000.0}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("WPNAV_SPEED 500\nRTL_ALT", r"x\.parm, line 2: expected 'NAME VALUE'"),
        ("RTL_ALT ten", r"x\.parm, line 1: 'ten' is not a number \(RTL_ALT\)"),
        ("RTL_ALT 1e99999", r"x\.parm, line 1: '1e99999' is not a number \(RTL_ALT\)"),
        ("RTL_ALT -1e39", r"x\.parm, line 1: '-1e39' is not a number \(RTL_ALT\)"),
        ("RTL_ALT nan", r"x\.parm, line 1: 'nan' is not a number \(RTL_ALT\)"),
        ("RTL_ALT 1_000", r"x\.parm, line 1: '1_000' is not a number \(RTL_ALT\)"),
        ("ATC_RAT_RLL_P 0,135", r"x\.parm, line 1: '0,135' has a comma \(ATC_RAT_RLL_P\); write 0\.135"),
        ("QGC WPL 110\n0\t1\t0\t16", r"x\.parm, line 1: 'WPL' is not a number \(QGC\)"),
        ("some\ntext", r"x\.parm, line 1: 'some' is not NAME VALUE, and no other line is"),
    ],
)
def test_a_bad_line_is_named(text: str, says: str) -> None:
    with pytest.raises(parm_files.ParameterError, match=says):
        parm_files.parse(text, "x.parm")


def test_a_file_that_is_not_there_is_named(tmp_path) -> None:
    with pytest.raises(parm_files.ParameterError, match=r"none\.parm"):
        parm_files.load(tmp_path / "none.parm")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1e9])
def test_a_refused_value_leaves_everything_as_it_was(params, value: float) -> None:
    before = everything(params)
    with pytest.raises(parm_files.ParameterError, match="ANGLE_MAX"):
        parm_files.apply(params, {"WPNAV_SPEED": 300.0, "FRSKY_OPTIONS": 1.0, "ANGLE_MAX": value})
    assert everything(params) == before


def test_unknown_names_are_returned_and_the_rest_is_set(params) -> None:
    assert parm_files.apply(params, {"WPNAV_SPEED": 300.0, "NO_SUCH": 1.0}) == ["NO_SUCH"]
    assert params["WPNAV_SPEED"] == 300.0


def test_saved_and_loaded_is_the_same_bits(params, tmp_path) -> None:
    params.update({"ATC_RAT_RLL_P": 0.1234567, "FRSKY_OPTIONS": 7.9, "BATT3_ARM_VOLT": 11.1})
    parm_files.save(params, tmp_path / "all.parm")
    again = Values(TABLE, TABLE.record())
    TABLE.set_defaults(again._record)
    with pytest.warns(parm_files.ParameterWarning, match="parameters of the files have no effect here"):
        parm_files.apply(again, parm_files.load(tmp_path / "all.parm"))
    assert everything(again) == everything(params)
    assert again["FRSKY_OPTIONS"] == 7.0 and "BATT3_ARM_VOLT" not in {p.name for p in params.listed()}


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_by_name(text: str) -> None:
    try:
        values = parm_files.parse(text, "any")
    except parm_files.ParameterError as error:
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
        assert p.doc or not p.has_effect, p


def test_the_documentation_page_has_every_parameter(table: Table) -> None:
    page = docs.page("copter", table)
    assert all(f"| {p.name} |" in page for p in table)


OTHER_DEFAULT = {
    ("rover", "BATT_LOW_VOLT"),
    ("rover", "MIS_TOTAL"),
    ("copter", "STAT_BOOTCNT"),
    ("rover", "STAT_BOOTCNT"),
    *((kind, f"INS_GYROFFS_{axis}") for kind in ("copter", "rover") for axis in "XYZ"),
}
"""The program that was asked had booted once, and calibrated its gyros."""


@pytest.mark.parametrize(("name", "known", "listed"), [("copter", 3400, 1344), ("rover", 3200, 1224)])
def test_every_name_of_ardupilot_is_known_with_its_type_and_default(name: str, known: int, listed: int) -> None:
    """As a real ArduPilot 4.7-dev tells them; ``listed`` is what it lists after boot, without files of parameters."""
    table = KINDS[name].firmware.table
    with (Path(firmware_parameters.__file__).parents[1] / name / "parameters" / "ardupilot.csv").open() as file:
        theirs = {row["name"]: row for row in csv.DictReader(file)}
    assert len(theirs) > known and list(theirs) == list(table.names())[: len(theirs)]
    for p in table.with_effect:
        if not p.name.startswith("SIM_"):
            assert p.name in theirs, p.name
    for n, row in theirs.items():
        p = table[n]
        assert p.kind == row["type"], n
        if not n.startswith("SIM_") and (name, n) not in OTHER_DEFAULT:
            assert stored(p, p.default) == pytest.approx(float(row["default"])), n
    values = Values(table, table.record())
    table.set_defaults(values._record)
    assert len(values.listed()) == listed + len(table) - len(theirs)


def test_a_group_within_a_group_is_listed_when_both_are_on(params):
    def listed() -> set[str]:
        return {p.name for p in params.listed()}

    params["OSD1_ENABLE"] = 1
    assert not {"OSD_UNITS", "OSD1_ALTITUDE_EN"} & listed()
    params["OSD_TYPE"] = 1
    assert {"OSD_UNITS", "OSD1_ALTITUDE_EN"} < listed() and "OSD2_ALTITUDE_EN" not in listed()
    params["FRAME_CLASS"] = 1
    assert "MOT_YAW_SV_ANGLE" not in listed()
    params["FRAME_CLASS"] = 7
    assert "MOT_YAW_SV_ANGLE" in listed()
