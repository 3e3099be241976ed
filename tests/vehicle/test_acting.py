# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of faults that do something only together with others."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest

from sitl.bridge.services.failure_injection import FaultService
from sitl.client import Client
from sitl.simulation import Simulation
from sitl.vehicle.acting import ACTS_WHILE, ARMED, acts_not
from sitl.vehicle.faults import Failure
from sitl.vehicle.kinds import KINDS

PRESENT = {
    ARMED: 0.0, "SIM_ENGINE_FAIL": 0.0, "SIM_ENGINE_MUL": 1.0, "SIM_WIND_SPD": 0.0, "SIM_WIND_TURB": 0.0,
    "SIM_WIND_T": 1.0, "SIM_SHOVE_TIME": 0.0, "SIM_SHOVE_X": 0.0, "SIM_SHOVE_Y": 0.0, "SIM_SHOVE_Z": 0.0,
    "SIM_ACC1_RND": 0.0, "SIM_ACC_FAIL_MSK": 1.0, "SIM_GYR_FAIL_MSK": 2.0, "SIM_MAG2_FAIL": 1.0, "SIM_MAG1_FAIL": 0.0,
    "SIM_BARO_DISABLE": 1.0, "GPS2_TYPE": 0.0, "SIM_GPS2_TYPE": 1.0, "BATT_MONITOR": 0.0, "SIM_PLD_ENABLE": 0.0,
}  # fmt: skip


@pytest.mark.parametrize(
    ("parameter", "present", "why"),
    [
        ("SIM_ENGINE_MUL", {}, "SIM_ENGINE_FAIL is 0"),
        ("SIM_ENGINE_MUL", {"SIM_ENGINE_FAIL": 2}, ""),
        ("SIM_ENGINE_FAIL", {}, "SIM_ENGINE_MUL is 1"),
        ("SIM_ENGINE_FAIL", {"SIM_ENGINE_MUL": 0.5}, ""),
        ("SIM_WIND_DIR", {}, "SIM_WIND_DIR does nothing while SIM_WIND_SPD is 0 and SIM_WIND_T is 1"),
        ("SIM_WIND_DIR", {"SIM_WIND_TURB": 3}, "SIM_WIND_SPD is 0"),
        ("SIM_WIND_DIR", {"SIM_WIND_SPD": 3}, ""),
        ("SIM_WIND_DIR_Z", {"SIM_WIND_T": 2}, ""),
        ("SIM_WIND_TC", {"SIM_WIND_TURB": 3}, ""),
        ("SIM_WIND_TURB", {}, ""),
        ("SIM_WIND_T", {"SIM_WIND_T": 0}, "SIM_WIND_SPD is 0"),
        ("SIM_WIND_T_ALT", {"SIM_WIND_SPD": 3}, "SIM_WIND_T is 1"),
        ("SIM_SHOVE_X", {}, "SIM_SHOVE_TIME is 0"),
        ("SIM_SHOVE_TIME", {"SIM_SHOVE_Y": 3}, ""),
        ("SIM_VIB_FREQ_X", {ARMED: 1}, "SIM_ACC1_RND is 0"),
        ("SIM_VIB_FREQ_X", {"SIM_ACC1_RND": 1}, "the vehicle is not armed"),
        ("SIM_VIB_FREQ_X", {"SIM_ACC1_RND": 1, ARMED: 1}, ""),
        ("SIM_ACC1_BIAS_X", {}, "SIM_ACC_FAIL_MSK is 1"),
        ("SIM_ACC2_BIAS_X", {}, ""),
        ("SIM_GYR1_BIAS_X", {}, ""),
        ("SIM_GYR2_BIAS_X", {}, "SIM_GYR_FAIL_MSK is 2"),
        ("SIM_MAG2_OFS_X", {}, "SIM_MAG2_FAIL is 1"),
        ("SIM_MAG2_FAIL", {}, ""),
        ("SIM_MAG1_OFS_X", {}, ""),
        ("SIM_BARO_GLITCH", {}, "SIM_BARO_DISABLE is 1"),
        ("SIM_BARO_DISABLE", {}, ""),
        ("SIM_BARO_COUNT", {}, ""),
        ("SIM_GPS2_ENABLE", {}, "GPS2_TYPE is 0"),
        ("SIM_BATT_VOLTAGE", {}, "BATT_MONITOR is 0 and the vehicle is not armed"),
        ("SIM_BATT_VOLTAGE", {ARMED: 1}, ""),
        ("SIM_PLD_LAT", {}, "SIM_PLD_ENABLE is 0"),
        ("SIM_SPEEDUP", {}, "changes nothing of a flight"),
    ],
)
def test_one_that_needs_another(parameter: str, present: dict[str, float], why: str) -> None:
    found = acts_not(parameter, {**PRESENT, **present}.get)
    assert why in found and bool(why) == bool(found)


def test_all_of_the_table_are_parameters() -> None:
    names = {name for kind in KINDS.values() for name in kind.firmware.table.names()} | {ARMED}
    for pattern, conditions in ACTS_WHILE:
        assert any(fnmatchcase(name, pattern) for name in names), pattern
        assert {condition.name for condition in conditions} <= names


def test_of_a_flight() -> None:
    client = Client(Simulation("erle_copter"))
    service = client.simulation.bridge.get(FaultService)
    history = service.keep_history()
    client.wait_ready()
    client.arm()
    client.params["SIM_MAG1_OFS_Y"] = 3.0

    def told(*faults: str) -> list[str]:
        count = len(history.faults)
        for fault in faults:
            service.fail(Failure.of_text(fault))
        client.delay(0.3)
        found = [str(acted) for acted in history.finish(client.simulation.time_us)[count:]]
        client.simulation.repair()
        return [text.partition(" never acted: ")[2] for text in found]

    no_motor, no_wind = "SIM_ENGINE_MUL does nothing while SIM_ENGINE_FAIL is 0", "SIM_WIND_DIR does nothing while "
    assert told("SIM_ENGINE_MUL=0.5") == [no_motor] and told("SIM_ENGINE_MUL=1") == [no_motor]
    assert told("SIM_ENGINE_MUL=0.9", "SIM_ENGINE_FAIL=1") == ["", ""]
    assert told("SIM_WIND_DIR=90")[0].startswith(no_wind) and told("SIM_WIND_DIR=90", "wind=1") == ["", ""]
    assert told("SIM_MAG1_OFS_Y=3") == ["SIM_MAG1_OFS_Y was 3 before, too"] and told("SIM_MAG1_OFS_Y=4") == [""]
    assert told("SIM_SHOVE_X=0.1")[0].endswith("while SIM_SHOVE_TIME is 0")
    assert told("SIM_SHOVE_X=0.1", "SIM_SHOVE_TIME=100") == ["", ""]
    assert told("SIM_GYR_FAIL_MSK=4") != [""] and told("rc:3/stuck") == [""] and told("rc/stuck") == [""]
    unheard = "channel 12 is not transmitted; there are 1, 2, 3, 4, 5, 6, 7, 8"
    assert told("rc:12/stuck") == [unheard] and told("SIM_RC_STUCK=2048") == [unheard]
    service.fail(Failure.of_text("rc:12/stuck"))
    client.delay(0.2)
    client.send("RC_CHANNELS_OVERRIDE", chan12_raw=1500)
    client.delay(0.4)
    assert history.finish(client.simulation.time_us)[-1].spans
    service.fail(Failure.of_text("SIM_TWIST_X=0.1"))
    client.params["SIM_TWIST_TIME"] = 100
    client.delay(0.3)
    assert history.finish(client.simulation.time_us)[-1].spans
    client.simulation.close()
