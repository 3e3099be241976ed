# SPDX-License-Identifier: BSD-3-Clause
"""The library's files are what their drafts make, and its index says of each where it is flown."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import vehicles, worlds
from sitl.errors import OptionError
from sitl.missions import library
from sitl.missions.files import load
from sitl.missions.library import make


def test_the_files_are_what_the_drafts_make(tmp_path: Path) -> None:
    """Else: python -m sitl.missions.library.make."""
    make.write(tmp_path)
    made = {path.relative_to(tmp_path): path.read_text() for path in tmp_path.rglob("*") if path.is_file()}
    for path, text in made.items():
        assert (library.FOLDER / path).read_text() == text, path
    kept = {p.relative_to(library.FOLDER) for p in library.FOLDER.glob("*/*") if p.parent.name in ("copter", "rover")}
    assert kept == {path for path in made if len(path.parts) == 2}


def test_every_entry_has_its_vehicle_and_world() -> None:
    assert len(library.entries()) > 25
    for entry in library.entries().values():
        assert vehicles.load(entry.frame).kind == entry.kind
        assert entry.world is None or entry.world in worlds.names()
        assert entry.description and "\n" not in entry.description
        assert load(entry.path).mission.present


def test_an_unknown_name_is_told() -> None:
    with pytest.raises(OptionError, match="no mission 'copter/loop'; there are copter/square, "):
        library.find("copter/loop")
