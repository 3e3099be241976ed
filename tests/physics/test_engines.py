# SPDX-License-Identifier: BSD-3-Clause
"""Engines by name: what cannot be registered or found is refused clearly. One of another package flies in
docs/extending.md."""

from __future__ import annotations

import sys

import pytest

from sitl.errors import MissingExtra
from sitl.physics import engines
from sitl.physics.engine import EngineError
from sitl.plants.local import LocalPlant, stand_alone

OURS = {"pybullet": "sitl.physics.engine:Engine"}


@pytest.fixture(autouse=True)
def nothing_registered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "_registered", {})


@pytest.mark.parametrize(
    ("name", "place", "message"),
    (
        ("jsbsim", "lift:Lift", "physics 'jsbsim' comes with the simulator; choose another name"),
        ("lift", "lift.Lift", "must be written as \"module:FUNCTION\", not 'lift.Lift'"),
    ),
)
def test_what_cannot_be_registered(name: str, place: str, message: str) -> None:
    with pytest.raises(EngineError) as caught:
        engines.register_engine(name, "copter", place)
    assert message in str(caught.value)
    assert engines.backends() == engines.BACKENDS


@pytest.mark.parametrize(
    ("place", "message"),
    (
        ("no_such_lift:Lift", "physics 'lift' at no_such_lift:Lift: No module named 'no_such_lift'"),
        ("sitl.physics.engine:Lift", "physics 'lift' at sitl.physics.engine:Lift: module"),
    ),
)
def test_one_that_cannot_be_imported_is_named(place: str, message: str) -> None:
    engines.register_engine("lift", "copter", place)
    with pytest.raises(EngineError) as caught:
        engines.find("lift", "copter", OURS)
    assert str(caught.value).startswith(message)


def test_one_of_another_kind_is_refused_and_one_that_nobody_has() -> None:
    engines.register_engine("lift", "rover", "sitl.physics.engine:Engine")
    with pytest.raises(
        EngineError, match="physics 'lift' has no model of a copter; it is simulated by native, pybullet"
    ):
        engines.find("lift", "copter", OURS)
    with pytest.raises(EngineError, match="physics 'crane' is not known; there are native, pybullet, jsbsim, lift"):
        engines.find("crane", "copter", OURS)


@pytest.mark.parametrize("name", engines.ENGINES)
def test_a_library_that_is_not_installed_is_said_before_anything_is_compiled(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    compiled: list[object] = []
    monkeypatch.setattr(LocalPlant, "_unit", lambda self, unit: compiled.append(unit))
    with pytest.raises(MissingExtra, match=rf"physics '{name}' needs {name}: pip install 'gym-sitl\[{name}\]'"):
        stand_alone("erle_copter", physics=name)
    assert not compiled
