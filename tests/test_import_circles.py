# SPDX-License-Identifier: BSD-3-Clause
"""Circles of imports are found, also those of types and within functions; this package has none."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

pytest.importorskip("importlinter")  # of the extra dev

import grimp

from tests.import_circles import NoCirclesContract, circles

ROOT = Path(__file__).parents[1]


def graph_of(folder: Path, files: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> grimp.ImportGraph:
    """The imports of a package of these files."""
    package = folder / "made_for_circles"
    package.mkdir()
    for name, text in {"__init__": "", **files}.items():
        (package / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(folder)
    monkeypatch.delitem(sys.modules, package.name, raising=False)
    return grimp.build_graph(package.name, exclude_type_checking_imports=False, cache_dir=None)


TYPES_ONLY = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .a import A\n"
WITHIN = "def f():\n    from .c import g\n    return g\n"


def test_circles_by_types_and_within_functions_are_told(tmp_path, monkeypatch) -> None:
    files = {
        "a": "from .b import x\n",
        "b": TYPES_ONLY,
        "c": "from . import d\n",
        "d": WITHIN,
        "e": "from . import a, d\n",
    }
    graph = graph_of(tmp_path, files, monkeypatch)
    name = "made_for_circles"
    assert circles(graph) == [[f"{name}.a", f"{name}.b"], [f"{name}.c", f"{name}.d"]]
    found = NoCirclesContract("no circles", {}, {}).check(graph, verbose=False)
    assert not found.kept
    assert found.metadata["lines"] == [
        "2 modules need each other:", f"- {name}.a -> {name}.b (l.1)", f"- {name}.b -> {name}.a (l.3)",
        "2 modules need each other:", f"- {name}.c -> {name}.d (l.1)", f"- {name}.d -> {name}.c (l.2)",
    ]  # fmt: skip


def test_a_chain_is_no_circle(tmp_path, monkeypatch) -> None:
    files = {"a": "from . import b, c\n", "b": "from . import c\n", "c": ""}
    graph = graph_of(tmp_path, files, monkeypatch)
    assert circles(graph) == [] and NoCirclesContract("no circles", {}, {}).check(graph, verbose=False).kept


def test_this_package_has_none_and_the_linter_counts_imports_of_types() -> None:
    linter = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    assert linter["exclude_type_checking_imports"] is False
    assert "circles" in [contract["type"] for contract in linter["contracts"]]
    assert circles(grimp.build_graph("sitl", exclude_type_checking_imports=False, cache_dir=None)) == []


def test_each_package_has_its_layer() -> None:
    """Else imports from below and into it are not looked at."""
    linter = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = next(c for c in linter["contracts"] if c["name"] == "imports point downward")["layers"]
    named = {name.strip() for layer in layers for name in layer.split("|")}
    packages = [path.parent for path in (ROOT / "sitl").glob("*/__init__.py")]
    found = {f"sitl.{path.stem}" for path in (*packages, *(ROOT / "sitl").glob("*.py"))}
    # warp stands alone by a contract of its own; the others are the front and the command
    assert found - named == {"sitl.warp", "sitl.__init__", "sitl.__main__"}
