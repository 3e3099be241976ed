# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import random

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.copter.parameters import TABLE
from tests.bridge.fakes import Bench, Client


def read(bench: Bench, name: str = "", index: int = -1) -> list[object]:
    return bench.ask(mavlink.MAVLink_param_request_read_message(1, 1, name.encode(), index))


def write(bench: Bench, name: str, value: float, kind: int = 9) -> list[object]:
    return bench.ask(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, kind))


def test_read_by_name_and_index(bench: Bench) -> None:
    (answer,) = read(bench, "MAV_GCS_SYSID")
    assert (answer.param_id, answer.param_value, answer.param_type) == ("MAV_GCS_SYSID", 255.0, 4)
    assert (answer.param_index, answer.param_count) == (65535, len(TABLE))
    (answer,) = read(bench, index=TABLE.names().index("MAV_GCS_SYSID"))
    assert (answer.param_id, answer.param_index) == ("MAV_GCS_SYSID", TABLE.names().index("MAV_GCS_SYSID"))
    assert read(bench, "NO_SUCH") == read(bench, index=len(TABLE)) == read(bench, index=32767) == []


def test_set_truncates_integers_and_tells_everyone(bench: Bench) -> None:
    other = bench.connect(system=250)
    (answer,) = write(bench, "MAV_GCS_SYSID", 33.7)
    assert (answer.param_value, answer.param_index) == (33.0, 65535)
    assert [m.param_value for m in other.receive("PARAM_VALUE")] == [33.0]
    assert bench.vehicle.v.autopilot.params.MAV_GCS_SYSID == 33.0
    assert ("parameter_changed", "MAV_GCS_SYSID") in bench.autopilot.calls
    assert write(bench, "NO_SUCH", 1.0) == []


@pytest.mark.parametrize("value", [1e9, -1e9, math.nan, math.inf, -math.inf])
def test_what_is_out_of_range_is_refused_with_the_old_value(bench: Bench, value: float) -> None:
    before = bench.vehicle.fleet.tobytes()
    answers = write(bench, "MAV_GCS_SYSID", value)
    assert bench.vehicle.fleet.tobytes() == before
    assert [m.param_value for m in answers if m.get_type() == "PARAM_VALUE"] == [255.0]
    assert any("MAV_GCS_SYSID" in m.text for m in answers if m.get_type() == "STATUSTEXT")


def test_a_new_system_id_holds_at_once(bench: Bench) -> None:
    write(bench, "MAV_SYSID", 7.0)
    assert read(bench, "MAV_SYSID") == []
    answers = bench.ask(mavlink.MAVLink_param_request_read_message(7, 1, b"MAV_SYSID", -1))
    assert [(m.get_srcSystem(), m.param_value) for m in answers] == [(7, 7.0)]


def fetch_all(bench: Bench, client: Client) -> dict[str, float]:
    """As ground stations do: the list, then what is missing, one by one."""
    found: dict[int, tuple[str, float]] = {}
    count = None
    for _ in range(50):
        if count is None or not found:
            client.send(mavlink.MAVLink_param_request_list_message(1, 1))
        else:
            for k in [k for k in range(count) if k not in found]:
                client.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", k))
        bench.run(1.0)
        for m in client.receive("PARAM_VALUE"):
            count = m.param_count
            found[m.param_index] = (m.param_id, m.param_value)
        if count is not None and len(found) == count:
            return dict(found.values())
    raise AssertionError(f"{len(found)} of {count}")


@pytest.mark.parametrize("drop", [0.0, 0.05, 0.3])
def test_the_whole_list_even_over_a_lossy_link(bench: Bench, drop: float) -> None:
    rng = random.Random(1)
    client = bench.connect(drop_to_client=lambda _: rng.random() < drop, drop_to_vehicle=lambda _: rng.random() < drop)
    values = fetch_all(bench, client)
    assert values.keys() == set(TABLE.names())
    for name, value in values.items():
        assert value == pytest.approx(bench.vehicle.v.autopilot.params[name], rel=1e-6)


def test_the_list_is_paced(bench: Bench) -> None:
    bench.client.send(mavlink.MAVLink_param_request_list_message(1, 1))
    bench.run(0.02)
    assert 0 < len(bench.client.receive("PARAM_VALUE")) <= 30
