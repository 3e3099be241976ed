# SPDX-License-Identifier: BSD-3-Clause
"""The table of faults, their texts, and the errors for what cannot be."""

from __future__ import annotations

import math

import pytest

from sitl.errors import OptionError
from sitl.vehicle.faults import EFFECTS, TYPES, UNITS, Failure, known, parameters_of
from sitl.vehicle.kinds import KINDS

COPTER, ROVER = (KINDS[name].firmware.table for name in ("copter", "rover"))


def test_the_table_names_what_mavlink_and_the_firmwares_have() -> None:
    assert len({(effect.unit, effect.type) for effect in EFFECTS}) == len(EFFECTS)
    for effect in EFFECTS:
        assert effect.type in TYPES and effect.does
        assert effect.is_in(COPTER) or effect.is_in(ROVER), effect
    assert set(known(COPTER)) & set(UNITS) and set(known(ROVER)) < set(known(COPTER)) | {"servo"}


@pytest.mark.parametrize(
    ("text", "failure"),
    [
        ("gps", Failure("gps")),
        ("gps@12", Failure("gps", begin=12.0)),
        ("motor:2=0.5@20..30", Failure("motor", "", 2, 0.5, 20.0, 30.0)),
        ("gps/garbage@1e1..2.5e1", Failure("gps", "garbage", begin=10.0, end=25.0)),
        ("rc_signal@0.5", Failure("rc", begin=0.5)),
        ("SIM_WIND_DIR=-90", Failure("SIM_WIND_DIR", amount=-90.0)),
    ],
)
def test_texts(text: str, failure: Failure) -> None:
    assert Failure.of_text(text) == failure
    assert Failure.of_text(str(failure)) == failure


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("gps@", "fault 'gps@' is not UNIT"),
        ("gps@soon", "is not UNIT"),
        ("motor:x", "is not UNIT"),
        ("gps@5..4", "its end, 4 s, is not after its begin, 5 s"),
        ("gps@-1", "begin -1.0 is not a time from 0"),
        ("motor=nan", "amount nan is not a finite number"),
        ("gp", "there is no fault 'gp'; there are gps"),
        ("gps/slow", "fault gps has no type 'slow'; it has off"),
        ("motor:9", "fault motor: there is no number 9; it has 1 to 8, and 0 for all"),
        ("gps=3", "fault gps/off takes no amount, and 3 was given"),
        ("battery=-5", "SIM_BATT_VOLTAGE: -5 is outside 0 .. 1000 V"),
        ("SIM_GPS1_ENABL=0", "no such parameter has an effect; did you mean 'SIM_GPS1_ENABLE'"),
        ("SIM_GPS1_ENABLE", "a parameter takes a value and nothing else"),
        ("SIM_GPS1_ENABLE/off=1", "a parameter takes a value and nothing else"),
    ],
)
def test_what_is_wrong_is_said(text: str, why: str) -> None:
    with pytest.raises(OptionError) as error:
        Failure.of_text(text).checked(COPTER)
    assert why in str(error.value)


def test_values() -> None:
    failure = Failure("motor", instance=3, amount=0.25).checked(COPTER)
    assert failure.values(COPTER, {"SIM_ENGINE_FAIL": 1.0}) == {"SIM_ENGINE_FAIL": 5.0, "SIM_ENGINE_MUL": 0.25}
    assert Failure("motor").checked(COPTER).values(COPTER, {})["SIM_ENGINE_FAIL"] == 255.0
    assert "SIM_ENGINE_FAIL" in parameters_of("motor", COPTER)
    with pytest.raises(OptionError, match="there is no fault 'engine'"):
        list(parameters_of("engine", COPTER))
    for bad in ({"instance": 1.5}, {"amount": math.inf}, {"begin": math.nan}, {"end": 1e12}):
        with pytest.raises(OptionError, match="fault gps"):
            Failure("gps", **bad)  # type: ignore[arg-type]
