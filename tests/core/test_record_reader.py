# SPDX-License-Identifier: BSD-3-Clause
"""Fast readers of records against numpy's own access."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.record_reader import RecordReader, UnknownFieldError
from tests.bridge.fakes import FakeVehicle


def fill(vehicle: FakeVehicle) -> None:
    words = vehicle.fleet.view("u1").reshape(-1)
    words[:] = np.random.default_rng(1).integers(0, 63, words.size, dtype="u1")


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
    fleet = np.zeros(2, np.dtype([("a", "f4"), ("b", "i4", 3), ("c", "i8")], align=True))
    fleet["a"], fleet["b"], fleet["c"] = 1.5, [1, 2, 3], -4
    assert RecordReader(fleet, 1).fields("c", "b", "a")() == (-4, 1, 2, 3, 1.5)
