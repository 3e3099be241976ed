# SPDX-License-Identifier: BSD-3-Clause
"""What versions promise to keep is what public_surface.txt says: no change of it goes unnoticed."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import sitl
from tests import public_surface

ROOT = Path(__file__).parents[1]
CHANGED = "the public surface changed: see docs/reference/versioning.md, then run python -m tests.public_surface"


def test_the_public_surface_is_the_one_that_is_kept() -> None:
    kept = public_surface.FILE.read_text(encoding="utf-8").splitlines()
    now = public_surface.lines()
    gone, new = sorted(set(kept) - set(now)), sorted(set(now) - set(kept))
    assert not gone and not new, f"{CHANGED}\ngone: {gone}\nnew: {new}"
    assert now == kept, CHANGED


def test_arguments_are_part_of_it() -> None:
    def example(a, b: int = 1, *rest, c=(), **more) -> None: ...

    assert public_surface.arguments(example) == "(a, b=1, *rest, c=..., **more)"
    assert public_surface.arguments(ValueError) == "" and public_surface.arguments(3) == ""


def test_the_page_names_each_public_module() -> None:
    page = (ROOT / "docs/reference/versioning.md").read_text(encoding="utf-8")
    for name in public_surface.MODULES:
        assert f"`{name}`" in page, name
        assert import_module(name).__all__, name


def test_the_version_is_told_once_and_the_changelog_has_it() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+(\.dev\d+|rc\d+)?", sitl.__version__)
    release = re.split(r"\.dev|rc", sitl.__version__)[0]
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## (\S+)(.*)$", changes, re.M)
    assert newest is not None and newest[1] == release
    assert ("unreleased" in newest[2]) == ("dev" in sitl.__version__)
    assert f"version: {sitl.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
