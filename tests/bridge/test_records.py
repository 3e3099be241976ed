# SPDX-License-Identifier: BSD-3-Clause
"""Fast readers and views against numpy's own access."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fakes import FakeVehicle

from sitl.bridge.record_reader import RecordReader, UnknownFieldError
from sitl.bridge.record_view import RecordView, record_view
from sitl.core.records import record, view


def fill(vehicle: FakeVehicle) -> None:
    words = vehicle.fleet.view("u1").reshape(-1)
    words[:] = np.random.default_rng(1).integers(0, 63, words.size, dtype="u1")


def compare(ours: Any, theirs: Any) -> int:
    """Compare all fields, nested; gives their number."""
    count = 0
    for name in theirs.dtype.names:
        a, b = getattr(ours, name), theirs[name]  # by key: "flags" is also an attribute of numpy's own
        if isinstance(a, RecordView):
            count += compare(a, b)
        else:
            assert np.array_equal(a, b), name
            count += 1
    return count


def test_the_view_reads_and_writes_every_field() -> None:
    vehicle = FakeVehicle()
    fill(vehicle)
    ours = record_view(vehicle.fleet, 1)
    assert compare(ours, vehicle.v) > 300
    ours.autopilot.estimate.pos[1] = 5.5
    ours.autopilot.modes.number = True
    ours.sensors.gps_lat = 17
    ours.autopilot.params["MAV_SYSID"] = 3
    assert vehicle.v.autopilot.estimate.pos[1] == 5.5
    assert (vehicle.v.autopilot.modes.number, vehicle.v.sensors.gps_lat) == (1, 17)
    assert ours.autopilot.params["MAV_SYSID"] == vehicle.v.autopilot.params.MAV_SYSID == 3.0
    assert vehicle.fleet[0]["autopilot"]["modes"]["number"] != 1


def test_a_view_has_no_other_fields() -> None:
    ours = record_view(FakeVehicle().fleet, 0)
    with pytest.raises(AttributeError):
        ours.autopilot.nonsense = 1


def test_readers_give_fields_in_the_order_asked() -> None:
    vehicle = FakeVehicle()
    fill(vehicle)
    reader = RecordReader(vehicle.fleet, 1)
    e = vehicle.v.autopilot.estimate
    assert reader.fields("autopilot.estimate.pos", "time_us", "autopilot.estimate.euler")() == (
        *e.pos, vehicle.v.time_us, *e.euler
    )  # fmt: skip
    assert reader.field("sensors.gps_fix")() == vehicle.v.sensors.gps_fix


@pytest.mark.parametrize("path", ["nonsense", "autopilot.nonsense", "autopilot", "time_us.x"])
def test_unknown_fields_are_named(path: str) -> None:
    with pytest.raises(UnknownFieldError, match=path.split(".")[-1]):
        RecordReader(FakeVehicle().fleet, 0).field(path)


def test_small_types() -> None:
    fleet = np.zeros(2, record(("a", "f4"), ("b", "i4", 3), ("c", "i8")))
    fleet["a"], fleet["b"], fleet["c"] = 1.5, [1, 2, 3], -4
    assert RecordReader(fleet, 1).fields("c", "b", "a")() == (-4, 1, 2, 3, 1.5)
    ours = record_view(fleet, 1)
    ours.a, ours.c = 2.5, 9.0
    assert view(fleet, 1).a == 2.5 and fleet["c"][1] == 9 and fleet["c"][0] == -4
