# SPDX-License-Identifier: BSD-3-Clause
"""Reads a recipe's .toml file."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

from sitl.core import code_in_files
from sitl.errors import did_you_mean

from ..errors import AgentError
from ..runs.config import code_of
from ..runs.plan import EvaluationPlan
from .recipe import Recipe

KEYS: dict[str, tuple[type, str]] = {
    "summary": (str, "text"),
    "env": (str, "text"),
    "algorithm": (str, "text"),
    "episodes": (int, "a whole number"),
    "steps": (int, "a whole number"),
    "max_steps": (int, "a whole number"),
    "options": (dict, "a table"),
    "settings": (dict, "a table"),
    "evaluation": (dict, "a table"),
}
"""Key -> type of its value, and what that is called."""
_REQUIRED = ("env", "algorithm")


def read(path: Path) -> Recipe:
    """The recipe in a file.

    Raises:
        AgentError: there is none, or it cannot be used; the message names file, key and value.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise AgentError(f"there is no recipe {path}") from None
    except (OSError, ValueError) as error:
        raise AgentError(f"recipe {path} cannot be read: {error}") from None
    try:
        return _recipe(path.stem, tomllib.loads(text))
    except (tomllib.TOMLDecodeError, AgentError) as error:
        raise AgentError(f"recipe {path}: {error}") from None


def _recipe(name: str, values: dict[str, Any]) -> Recipe:
    for key, value in values.items():
        if key not in KEYS:
            hint = did_you_mean(key, KEYS)
            raise AgentError(
                f"key {key!r} is not known; it is one of {', '.join(KEYS)}{hint} (settings of the algorithm stand "
                "under [settings], options of the environment under [options])"
            )
        kind, called = KEYS[key]
        if not isinstance(value, kind) or isinstance(value, bool):
            raise AgentError(f"{key} = {value!r}; it must be {called}")
        try:
            json.dumps(value)
        except TypeError:
            raise AgentError(f"{key} has a date or a time, which no option or setting takes") from None
    for key in _REQUIRED:
        if key not in values:
            raise AgentError(f"key {key!r} is missing")
    plan = EvaluationPlan.of(values.pop("evaluation", {}))
    refused = code_in_files.refusal("it", code_of(values["env"], values.get("options", {}), plan.options))
    if refused is not None:
        raise AgentError(refused)
    return Recipe(name=name, evaluation=plan, **values)
