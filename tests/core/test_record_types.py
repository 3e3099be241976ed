# SPDX-License-Identifier: BSD-3-Clause
"""Records against numpy's own access to the same memory."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sitl.core.numba_records import numba_type
from sitl.core.records import Float32, Ints, Record, array, as_dict
from sitl.core.vectors import Value
from sitl.vehicle.copter import Copter
from sitl.vehicle.rover import Rover


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
