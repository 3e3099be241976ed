# SPDX-License-Identifier: BSD-3-Clause
"""A sweep: the same run with each combination of some values, as a folder of groups.

Each combination has a folder named by its values; sweep.json says what they are.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from sitl.core import documents

from ..errors import AgentError
from . import folder as folders
from .files import make_folder, write_json
from .folder import RunFolder

FILE = "sweep.json"
OPTION = "option."
"""Begins the names of what is the environment's."""
Values = dict[str, Any]
"""Name -> value, of a combination."""


def axis(text: str) -> tuple[str, list[Any]]:
    """NAME=V1,V2,...; values that are no JSON are text.

    Raises:
        ValueError: it is not.
    """
    name, equals, values = text.partition("=")
    name = name.strip()
    if not equals or not name.removeprefix(OPTION) or not values.strip():
        raise ValueError(f"{text!r} must be NAME=V1,V2,...")
    try:
        found = json.loads(f"[{values}]")
    except ValueError:
        found = [_value(word.strip()) for word in values.split(",")]
    for k, value in enumerate(found):
        if value in found[:k]:
            raise ValueError(f"{text!r} has {value!r} twice")
    return name, found


def _value(word: str) -> Any:
    try:
        return json.loads(word)
    except ValueError:
        return word


def combinations(axes: Sequence[tuple[str, Sequence[Any]]]) -> list[Values]:
    """All of them, the last axis fastest.

    Raises:
        AgentError: an axis comes twice, or two combinations cannot be distinguished by their folders' names.
    """
    names = [name for name, _ in axes]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise AgentError(f"--sweep {name} is given twice")
    found = [dict(zip(names, values)) for values in product(*(values for _, values in axes))]
    if len({folder_name(values) for values in found}) < len(found):
        raise AgentError(f"values of {', '.join(names)} differ in signs only that a folder's name cannot have")
    return found


def folder_name(values: Values) -> str:
    """Folder name of a combination."""
    return ",".join(f"{name.removeprefix(OPTION)}-{_word(value)}" for name, value in values.items())


def _word(value: Any) -> str:
    return re.sub(r"[^\w.+-]+", "-", value if isinstance(value, str) else json.dumps(value)).strip("-")


class Sweep:
    """A folder of groups.

    Args:
        path: path of the folder.
        combinations: name of a folder in it -> values.
    """

    def __init__(self, path: Path, combinations: Mapping[str, Values]) -> None:
        self.path, self.combinations = path, dict(combinations)

    @classmethod
    def begin(cls, path: Path, found: Sequence[Values]) -> Sweep:
        """Write down what is swept; a sweep that is there already is made larger.

        Raises:
            AgentError: it is over other names, or the folder cannot be one.
        """
        if folders.is_run(path):
            raise AgentError(f"{path} is a run; choose another --out for a sweep")
        if any(path.glob(f"*/{folders.CONFIG}")):
            raise AgentError(f"{path} is a folder of runs; choose another --out for a sweep")
        make_folder(path)
        sweep = cls(path, {folder_name(values): values for values in found})
        if (path / FILE).exists():
            before = cls.load(path)
            if before.names != sweep.names:
                raise AgentError(f"{path} is a sweep over {', '.join(before.names)}; choose another --out")
            sweep.combinations = {**before.combinations, **sweep.combinations}
        write_json(path / FILE, sweep.combinations)
        return sweep

    @classmethod
    def load(cls, path: Path) -> Sweep:
        """The sweep in a folder.

        Raises:
            AgentError: there is none.
        """
        try:
            found = documents.of_json((path / FILE).read_text())
            return cls(path, {str(name): dict(values) for name, values in found.items()})
        except FileNotFoundError:
            raise AgentError(f"{path} is no sweep: it has no {FILE}") from None
        except (OSError, ValueError, TypeError, AttributeError) as error:
            raise AgentError(f"{path / FILE} cannot be read: {error}") from None

    @property
    def names(self) -> list[str]:
        """Names of the settings and options that are swept."""
        return list(next(iter(self.combinations.values()), {}))

    def groups(self) -> dict[str, list[RunFolder]]:
        """Name of a combination's folder -> its runs, of those that were begun."""
        there = [name for name in self.combinations if (self.path / name).is_dir()]
        return {name: folders.find(self.path / name) for name in there}


def is_sweep(path: Path) -> bool:
    """Whether a folder is one."""
    return (path / FILE).is_file()
