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

PACKAGES = ("sitl", "missions", "envs")
"""Top-level packages that a tree may have; those that are not there are passed over."""


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
def locate(name: str, *modules: str) -> Any:
    """The class or function ``name``: of one of the modules, else of any module of the tree that defines it.

    Raises:
        TreeError: no module defines it.
    """
    for module in modules:
        with contextlib.suppress(ImportError, AttributeError):
            return getattr(importlib.import_module(module), name)
    definition = re.compile(rf"^(class|def) {re.escape(name)}\b", re.MULTILINE)
    for package in PACKAGES:
        for path in sorted((root() / package).rglob("*.py")):
            if definition.search(path.read_text(encoding="utf-8")):
                parts = path.relative_to(root()).with_suffix("").parts
                return getattr(importlib.import_module(".".join(parts).removesuffix(".__init__")), name)
    raise TreeError(f"nothing in {root()} defines {name}; looked in {', '.join(modules)} first")


def simulation(frame: str, **options: Any) -> Any:
    """A vehicle at power-on."""
    return locate("Simulation", "sitl.simulation", "sitl")(frame, **options)


def record(sim: Any) -> tuple[Any, bytes]:
    """Type and bytes of the vehicle's record."""
    return sim.fleet.dtype, sim.fleet[sim.index].tobytes()


def connect(sim: Any, tap: Any) -> Any:
    """A client's end of a link to the vehicle; ``tap.frame(time_us, raw)`` gets every frame, in and out."""
    link = locate("InProcessLink", "sitl.bridge.links.inprocess")()
    sim.bridge.add_link(link)
    sim.bridge.taps.append(tap)
    return link


def open_log(sim: Any, folder: Path) -> None:
    """Keep a .tlog and a .bin of the flight in a folder."""
    locate("open_log", "sitl.runner")(sim, folder, "flight")


def register_envs() -> None:
    """Make Gymnasium know the environments."""
    for module in ("sitl.envs", "envs"):
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
            return
    raise TreeError("neither sitl.envs nor envs can be imported")


@cache
def library() -> dict[str, dict[str, Any]]:
    """The missions of the library: "copter/square" -> its row of the index, with the path of its file."""
    for place in ("sitl/missions/library", "missions/library"):
        index = root() / place / "index.toml"
        if index.is_file():
            kinds = tomllib.loads(index.read_text(encoding="utf-8"))
            rows = {f"{kind}/{name}": row for kind, found in kinds.items() for name, row in found.items()}
            return {name: {**row, "path": index.parent / row["file"]} for name, row in rows.items()}
    raise TreeError(f"{root()} has no missions/library/index.toml")


def mission_items(path: Path) -> list[dict[str, Any]]:
    """Items of a mission file, home first: frame, command, p1 .. p4, x, y [degE7], z [m], autocontinue."""
    items = locate("load", "sitl.missions.files.store", "missions.files.store")(path).mission.items
    fields = ("frame", "command", "p1", "p2", "p3", "p4", "x", "y", "z", "autocontinue")
    return [{name: getattr(item, name) for name in fields} for item in items]
