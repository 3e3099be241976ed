# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle does with the values of files, and what its user is told."""

from __future__ import annotations

import math
import pickle
import warnings
from pathlib import Path

import pytest

from sitl.autopilot.params import parm_files
from sitl.autopilot.params.parameter import FLOAT, stored
from sitl.autopilot.params.parm_files import FileValues, ParameterError, ParameterWarning
from sitl.autopilot.params.renamed import RENAMED, here
from sitl.autopilot.params.table import Table, Values
from sitl.scenario import Scenario
from sitl.vehicle.kinds import KINDS

COPTER = KINDS["copter"].firmware.table
REAL = {
    "LOG_BACKEND_TYPE": (2, 1),
    "SCHED_LOOP_RATE": (300, 400),
    "ACRO_Y_RATE": (600, 360),
    "MOT_THST_HOVER": (0.12, 0.125),
    "ATC_THR_MIX_MAX": (2, 0.9),
    "RPM1_TYPE": (10, 5),
}
"""Values of real vehicles' files, and what this firmware uses instead."""


def new(table: Table = COPTER) -> Values:
    record = table.record()
    table.set_defaults(record)
    return Values(table, record)


def test_values_out_of_range_are_kept_and_the_nearest_are_used() -> None:
    values = new()
    given = parm_files.parse("".join(f"{name} {value}\n" for name, (value, _) in REAL.items()) + "RTL_ALT 2000\n")
    with pytest.warns(ParameterWarning) as told:
        assert parm_files.apply(values, given) == []
    for name, (value, used) in REAL.items():
        assert values[name] == stored(COPTER[name], value)
        assert not COPTER[name].has_effect or values._record[name] == stored(COPTER[name], used)
    assert values["RTL_ALT"] == 2000.0
    (said,) = [str(w.message) for w in told]
    texts = ", ".join(f"{name} {value} ({used})" for name, (value, used) in REAL.items())
    assert said == f"6 parameters of the files are out of range (used instead): {texts}"


def test_bits_that_mean_nothing_here_change_none_of_the_others() -> None:
    """The nearest in range would be other bits: none at all for ARMING_CHECK -10, which has all but two."""
    values = new()
    parm_files.apply(values, parm_files.parse("ARMING_CHECK -10\nFS_OPTIONS 256\nLOG_BITMASK -1\nFLIGHT_OPTIONS 16\n"))
    record = values._record
    assert (record.ARMING.CHECK, record.FS.OPTIONS, record.LOG.BITMASK, record.FLIGHT_OPTIONS) == (-10, 256, -1, 16)


def test_the_same_values_are_refused_when_a_program_gives_them() -> None:
    with pytest.raises(ParameterError, match=r"ACRO_Y_RATE: 600 is outside 1 \.\. 360 deg/s; ATC_THR_MIX_MAX"):
        parm_files.apply(new(), {"ACRO_Y_RATE": 600.0, "ATC_THR_MIX_MAX": 2.0})


@pytest.fixture(params=KINDS)
def table(request: pytest.FixtureRequest) -> Table:
    return KINDS[request.param].firmware.table


def test_every_bound_of_every_parameter_is_taken_from_a_file_and_from_a_program(table: Table) -> None:
    """Bounds are decimal numbers, and many have no float32 that is the same: 0.1 is 0.10000000149 to the firmware."""
    for bound in ("low", "high", "default"):
        wanted = {p.name: getattr(p, bound) for p in table if math.isfinite(getattr(p, bound))}
        from_file = parm_files.parse("".join(f"{name} {value!r}\n" for name, value in wanted.items()))
        assert from_file.keys() == wanted.keys() - {"FORMAT_VERSION", "MIS_TOTAL", "FENCE_TOTAL", "RALLY_TOTAL"}
        assert not [text for text in parm_files.notes(table, from_file) if "out of range" in text]
        values = new(table)
        assert parm_files.apply(values, wanted) == []
        for name, value in wanted.items():
            p = table[name]
            kept = stored(p, value)
            assert values[name] == kept == p.used(kept), name
            assert not p.has_effect or values._record[name] == kept, name


def test_what_lies_beyond_a_bound_is_out_of_range(table: Table) -> None:
    for p in table:
        step = 1.0 if p.kind != FLOAT else max(1e-3 * max(abs(p.low), abs(p.high)), 1e-30)
        for value, bound in ((p.low - step, p.low), (p.high + step, p.high)):
            if math.isfinite(value) and (p.kind == FLOAT or stored(p, value) == value):
                assert p.out_of_range(value) and p.used(stored(p, value)) == stored(p, bound), p


@pytest.mark.parametrize(
    ("value", "kept"), [(2.995, 3), (-2.995, -3), (2.98, 2), (127.9, 127), (400, 127), (-400, -128)]
)
def test_integers_are_stored_as_ardupilot_stores_them(value: float, kept: float) -> None:
    assert stored(COPTER["FRSKY_OPTIONS"], value) == kept


