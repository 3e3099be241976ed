# SPDX-License-Identifier: BSD-3-Clause
"""The table of faults, their texts, and the errors for what cannot be."""

from __future__ import annotations

import math
from collections import ChainMap
from typing import Any

import numpy as np
import pytest

from sitl.errors import OptionError
from sitl.vehicle.faults import EFFECTS, TYPES, UNITS, Failure, known
from sitl.vehicle.kinds import KINDS
from sitl.vehicle.ordered_faults import OrderedFaults, Repair

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
        ("SIM_BATT_VOLTAGE=1e4", "fault SIM_BATT_VOLTAGE: 10000 is outside 0 .. 1000 V"),
        ("SIM_GPS1_ENABLE=0.5", "fault SIM_GPS1_ENABLE: 0.5 is not a whole number"),
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
    for bad in ({"instance": 1.5}, {"amount": math.inf}, {"begin": math.nan}, {"end": 1e12}, {"amount": "5"}):
        with pytest.raises(OptionError, match="fault gps"):
            Failure("gps", **bad)  # type: ignore[arg-type]
    for wrong in (Failure, Failure.of):
        with pytest.raises(OptionError, match="fault 3"):
            wrong(3)  # type: ignore[arg-type]


def test_numbers_of_numpy_are_plain_ones() -> None:
    number: Any = np.float64
    failure = Failure("motor", instance=np.int64(2), amount=np.float32(0.5), begin=number(1.0), end=number(2.0))  # type: ignore[arg-type]
    assert str(failure) == "motor:2=0.5@1.0..2.0" and Failure.of_text(str(failure)) == failure
    with pytest.raises(OptionError, match="is not a finite number"):
        Failure("motor", amount=np.bool_(True))


class Vehicle:
    """Parameters, and the faults of them."""

    def __init__(self, **values: float) -> None:
        self.faults, self.values = OrderedFaults(COPTER), dict(values)
        self.now_us = 0

    def at(self, seconds: float) -> Vehicle:
        self.now_us = round(1e6 * seconds)
        default = {name: COPTER[name].default for name in COPTER.names()}
        self.values.update(self.faults.values(self.now_us, ChainMap(self.values, default).__getitem__))
        return self

    def fail(self, *texts: str) -> Vehicle:
        for text in texts:
            self.faults.order(Failure.of_text(text), self.now_us)
        return self.at(1e-6 * self.now_us)

    def repair(self, what: str, instance: int = 0) -> Vehicle:
        self.faults.repair(Repair.of(what, instance, COPTER))
        return self.at(1e-6 * self.now_us)

    def has(self, **values: float) -> bool:
        return {name: self.values[name] for name in values} == values


def test_faults_end_whatever_others_do() -> None:
    v = Vehicle().fail("motor:1@0..10", "motor:2=0.5@2..6", "motor:3@4..5", "battery=9@1..8", "battery=8@2..3")
    steps = {
        1.0: (9.0, 1, 0.0), 2.0: (8.0, 3, 0.5), 3.0: (9.0, 3, 0.5), 4.0: (9.0, 7, 0.0), 5.0: (9.0, 3, 0.5),
        6.0: (9.0, 1, 0.0), 8.0: (float(COPTER["SIM_BATT_VOLTAGE"].default), 1, 0.0), 10.0: (12.6, 0, 0.0),
    }  # fmt: skip
    for seconds, (voltage, mask, share) in steps.items():
        v.at(seconds)
        assert v.has(SIM_BATT_VOLTAGE=voltage, SIM_ENGINE_FAIL=mask, SIM_ENGINE_MUL=share), seconds
    assert v.faults.orders == () and v.faults.before == {}


