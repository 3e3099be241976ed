# SPDX-License-Identifier: BSD-3-Clause
"""Which faults have acted, from when to when, and why others have not."""

from __future__ import annotations

import pytest

from sitl.bridge.services.failure_injection import FaultService
from sitl.client import Client
from sitl.core.constants import NEVER
from sitl.simulation import Simulation
from sitl.vehicle.fault_history import Acted, FaultHistory
from sitl.vehicle.ordered_faults import Ordered

S = 1_000_000
GPS = ("gps/off@2.0", 2 * S)


def history(lasts_us: int = NEVER) -> tuple[FaultHistory, Acted]:
    found = FaultHistory()
    return found, found.ordered(Ordered(*GPS), lasts_us)


def test_from_begin_to_end() -> None:
    faults, gps = history()
    faults.look(0, {})
    faults.look(2 * S, {GPS: ""})
    faults.look(3 * S, {GPS: ""})
    assert gps.spans == []
    faults.finish(4 * S)
    assert str(gps) == "fault gps/off acted from 2.0 to 4.0 s"
    faults.look(5 * S, {})
    assert str(faults.finish(9 * S)[0]) == "fault gps/off acted from 2.0 to 5.0 s"


def test_while_it_does_something() -> None:
    faults, gps = history()
    for at, why in ((2, "it was off"), (3, ""), (4, "it was off"), (6, ""), (7, "it was off")):
        faults.look(at * S, {GPS: why})
    faults.finish(9 * S)
    assert gps.spans == [(3 * S, 4 * S), (6 * S, 7 * S)]


def test_what_went_by_before_a_snapshot_was_restored_counts() -> None:
    faults, gps = history()
    faults.look(2 * S, {GPS: ""})
    faults.look(5 * S, {GPS: ""})
    faults.look(1 * S, {})
    assert gps.spans == [(2 * S, 5 * S)]
    faults.look(2 * S, {GPS: ""})
    faults.look(4 * S, {GPS: ""})
    faults.look(3 * S, {GPS: ""})  # back to a moment in which it acts
    faults.finish(6 * S)
    assert gps.spans == [(2 * S, 5 * S), (2 * S, 4 * S), (3 * S, 6 * S)]


def test_no_longer_than_it_lasts() -> None:
    faults, gps = history(lasts_us=S // 2)
    faults.look(2 * S, {GPS: ""})
    faults.look(3 * S, {GPS: ""})
    faults.finish(9 * S)
    assert gps.spans == [(2 * S, 5 * S // 2)]


@pytest.mark.parametrize(
    ("now", "states", "why"),
    [
        (1, {}, "it begins at 2.0 s, and the flight ended at 1.0 s"),
        (2, {GPS: ""}, "no simulated time went by"),
        (3, {GPS: "it was off"}, "it was off"),
        (3, {}, "it was repaired before it began"),
    ],
)
def test_why_it_never_acted(now: int, states: dict[tuple[str, int], str], why: str) -> None:
    faults, gps = history()
    faults.look(now * S, states)
    faults.finish(now * S)
    assert not gps.spans and str(gps) == f"fault gps/off never acted: {why}"


def told(client: Client) -> list[str]:
    found = client.simulation.bridge.get(FaultService).history
    assert found is not None
    return [str(acted).removeprefix("fault ") for acted in found.finish(client.simulation.time_us)]


def test_of_a_flight() -> None:
    client = Client(Simulation("erle_copter", faults=["gps@2..3", "motor:1=0.9@1", "rc@9999", "wind=0", "motor:2=1"]))
    service = client.simulation.bridge.get(FaultService)
    service.keep_history()
    client.delay(6.0)
    assert told(client) == [
        "gps/off acted from 2.0 to 3.0 s",
        "motor:1/off=0.9 never acted: the vehicle was not armed",
        "rc/off never acted: it begins at 9999.0 s, and the flight ended at 6.0 s",
        "wind/wrong=0.0 never acted: SIM_WIND_SPD was 0 before, too",
        "motor:2/off=1.0 never acted: all of the pulse is left",
    ]
    client.wait_ready()
    client.arm()
    armed = client.now
    with client.fork():
        client.delay(2.0)
    client.disarm()
    begin, end = service.history.faults[1].spans[0]  # type: ignore[union-attr]
    assert begin * 1e-6 == pytest.approx(armed, abs=0.2) and end - begin > 1.9 * S
    client.simulation.fail("battery=9")
    client.delay(1.0)
    client.params["SIM_BATT_VOLTAGE"] = 12.0
    now = client.now
    client.reboot()
    client.delay(3.0)
    begin, end = service.history.faults[-1].spans[0]  # type: ignore[union-attr]
    assert end * 1e-6 == pytest.approx(now, abs=0.3) and len(service.history.faults[-1].spans) == 1  # type: ignore[union-attr]
    client.simulation.close()


def test_a_sensor_that_is_switched_off_later() -> None:
    client = Client(Simulation("erle_copter", faults=["gps/wrong=20@5"], params={"GPS2_TYPE": 1}))
    client.simulation.bridge.get(FaultService).keep_history()
    client.params["SIM_GPS1_ENABLE"] = 0
    client.delay(8.0)
    assert told(client) == [
        "gps/wrong=20.0 never acted: airframe erle_copter has no gps 1: SIM_GPS1_ENABLE is 0, not 1"
    ]
    client.simulation.close()
