# SPDX-License-Identifier: BSD-3-Clause
"""Faults as a bridge carries them out: what INJECT_FAILURE takes, what a client sets meanwhile, when a fault acts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from sitl.bridge.services.failure_injection import FaultService
from sitl.client import Client
from sitl.errors import OptionError
from sitl.simulation import Core, Simulation
from sitl.vehicle.faults import Failure

ACCEPTED, DENIED, UNSUPPORTED = 0, 2, 3
OK, OFF, STUCK, WRONG = 0, 1, 2, 4
GYRO, GPS, FLOW, BATTERY, MOTOR, RC = 0, 4, 5, 100, 101, 104


@pytest.fixture(scope="module")
def flown(core: Core) -> Client:
    return Client(Simulation("erle_copter", core=core, params={"SYS_FAILURE_EN": 1}))


@pytest.fixture
def client(flown: Client) -> Iterator[Client]:
    """A copter on the ground without faults; what a test does to it is undone."""
    with flown.fork():
        service = flown.simulation.bridge.get(FaultService)
        service.history = None
        service.keep_history()
        yield flown


def order(client: Client, *params: float) -> int:
    return int(client.request("INJECT_FAILURE", *params) or 0)


def told(client: Client) -> list[str]:
    found = client.simulation.bridge.get(FaultService).history
    assert found is not None
    return [str(acted).removeprefix("fault ") for acted in found.finish(client.simulation.time_us)]


@pytest.mark.parametrize(
    ("params", "result"),
    [
        ((GPS, OFF, 0), ACCEPTED), ((GPS, OFF, 1), ACCEPTED), ((GPS, OFF, 3), DENIED), ((GPS, OFF, -1), DENIED),
        ((GPS, 0.5, 0), UNSUPPORTED), ((GPS, -1, 0), UNSUPPORTED), ((GPS, 7, 0), ACCEPTED), ((GPS, 8, 0), UNSUPPORTED),
        ((MOTOR, OFF, 4), ACCEPTED), ((MOTOR, OFF, 5), DENIED), ((MOTOR, OK, 4), ACCEPTED), ((MOTOR, OK, 5), DENIED),
        ((RC, STUCK, 16), ACCEPTED), ((RC, STUCK, 17), DENIED), ((RC, OFF, 1), ACCEPTED), ((RC, OFF, 2), DENIED),
        ((GYRO, OFF, 2), ACCEPTED), ((GYRO, OFF, 3), DENIED), ((99, OFF, 0), UNSUPPORTED),
    ],
)  # fmt: skip
def test_units_types_and_instances(client: Client, params: Any, result: int) -> None:
    """FAILURE_UNIT, FAILURE_TYPE; instances from 1, 0 is all of them."""
    assert order(client, *params) == result


def test_a_repair_is_of_one_instance_or_of_all(client: Client) -> None:
    for motor in (1, 2, 4):
        order(client, MOTOR, OFF, motor)
    assert client.params["SIM_ENGINE_FAIL"] == 0b1011
    order(client, MOTOR, OK, 2)
    assert client.params["SIM_ENGINE_FAIL"] == 0b1001
    order(client, MOTOR, OK, 0)
    assert client.params["SIM_ENGINE_FAIL"] == 0 and client.simulation.bridge.get(FaultService).texts == []


def test_what_a_client_sets_meanwhile_stays(client: Client) -> None:
    service = client.simulation.bridge.get(FaultService)
    client.simulation.fail("battery=9")
    assert service.texts == ["battery/wrong=9.0@" + service.texts[0].split("@")[1]] and not service.is_setting
    client.params["SIM_BATT_VOLTAGE"] = 11.0
    client.delay(0.2)
    assert client.params["SIM_BATT_VOLTAGE"] == 11.0
    client.simulation.repair()
    assert client.params["SIM_BATT_VOLTAGE"] == 11.0


@pytest.mark.parametrize(
    ("override", "why"),
    [
        ({}, "channel 10 is not transmitted; there are 1, 2, 3, 4, 5, 6, 7, 8"),
        ({"chan10_raw": 1500}, ""),
        ({"chan9_raw": 1500}, "channel 10 is not transmitted; there are 1, 2, 3, 4, 5, 6, 7, 8, 9"),
    ],
)
def test_a_channel_that_a_client_overrides_is_transmitted(client: Client, override: dict[str, int], why: str) -> None:
    client.simulation.v.autopilot.rc.channels[:8] = 1500
    client.send("RC_CHANNELS_OVERRIDE", target_system=1, target_component=1, **override)
    client.delay(0.5)
    client.simulation.fail("rc:10/stuck")
    client.delay(1.0)
    (text,) = told(client)
    assert (f"never acted: {why}" in text) if why else ("acted from" in text)


def test_a_fault_that_begins_later_is_carried_out_after_a_reboot(client: Client) -> None:
    at = client.now + 8.0
    client.simulation.fail(f"gps/off@{at}")
    client.simulation.bridge.vehicle.request_reboot()
    client.delay(2.0)
    assert client.params["SIM_GPS1_ENABLE"] == 1.0
    client.delay(7.0)
    assert client.params["SIM_GPS1_ENABLE"] == 0.0


def test_who_begins_to_transmit_is_heard_within_a_tenth_of_a_second(client: Client) -> None:
    client.simulation.v.autopilot.rc.channels[:8] = 1500
    client.simulation.fail("rc:10/stuck")
    client.delay(1.0)
    client.simulation.v.autopilot.rc.channels[9] = 1500
    begins = client.now
    client.delay(1.0)
    history = client.simulation.bridge.get(FaultService).keep_history()
    history.finish(client.simulation.time_us)
    ((begin, _),) = history.faults[0].spans
    assert 0.0 <= begin * 1e-6 - begins <= 0.11


def test_what_fails_is_told_to_who_wants_to_know(client: Client) -> None:
    service = client.simulation.bridge.get(FaultService)
    acted = service.fail(Failure.of_text("gps/off"))
    assert acted is not None and "gps/off" in str(acted)
    service.history = None
    assert service.fail(Failure.of_text("battery=9")) is None, "nobody does"
    assert service.texts[0].startswith("gps/off") and service.texts[1].startswith("battery/wrong=9")


@pytest.mark.parametrize("fault", ["motor:5/off", "flow/off", "lidar:2/off"])
def test_what_is_not_fitted_does_not_fail(client: Client, fault: str) -> None:
    service = client.simulation.bridge.get(FaultService)
    with pytest.raises(OptionError):
        service.fail(Failure.of_text(fault))
    assert service.texts == []


def test_without_leave_nothing_is_injected_and_what_is_not_fitted_is_unsupported(client: Client) -> None:
    """SYS_FAILURE_EN; optical flow is none of this vehicle's."""
    assert order(client, FLOW, OFF, 0) == UNSUPPORTED
    assert order(client, 101.5, OFF, 0) == order(client, MOTOR, 6, 0) == UNSUPPORTED, "no such unit, no such type of it"
    assert order(client, MOTOR, OFF, 1.5) == DENIED
    client.params["SYS_FAILURE_EN"] = 0
    assert order(client, GPS, OFF, 0) == UNSUPPORTED and client.params["SIM_GPS1_ENABLE"] == 1.0