def test_names_of_other_versions_are_told_with_the_value_that_means_the_same() -> None:
    """If it would change something; rates of telemetry come last."""
    text = "SR0_POSITION 4\nSYSID_THISMAV 3\nWP_SPD 5\nGPS_TYPE 1\nPSC_NE_VEL_IMAX 5\nPSC_D_ACC_P 0.03\nQ_ENABLE 1\n"
    (said,) = parm_files.notes(COPTER, parm_files.parse(text + "RTL_ALT 2000\n"))
    assert said == (
        "7 parameters of the files are not in this firmware: SR0_POSITION, SYSID_THISMAV, WP_SPD, GPS_TYPE, "
        "PSC_NE_VEL_IMAX, PSC_D_ACC_P, ...; not set, but the same here: MAV_SYSID 3 for SYSID_THISMAV 3, "
        "WPNAV_SPEED 500 for WP_SPD 5, PSC_VELXY_IMAX 500 for PSC_NE_VEL_IMAX 5, PSC_ACCZ_P 0.3 for PSC_D_ACC_P 0.03, "
        "MAV1_POSITION 4 for SR0_POSITION 4"
    )


def test_every_name_of_another_version_has_one_here() -> None:
    for name in (*RENAMED, "SR1_EXTRA1", "GPS_TYPE", "PSC_D_VEL_FLTE", "PSC_NE_POS_P"):
        ours, _ = here(name) or ("", 0.0)
        assert ours in COPTER and name not in COPTER, name
    assert here("RTL_ALT") is None


def test_a_name_that_is_nearly_one_gets_a_suggestion() -> None:
    (said,) = parm_files.notes(COPTER, parm_files.parse("WPNAV_SPED 500\nRTL_ALT 2000\n"))
    assert said == "1 parameter of the files is not in this firmware: WPNAV_SPED; did you mean 'WPNAV_SPEED'?"
    (said,) = parm_files.notes(COPTER, parm_files.parse("ACRO_YAW_P 4\nRTL_ALT 2000\n"))
    assert said.endswith("ACRO_YAW_P; not set, but the same here: ACRO_Y_RATE 180 for ACRO_YAW_P 4")
    (said,) = parm_files.notes(COPTER, parm_files.parse("CRUISE_SPEED 2\nRTL_ALT 2000\n"))
    assert said.endswith("CRUISE_SPEED"), "another parameter's name is no help"


def test_a_file_of_which_nothing_is_in_the_firmware_is_named() -> None:
    said = parm_files.notes(COPTER, parm_files.parse("Q_ENABLE 1\nTECS_CLMB_MAX 5\n", "plane.param"))
    assert said[0] == "plane.param: nothing was set: none of its parameters is in this firmware"


def test_read_only_is_told_and_reaches_an_ardupilot() -> None:
    given = parm_files.parse("RTL_ALT 2000 @READONLY\nATC_RAT_RLL_P 0.1351234\n")
    assert parm_files.notes(COPTER, given) == ["1 parameter of the files is @READONLY, and can be set here: RTL_ALT"]
    assert parm_files.text_of(given) == "RTL_ALT 2000 @READONLY\nATC_RAT_RLL_P 0.1351234\n"


def test_several_files_stand_over_each_other(tmp_path: Path) -> None:
    for name, text in (("a", "RTL_ALT 1\nLAND_SPEED 40 @READONLY\n"), ("b", "RTL_ALT 2\n")):
        (tmp_path / name).write_text(text)
    both = parm_files.load_all([tmp_path / "a", tmp_path / "b"])
    assert both == {"RTL_ALT": 2.0, "LAND_SPEED": 40.0} and both.read_only == {"LAND_SPEED"}
    assert list(both.sources) == [str(tmp_path / "a"), str(tmp_path / "b")]


def test_merged_with_other_values_they_stay_values_of_files() -> None:
    given = parm_files.parse("ACRO_Y_RATE 600\nRTL_ALT 1\n")
    over, under = given | {"RTL_ALT": 2.0}, {"RTL_ALT": 3.0, "LAND_SPEED": 40.0} | given
    assert isinstance(over, FileValues) and isinstance(under, FileValues)
    assert over["RTL_ALT"] == 2.0 and under == {"RTL_ALT": 1.0, "ACRO_Y_RATE": 600.0, "LAND_SPEED": 40.0}
    again = pickle.loads(pickle.dumps(over))
    assert isinstance(again, FileValues) and again == over and again.sources == over.sources


def test_the_user_is_told_once() -> None:
    given = parm_files.parse("ACRO_Y_RATE 600\n")
    copies = [parm_files.given(given) for _ in range(3)]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        for copy in copies:
            parm_files.apply(new(), copy)
    assert len(told) == 1


def test_a_scenario_takes_a_file_and_keeps_what_it_is(tmp_path: Path) -> None:
    path = tmp_path / "mine.param"
    path.write_text("ACRO_Y_RATE,600\nNO_SUCH,1\n")
    scenario = Scenario("erle_copter", params=path)
    assert scenario.params == {"ACRO_Y_RATE": 600.0, "NO_SUCH": 1.0}
    kept = scenario.to_json()
    assert kept["params_of_files"] and isinstance(Scenario.from_json(kept).params, FileValues)
    assert "params_of_files" not in Scenario("erle_copter", params={"ACRO_Y_RATE": 200.0}).to_json()
    kept["params"] = str(path)
    with pytest.raises(ValueError, match="parameters of a recording are a table"):
        Scenario.from_json(kept)
