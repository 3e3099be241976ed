# SPDX-License-Identifier: BSD-3-Clause
"""The missions that come with the simulator: files, and an index that says what each is and where it is flown.

``python -m sitl.missions.library.make`` writes the files.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from sitl.errors import OptionError, did_you_mean

FOLDER = Path(str(resources.files(__name__)))


@dataclass(frozen=True)
class Entry:
    """One mission of the library."""

    name: str
    """"copter/square"."""
    file: str
    """File name, relative to the index."""
    description: str
    frame: str
    """Name of the airframe that it is made for."""
    world: str | None = None
    """Name of the world that it needs; None: none."""
    start: str | None = None
    """Start pose in the world; None: the world's own."""
    params: Mapping[str, float] = field(default_factory=dict)
    """Parameters that it needs: name -> value."""

    @property
    def kind(self) -> str:
        """Name of the kind of vehicle."""
        return self.name.partition("/")[0]

    @property
    def path(self) -> Path:
        """Path of the mission file."""
        return FOLDER / self.file


@cache
def entries() -> dict[str, Entry]:
    """All missions by name."""
    with (FOLDER / "index.toml").open("rb") as file:
        index: dict[str, dict[str, Any]] = tomllib.load(file)
    return {
        f"{kind}/{name}": Entry(f"{kind}/{name}", **row) for kind, rows in index.items() for name, row in rows.items()
    }


def find(name: str) -> Entry:
    """The mission of a name.

    Raises:
        OptionError: there is none; suggests the nearest.
    """
    if name not in entries():
        hint = did_you_mean(name, entries())
        raise OptionError(f"there is no mission {name!r}{hint} (sitl mission library lists all)")
    return entries()[name]