@pytest.mark.parametrize(
    ("fault", "idle", "refused"),
    [
        ("motor:1/off", ("SIM_ENGINE",), True), ("motor/off", ("SIM_ENGINE",), True),
        ("gps/off", ("SIM_ENGINE",), False), ("gps/off", ("SIM_GPS1",), False), ("gps:1/off", ("SIM_GPS1",), True),
        ("motor:1/off", (), False),
    ],
)  # fmt: skip
def test_what_does_nothing_to_this_physics_is_refused(
    client: Client, monkeypatch: pytest.MonkeyPatch, fault: str, idle: Any, refused: bool
) -> None:
    """Of all instances some may do nothing."""
    vehicle: Any = client.simulation.bridge.vehicle
    monkeypatch.setattr(type(vehicle.plant), "idle_parameters", idle)
    service = client.simulation.bridge.get(FaultService)
    if not refused:
        service.check(Failure.of_text(fault))
        return
    with pytest.raises(OptionError) as told:
        service.check(Failure.of_text(fault))
    said, _, there = str(told.value).partition("; there are ")
    assert (
        said.startswith(f"fault {fault.split('/')[0].split(':')[0]}: {idle[0]}") and "does nothing to physics" in said
    )
    assert "battery" in there.split(", ") and fault.split(":")[0].split("/")[0] not in there.split(", ")


def test_faults_of_motors_act_while_it_is_armed(client: Client) -> None:
    client.simulation.fail("motor:1/off")
    client.delay(0.5)
    assert told(client) == ["motor:1/off never acted: the vehicle was not armed"]


def test_a_parameter_that_a_client_set_is_named(client: Client) -> None:
    client.simulation.fail("battery=9")
    client.params["SIM_BATT_VOLTAGE"] = 11.0
    client.delay(0.2)
    assert "a client set SIM_BATT_VOLTAGE meanwhile" in told(client)[0]


def test_a_history_that_begins_later_knows_what_was_ordered_before(client: Client) -> None:
    service = client.simulation.bridge.get(FaultService)
    service.history = None
    client.simulation.fail("gps/off")
    client.delay(0.2)
    history = service.keep_history()
    assert [acted.title for acted in history.faults] == ["gps/off"] and service.keep_history() is history
    client.delay(0.2)
    assert "acted from" in told(client)[0]
