# SPDX-License-Identifier: BSD-3-Clause
"""What recordings say of the version that made them: code that flies, and nothing of the machine."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.core import compile as compiler
from sitl.missions.cli.replay import verdict
from sitl.recording import identity
from sitl.vehicle.copter import COPTER
from sitl.vehicle.rover import ROVER


@pytest.mark.parametrize("kind", [COPTER, ROVER], ids=lambda kind: kind.name)
def test_processor_and_compilers_are_no_part_of_it(kind: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    before = identity.version(kind)
    identity._compiled.cache_clear()
    monkeypatch.setattr(compiler, "toolchain", lambda: "another Python, Numba and processor")
    monkeypatch.setattr(compiler, "_fingerprints", {})
    assert identity.version(kind) == before


def test_changed_laws_are_part_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    before = identity.version(COPTER)
    identity._compiled.cache_clear()
    was = compiler.unit_identity
    changed = "autopilot.copter.control.control_step.update"
    monkeypatch.setattr(compiler, "unit_identity", lambda u, path: was(u, path) + ("x" if u.name == changed else ""))
    after = identity.version(COPTER)
    identity._compiled.cache_clear()
    assert identity.code_differences(before, after) == ["another compiled core (modes or parameters of other packages)"]


@pytest.mark.parametrize("other", [True, False])
def test_a_replay_that_differs_says_whether_another_version_recorded_it(
    other: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    differences = ["sources of physics"] if other else []
    flown: Any = SimpleNamespace(differences=differences, other_version=other)
    assert verdict(flown, ["telemetry differs"], exact=False) == (0 if other else 1)
    said = capsys.readouterr().out
    assert "the flight differs: telemetry differs\n" in said
    assert ("another version of the simulator made the recording" in said) is other
