# SPDX-License-Identifier: BSD-3-Clause
"""Pages of environments say what their code says."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

import sitl.envs

DOCS = Path(__file__).parents[2] / "docs"
_spec = importlib.util.spec_from_file_location("make_environment_pages", DOCS / "make_environment_pages.py")
assert _spec is not None and _spec.loader is not None
pages = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(pages)


@pytest.mark.parametrize("name", ["CopterHover", "RoverReachGoal", "CopterGates"])
def test_a_page_is_what_the_code_says(name: str) -> None:
    assert (DOCS / "envs" / f"{name}.md").read_text(encoding="utf-8") == pages.page(name), (
        "run: python docs/make_environment_pages.py"
    )


def test_every_environment_with_places_has_a_page() -> None:
    listed = (DOCS / "envs" / "index.md").read_text(encoding="utf-8")
    for name in sitl.envs.NEW:
        word = name.removeprefix("sitl/").removesuffix("-v1").removesuffix("Discrete")
        assert f"({word}.md)" in listed and (DOCS / "envs" / f"{word}.md").is_file()


def test_an_environment_without_a_title_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(pages.TITLES, "CopterHover")
    with pytest.raises(SystemExit, match=r"without one: \['CopterHover'\]; titles of none: \[\]"):
        pages.main()