def test_a_repair_is_of_what_it_names() -> None:
    v = Vehicle().fail("gyro:1", "gyro:2", "gyro:2/off", "gyro:1/off@5", "mag", "gps/wrong=111318.845", "gps")
    v.repair("gyro", 1)
    assert v.has(SIM_GYR1_BIAS_X=0.0, SIM_GYR2_BIAS_X=0.5, SIM_GYR_FAIL_MSK=2)
    assert v.at(6.0).has(SIM_GYR_FAIL_MSK=2), "that to come does not begin"
    v.repair("mag:2")
    assert v.has(SIM_MAG1_FAIL=1, SIM_MAG2_FAIL=0, SIM_MAG3_FAIL=1)
    v.repair("gps/wrong")
    assert v.has(SIM_GPS1_ENABLE=0, SIM_GPS1_GLTCH_X=0.0)
    v.repair("gyro/off").repair("gyro")
    assert v.has(SIM_GYR_FAIL_MSK=0, SIM_GYR2_BIAS_X=0.0, SIM_MAG1_FAIL=1)
    v.fail("rc/stuck").repair("rc:3").repair("rc:16").repair("rc/stuck@0")
    assert v.has(SIM_RC_STUCK=0)
    v.fail("SIM_GPS1_JAM=1").repair("SIM_GPS1_ENABLE")
    assert v.has(SIM_GPS1_ENABLE=1, SIM_GPS1_JAM=1)
    assert v.repair("gps").has(SIM_GPS1_JAM=0)
    v.repair("")
    assert v.faults.orders == () and v.has(SIM_MAG1_FAIL=0, SIM_MAG3_FAIL=0)


def test_of_two_faults_of_a_unit_one_is_repaired_by_its_text() -> None:
    v = Vehicle().fail("motor:1=0.5", "motor:1=0.2").repair("motor:1=0.2")
    assert v.has(SIM_ENGINE_FAIL=1, SIM_ENGINE_MUL=0.5)
    v.fail("motor:1=0.5@0..4").repair("motor:1=0.5@0..4")
    assert v.at(5.0).has(SIM_ENGINE_FAIL=1)
    assert v.repair("servo", 1).has(SIM_ENGINE_FAIL=0)


def test_what_a_client_sets_is_his() -> None:
    v = Vehicle(SIM_BATT_VOLTAGE=12.0, SIM_ENGINE_FAIL=4.0).fail("battery=10", "motor:1=0.5")
    for name, value in (("SIM_BATT_VOLTAGE", 11.0), ("SIM_ENGINE_FAIL", 8.0)):
        v.values[name] = value
        v.faults.was_set(name)
    v.at(1.0)
    assert v.has(SIM_BATT_VOLTAGE=11.0, SIM_ENGINE_FAIL=8, SIM_ENGINE_MUL=0.5)
    v.fail("motor:2", "battery=9")
    assert v.has(SIM_BATT_VOLTAGE=9.0, SIM_ENGINE_FAIL=10, SIM_ENGINE_MUL=0.0)
    v.repair("")
    assert v.has(SIM_BATT_VOLTAGE=11.0, SIM_ENGINE_FAIL=8, SIM_ENGINE_MUL=0.0)


def test_a_shove_comes_once() -> None:
    v = Vehicle().fail("shove")
    assert v.has(SIM_SHOVE_X=5.0, SIM_SHOVE_TIME=500)
    v.values["SIM_SHOVE_TIME"] = 0.0  # the vehicle has taken it
    v.fail("gps")
    assert v.has(SIM_SHOVE_TIME=0) and v.fail("shove=3").has(SIM_SHOVE_TIME=500, SIM_SHOVE_X=3.0)


@pytest.mark.parametrize(
    ("what", "instance", "why"),
    [
        ("motor", -1, "fault motor: there is no number -1; it has 1 to 8, and 0 for all"),
        ("motor", 99, "fault motor: there is no number 99"),
        ("gyro:3", 0, "fault gyro: there is no number 3; it has 1 to 2"),
        ("gps:x", 0, "fault 'gps:x' is not UNIT"),
        ("gps/slow", 0, "fault gps has no type 'slow'; it has off"),
        ("engine", 0, "there is no fault 'engine'; there are gps"),
        ("motor:1", 2, "the instance is given twice, 1 and 2"),
        ("motor", 1.5, "1.5 is not the number of an instance"),
        ("", 2, "2 is not the number of an instance"),
        (3, 0, "repair of 3: a text such as gps, motor:2 or gps/wrong is needed"),
        ("SIM_WIND_SPD", 1, "a parameter has neither instances nor types"),
        ("SIM_WIND", 0, "there is no fault 'SIM_WIND'"),
        ("motor=7", 0, "SIM_ENGINE_MUL: 7 is outside 0 .. 1"),
    ],
)
def test_repairs_that_cannot_be(what: Any, instance: Any, why: str) -> None:
    with pytest.raises(OptionError) as error:
        Repair.of(what, instance, COPTER)
    assert why in str(error.value)
