# SPDX-License-Identifier: BSD-3-Clause
"""Which libraries of others the packages import that a native flight is made of: each may bring its platform's bits."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import sitl

ROOT = Path(sitl.__path__[0])
FLIGHT = (
    "autopilot", "bridge", "core", "envs", "missions/files", "physics", "plants", "turtlebots", "vehicle", "vehicles",
    "worlds", "fleet.py", "move.py", "scenario.py", "simulation.py", "swarm.py",
)  # fmt: skip
ENGINES = ("physics/pybullet", "physics/jsbsim")
"""Physics of others: their flights are theirs."""
ALLOWED = {
    "fastcrc": "check sums: whole numbers",
    "gymnasium": "spaces, and the seeds of generators",
    "jax": "the form of arrays that are given away, and that actions have",
    "llvmlite": "writes and reads machine code (tests/core/test_machine_code.py)",
    "matplotlib": "draws worlds",
    "numba": "compiles laws (tests/core/test_machine_code.py)",
    "numpy": "arrays",
    "pettingzoo": "the interface of swarms",
    "platformdirs": "names of folders",
    "pygame": "shows pictures",
    "pymavlink": "the fields of messages",
    "stable_baselines3": "the interface of vector environments",
    "torch": "the form of arrays that are given away, and that actions have",
}


def imported(path: Path) -> set[str]:
    """Packages of others that a file imports, anywhere in it."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names.add(str(node.module))
    return {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"sitl"}


def test_a_native_flight_takes_numbers_from_no_other_library() -> None:
    """Ruckig planned legs once: the last bits of its durations were its compiler's."""
    files = [
        file for part in FLIGHT for file in ([ROOT / part] if part.endswith(".py") else (ROOT / part).rglob("*.py"))
    ]
    ours = [file for file in files if not file.relative_to(ROOT).as_posix().startswith(ENGINES)]
    assert len(ours) > 400
    found = {name: file for file in ours for name in imported(file)}
    assert {name: str(file) for name, file in found.items() if name not in ALLOWED} == {}
    assert set(ALLOWED) == set(found), "not imported any more: take it off the list"
