# SPDX-License-Identifier: BSD-3-Clause
"""Faults of tests: texts as --fail takes them, and a test whose fault never acts fails."""

from __future__ import annotations

import pytest

from sitl.bridge.links import LinkFaults
from sitl.bridge.services.failure_injection import FaultService
from sitl.errors import OptionError
from sitl.missions.testing.factory import VehicleFactory


def test_a_text_is_what_arguments_say(make: VehicleFactory) -> None:
    copter = make("copter")
    service = copter.simulation.bridge.get(FaultService)
    for text, *words, options in (
        ("motor:2=0", "motor", {"motor": 2, "thrust": 0.0}),
        ("motor:2=0.5@3..5", "motor", {"instance": 2, "amount": 0.5, "at": 3.0, "until": 5.0}),
        ("gps/wrong=30@2", "gps", "wrong", {"amount": 30.0, "at": 2.0}),
        ("rc_signal:3/stuck", "rc", "stuck", {"instance": 3}),
        ("SIM_WIND_DIR=90@4", "SIM_WIND_DIR", {"amount": 90.0, "at": 4.0}),
    ):
        with copter.fork():
            copter.fail(text)  # type: ignore[arg-type]
            ordered = service.texts
        with copter.fork():
            copter.fail(*words, **options)  # type: ignore[arg-type]
            assert service.texts == ordered and len(ordered) == 1
    copter.fail("wind=9@2", direction=270)
    assert service.texts == ["wind/wrong=9.0@2.0", "SIM_WIND_DIR=270.0@2.0", "SIM_WIND_TURB=0.0@2.0"]
    for text, options, why in (
        ("motor:2=0", {"motor": 3}, "motor=3 and instance=2 say the same"),
        ("motor:2=0.5", {"amount": 0.2}, "amount is given twice"),
        ("gps@3", {"at": 4.0}, "at is given twice, 3.0 and 4.0"),
        ("gps/wrong", {"type": "off"}, "type is given twice"),
        ("gps=3=4", {}, "'gps=3=4' is not UNIT"),
        ("motor:6=0", {}, "there is no number 6; airframe erle_copter has 1, 2, 3, 4, and 0 for all"),
        ("link@3", {}, "this client's, and begins now"),
    ):
        with pytest.raises(OptionError, match=why):
            copter.fail(text, **options)  # type: ignore[arg-type]


def test_what_became_of_faults(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(5)
    copter.fail("station")
    copter.delay(2.0)
    copter.restore("station")
    with copter.fork():
        copter.fail("link", faults=LinkFaults(loss=0.5))
        copter.delay(1.0)
    copter.fail("link", faults=LinkFaults(seed=3))
    copter.fail("shove")
    copter.delay(3.0)
    copter.fail("gps@5", may_not_act=True)
    names = ["station", "link", "link", "shove/wrong", "gps/off"]
    lines = copter.judge_faults()
    assert [line.split()[1] for line in lines] == names
    lasted = [sum(end - begin for begin, end in fault.acted.spans) * 1e-6 for fault in copter.failures]
    assert lasted == pytest.approx([2.0, 1.0, 0.0, 0.5, 0.0], abs=0.01)
    assert copter.idle_faults == ["fault link never acted: its LinkFaults do nothing"]


def test_faults_that_are_on(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.fail("battery=11")
    assert copter.idle_faults == ["fault battery/wrong=11.0 never acted: no simulated time went by"]
    copter.delay(0.5)
    assert copter.idle_faults == []
    copter.fail("wind", speed=0, turbulence=2)
    copter.delay(0.5)
    assert copter.idle_faults == [] and make.idle_faults() == []
    copter.restore("wind")
    copter.fail("wind", speed=0, direction=90)
    copter.delay(0.5)
    assert copter.idle_faults == ["fault wind/wrong=0.0 never acted: SIM_WIND_SPD was 0 before, too"]


TESTS = """
def test_late(copter):
    copter.fail("gps", at=100)
    copter.delay(1)

def test_disarmed(copter):
    copter.fail("motor:2=0.5")
    copter.delay(1)

def test_none_there(copter):
    copter.fail("motor", motor=6, thrust=0)

def test_acts(copter):
    copter.fail("battery=11@1..2")
    copter.delay(3)

def test_may(copter):
    copter.fail("gps", at=100, may_not_act=True)

def test_fails_anyhow(copter):
    copter.fail("gps", at=100)
    assert copter.height > 100
"""


def test_a_test_whose_fault_never_acts_fails(project: pytest.Pytester) -> None:
    project.makepyfile(TESTS)
    result = project.runpytest_inprocess("-rA", "--junitxml=report.xml")
    result.assert_outcomes(passed=2, failed=4)
    result.stdout.fnmatch_lines([
        "copter: fault gps/off never acted: it begins at *, and the flight ended at *",
        "a test of a fault that never acts tests nothing; fail(..., may_not_act=True) allows it",
        "copter: fault motor:2/off=0.5 never acted: the vehicle was not armed",
        '>*copter.fail("motor", motor=6, thrust=0)',
        "E *OptionError: fault motor: there is no number 6; airframe erle_copter has 1, 2, 3, 4, and 0 for all",
        "E *assert * > 100", "*- Captured sitl: faults call -*",
        "copter: fault battery/wrong=11.0 acted from * to * s",
    ])  # fmt: skip
    report = (project.path / "report.xml").read_text()
    assert 'name="sitl_fault" value="copter: fault battery/wrong=11.0 acted from' in report
