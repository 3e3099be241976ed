# SPDX-License-Identifier: BSD-3-Clause
"""What the flights need of the tree under test, looked up by name: modules may move between two trees."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any


class TreeError(RuntimeError):
    """The tree does not have what a flight needs."""


@cache
def root() -> Path:
    """Folder of the tree under test: where package ``sitl`` is."""
    spec = importlib.util.find_spec("sitl")
    if spec is None or spec.origin is None:
        raise TreeError("package sitl cannot be imported: set PYTHONPATH to the tree under test")
    return Path(spec.origin).parents[1]


@cache
def locate(name: str, module: str) -> Any:
    """The class or function ``name``: of the module, else of any module of the tree that defines it.

    Raises:
        TreeError: no module defines it.
    """
    with contextlib.suppress(ImportError, AttributeError):
        return getattr(importlib.import_module(module), name)
    definition = re.compile(rf"^(class|def) {re.escape(name)}\b", re.MULTILINE)
    for path in sorted((root() / "sitl").rglob("*.py")):
        if definition.search(path.read_text(encoding="utf-8")):
            parts = path.relative_to(root()).with_suffix("").parts
            return getattr(importlib.import_module(".".join(parts).removesuffix(".__init__")), name)
    raise TreeError(f"nothing in {root()} defines {name}; looked in {module} first")


def record(simulation: Any) -> tuple[Any, bytes]:
    """Type and bytes of the vehicle's record."""
    return simulation.fleet.dtype, simulation.fleet[simulation.index].tobytes()


def connect(simulation: Any, tap: Any) -> Any:
    """A client's end of a link to the vehicle; ``tap.frame(time_us, raw)`` gets every frame, in and out."""
    link = locate("InProcessLink", "sitl.bridge.links.inprocess")()
    simulation.bridge.add_link(link)
    simulation.bridge.taps.append(tap)
    return link


@cache
def library() -> dict[str, dict[str, Any]]:
    """The missions of the library: "copter/square" -> its row of the index, with the path of its file."""
    index = root() / "sitl/missions/library/index.toml"
    if not index.is_file():
        raise TreeError(f"there is no {index}")
    return {
        f"{kind}/{name}": {**row, "path": index.parent / row["file"]}
        for kind, found in tomllib.loads(index.read_text(encoding="utf-8")).items()
        for name, row in found.items()
    }


def mission_items(path: Path) -> list[dict[str, Any]]:
    """Items of a mission file, home first: frame, command, p1 .. p4, x, y [degE7], z [m], autocontinue."""
    items = locate("load", "sitl.missions.files.store")(path).mission.items
    fields = ("frame", "command", "p1", "p2", "p3", "p4", "x", "y", "z", "autocontinue")
    return [{name: getattr(item, name) for name in fields} for item in items]
