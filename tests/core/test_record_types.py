# SPDX-License-Identifier: BSD-3-Clause
"""Records and their fast readers against numpy's own access to the same memory."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import pytest

from sitl.core.numba_records import numba_type
from sitl.core.record_reader import RecordReader, UnknownFieldError
from sitl.core.records import Float32, Ints, Record, Records, Stored, array, as_dict, repeat
from sitl.core.vectors import Quat, Value, Vec3
from sitl.vehicle.copter import Copter
from sitl.vehicle.rover import Rover
from tests.bridge.fakes import FakeVehicle


class Small(Record):
    a: Float32
    b: Ints = array(3, stored="i4")
    c: int


def filled() -> np.ndarray[Any, Any]:
    fleet = Copter.fleet(2)
    words = fleet.view("u1").reshape(-1)
    words[:] = np.random.default_rng(1).integers(0, 63, words.size, dtype="u1")
    return fleet


def compare(ours: Any, theirs: Any) -> int:
    """Compare all fields, nested; gives their number."""
    count = 0
    for name in theirs.dtype.names:
        a, b = getattr(ours, name), theirs[name]
        if isinstance(a, Record):
            count += compare(a, b)
        elif isinstance(a, tuple) and not isinstance(a, Value):
            count += sum(compare(one, other) for one, other in zip(a, b, strict=True))
        else:
            assert np.array_equal(a, b != 0 if isinstance(a, bool) else b), name
            assert isinstance(a, float | int | np.ndarray | Value), name
            count += 1
    return count


def test_the_view_reads_every_field() -> None:
    fleet = filled()
    assert compare(Copter.of(fleet, 1), fleet[1]) > 300
    assert compare(Copter.of(fleet, -2), fleet[0]) > 300
    with pytest.raises(IndexError):
        Copter.of(fleet, 2)


def test_writes_go_to_the_fleet() -> None:
    fleet = filled()
    ours, theirs, other = Copter.of(fleet, 1), fleet[1]["autopilot"], fleet[0].copy()
    ours.autopilot.estimate.pos = ours.autopilot.estimate.pos.replace(y=5.5)
    ours.autopilot.estimate.vel = (1.0, 2.0, 3.0)
    ours.autopilot.modes.number = True
    ours.sensors.gps_lat = 17
    ours.autopilot.params["MAV_SYSID"] = 3
    assert theirs["estimate"]["pos"][1] == 5.5
    assert theirs["estimate"]["vel"].tolist() == list(ours.autopilot.estimate.vel) == [1.0, 2.0, 3.0]
    assert (theirs["modes"]["number"], fleet[1]["sensors"]["gps_lat"]) == (1, 17)
    assert ours.autopilot.params["MAV_SYSID"] == theirs["params"]["MAV"]["SYSID"] == 3.0
    assert fleet[0] == other


def test_whole_records_are_copied() -> None:
    fleet = filled()
    ours = Copter.of(fleet, 0)
    ours.physics = np.zeros((), Copter.dtype["physics"])
    ours["autopilot"].home = Copter.of(fleet, 1).autopilot.home
    assert not fleet[0]["physics"].tobytes().strip(b"\0")
    assert fleet[0]["autopilot"]["home"] == fleet[1]["autopilot"]["home"]
    assert as_dict(ours.autopilot.home) == as_dict(Copter.of(fleet, 1).autopilot.home)
    with pytest.raises((TypeError, ValueError)):
        ours.physics = np.zeros((), [("a", "f8")])


def test_a_view_has_no_other_fields() -> None:
    with pytest.raises(AttributeError):
        Copter.of(filled(), 0).autopilot.nonsense = 1


def test_small_types() -> None:
    fleet = Small.fleet(3)
    fleet["c"] = -4
    ours = Small.of(fleet, 1)
    ours.a, ours.c = 2.5, 9.0
    assert fleet["a"].tolist() == [0.0, 2.5, 0.0] and fleet["c"].tolist() == [-4, 9, -4]
    with pytest.raises(ValueError, match="one block"):
        Small.of(fleet[::2], 0)


def test_records_of_one_name_and_different_fields_are_different_types() -> None:
    first, second = (type("Twin", (Record,), {"__annotations__": {name: float}}) for name in ("a", "b"))
    assert numba_type(first) != numba_type(second)


def test_symbols_of_compiled_laws_name_their_records():
    """The copter's and the rover's cores are compiled in separate processes and loaded into one."""
    for cls in (Copter, Rover, Small):
        assert numba_type(cls).mangling_args == (numba_type(cls).name, ())


class Vectors(Record):
    narrow: Annotated[Vec3, Stored("f4")]
    whole: Annotated[Vec3, Stored("i4")]
    attitude: Quat
    ready: bool
    rows: Records[Small] = repeat(Small, 2)


def test_values_are_kept_as_wide_as_they_are_declared() -> None:
    v = Vectors()
    v.narrow, v.whole, v.attitude, v.ready = Vec3(0.1, 0, 0), Vec3(1.9, -1.9, 3.0), (1, 0, 0, 0), 7
    assert v.narrow == (float(np.float32(0.1)), 0.0, 0.0) and isinstance(v.narrow, Vec3)
    assert v.whole == (1.0, -1.0, 3.0), "the fraction is cut off, as in the core"
    assert v.attitude.w == 1.0 and v.ready is True
    v.rows[1].c = 4
    assert [row.c for row in v.rows] == [0, 4]
    v.zero("narrow", "rows")
    assert v.narrow == (0.0, 0.0, 0.0) and v.rows[1].c == 0 and v.attitude.w == 1.0


def test_a_vector_of_another_length_is_refused() -> None:
    v = Vectors()
    with pytest.raises(TypeError, match=r"\(1, 2\) does not have the 3 components of a Vec3"):
        v.narrow = (1, 2)
    assert v.narrow == (0.0, 0.0, 0.0)


def test_a_field_that_no_record_can_hold_is_refused() -> None:
    with pytest.raises(TypeError, match="field 'x' is a <class 'str'>; a record holds float, int, bool, Vec2"):
        type("Odd", (Record,), {"__annotations__": {"x": str}})
    with pytest.raises(TypeError, match="attributes of records themselves"):
        type("Odd", (Record,), {"__annotations__": {"fields": float}})


def fill(vehicle: FakeVehicle) -> None:
    words = vehicle.fleet.view("u1").reshape(-1)
    words[:] = np.random.default_rng(1).integers(0, 63, words.size, dtype="u1")


def test_readers_give_fields_in_the_order_asked() -> None:
    vehicle = FakeVehicle()
    fill(vehicle)
    reader = RecordReader(vehicle.fleet, 1)
    e = vehicle.v.autopilot.estimate
    assert reader.fields("autopilot.estimate.pos", "time_us", "autopilot.estimate.vel")() == (
        *e.pos, vehicle.v.time_us, *e.vel
    )  # fmt: skip
    assert reader.field("sensors.gps_fix")() == vehicle.v.sensors.gps_fix


@pytest.mark.parametrize("path", ["nonsense", "autopilot.nonsense", "autopilot", "time_us.x"])
def test_unknown_fields_are_named(path: str) -> None:
    with pytest.raises(UnknownFieldError, match=path.split(".")[-1]):
        RecordReader(FakeVehicle().fleet, 0).field(path)


def test_readers_of_small_types() -> None:
    fleet = np.zeros(2, np.dtype([("a", "f4"), ("b", "i4", 3), ("c", "i8")], align=True))
    fleet["a"], fleet["b"], fleet["c"] = 1.5, [1, 2, 3], -4
    assert RecordReader(fleet, 1).fields("c", "b", "a")() == (-4, 1, 2, 3, 1.5)
