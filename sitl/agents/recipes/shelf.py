# SPDX-License-Identifier: BSD-3-Clause
"""Where recipes are: those of this folder by name, others by the path of their file."""

from __future__ import annotations

from pathlib import Path

from sitl.errors import did_you_mean

from ..errors import AgentError
from .recipe import Recipe
from .recipe_file import read

_FOLDER = Path(__file__).parent


def names() -> tuple[str, ...]:
    """Names of the recipes that come with the program."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load(name: str | Path) -> Recipe:
    """A recipe by its name, or by the path of a .toml file.

    Raises:
        AgentError: no recipe of that name (the message lists those there are), or the file cannot be used.
    """
    if isinstance(name, Path) or name.endswith(".toml"):
        return read(Path(name))
    known = names()
    if name not in known:
        hint = did_you_mean(name, known)
        raise AgentError(f"recipe {name!r} is not known; it is a .toml file or one of {', '.join(known)}{hint}")
    return read(_FOLDER / f"{name}.toml")
