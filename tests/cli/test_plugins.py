# SPDX-License-Identifier: BSD-3-Clause
"""Packages that add to the simulator: the ``sitl`` command imports what they register."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.cli import doctor, main, plugins
from tests.cli.command import ROOT, sitl

ENGINE = "from sitl.physics.engines import register_engine\nregister_engine('toy', 'copter', 'toy_engine:make')\n"


def install(folder: Path, module: str, text: str) -> None:
    """Put a package there whose module ``module`` is a plugin."""
    (folder / f"{module}.py").write_text(text)
    about = folder / "toy-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: toy\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[{plugins.GROUP}]\ntoy = {module}\n")


def toy() -> doctor.Finding:
    return next(found for found in doctor.other_packages() if found.name == "plugin toy")


def test_a_plugin_is_imported_before_the_vehicle_is_made(tmp_path: Path) -> None:
    mission = ROOT / "sitl/missions/library/copter/circles.plan"
    without = sitl("mission", "fly", str(mission), "--physics", "toy", folder=tmp_path)
    assert without.returncode == 2 and "physics 'toy' is not known" in without.stderr
    install(tmp_path, "toy_plugin", ENGINE)
    found = sitl("mission", "fly", str(mission), "--physics", "toy", folder=tmp_path)
    assert found.returncode == 2 and "physics 'toy' at toy_engine:make: No module named 'toy_engine'" in found.stderr


def test_a_plugin_that_cannot_be_imported_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    install(tmp_path, "broken_plugin", "raise RuntimeError('no licence')\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert main(["world", "list"]) == 2
    error = capsys.readouterr().err
    assert error == (
        "sitl world: plugin toy (broken_plugin of package toy) cannot be loaded: RuntimeError('no licence'); mend or "
        "uninstall the package\n"
    )
    looked_at = toy()
    assert looked_at.state == doctor.BROKEN and looked_at.mend == "pip uninstall toy"


def test_doctor_lists_plugins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(tmp_path, "quiet_plugin", "")
    monkeypatch.syspath_prepend(str(tmp_path))
    looked_at = toy()
    assert looked_at.state == doctor.OK and looked_at.what == "plugin toy (quiet_plugin of package toy)"
