# SPDX-License-Identifier: BSD-3-Clause
"""Short programs that come with the package; ``sitl examples`` lists and copies them.

Those that speak MAVLink know nothing of the simulator: they are what one runs against a real vehicle.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).resolve().parent


class Example(NamedTuple):
    """One program, or a folder with a project."""

    command: str
    """Runs it, typed beside the folder ``examples``."""
    needs: tuple[str, ...] = ()
    """Packages of PyPI that it needs besides gym-sitl itself."""


EXAMPLES = {
    "mavsdk_mission": Example("sitl exec -- python examples/mavsdk_mission.py", ("mavsdk",)),
    "mavsdk_offboard": Example("sitl exec -- python examples/mavsdk_offboard.py", ("mavsdk",)),
    "mavsdk_rover": Example("sitl exec --vehicle rover -- python examples/mavsdk_rover.py", ("mavsdk",)),
    "pymavlink_guided": Example("sitl exec -- python examples/pymavlink_guided.py"),
    "lockstep_client": Example("python examples/lockstep_client.py"),
    "swarm_formation": Example("sitl exec --count 16 -- python examples/swarm_formation.py"),
    "regression": Example("pytest examples/regression", ("pytest",)),
}
"""Name -> the example, in the order in which ``sitl examples`` lists them."""


def source(name: str) -> Path:
    """The program's file, or the project's folder."""
    file = FOLDER / f"{name}.py"
    return file if file.exists() else FOLDER / name


def title(name: str) -> str:
    """What the example shows: the first line of its text."""
    path = source(name)
    text = path if path.is_file() else next(path.glob("test_*.py"))
    return (ast.get_docstring(ast.parse(text.read_text(encoding="utf-8"))) or "").split("\n", 1)[0]
