# SPDX-License-Identifier: BSD-3-Clause
"""A list of changes for a kind of robot, and what a policy that shall bear them is trained with: a .toml file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core import code_in_files, documents
from sitl.errors import did_you_mean

from ..errors import AgentError
from ..runs.config import code_of
from .change import Change, scaled

_FOLDER = Path(__file__).parent / "plans"
_KEYS = ("summary", "robots", "change", "training", "randomise")
_TRAINING = ("recipe", "episodes", "steps")
_RANDOMISE = ("scale", "set", "latency", "draws")


@dataclass(frozen=True)
class Plan:
    """A plan.

    Raises:
        AgentError: two changes of one name, or a table that cannot be.
    """

    name: str
    changes: tuple[Change, ...]
    robots: tuple[str, ...] = ()
    """Names of the robots that it is for; none: any."""
    summary: str = ""
    training: Mapping[str, Any] = field(default_factory=dict)
    """recipe: that ``sitl benchmark rehearsal`` trains by; steps or episodes: other than the recipe's."""
    randomise: Mapping[str, Any] = field(default_factory=dict)
    """Randomisation of the second policy: scale and set (property -> low, high), latency (low, high) [s], draws."""

    def __post_init__(self) -> None:
        names = [change.name for change in self.changes]
        if not names:
            raise AgentError("it has no change")
        for name in names:
            if names.count(name) > 1:
                raise AgentError(f"two changes are called {name!r}")
        _known(f"training: {', '.join(_TRAINING)}", self.training, _TRAINING)
        _known(f"randomise: {', '.join(_RANDOMISE)}", self.randomise, _RANDOMISE)
        for key in ("scale", "set"):
            for name, limits in _mapping(key, self.randomise.get(key, {})).items():
                _range(f"randomise.{key}.{name}", limits)
        if "latency" in self.randomise:
            _range("randomise.latency", self.randomise["latency"])

    def chosen(self, only: Sequence[str] = ()) -> list[Change]:
        """The changes with these names, or of these groups; none given: those that are tried by default.

        Raises:
            AgentError: nothing is called so, or none is tried by default.
        """
        if not only:
            usual = [change for change in self.changes if change.by_default]
            if not usual:
                named = ", ".join(change.name for change in self.changes)
                raise AgentError(f"plan {self.name} has no change that is tried by default; name some of {named}")
            return usual
        for wanted in only:
            if not any(wanted in (change.name, change.group) for change in self.changes):
                names = [change.name for change in self.changes]
                hint = did_you_mean(wanted, names)
                raise AgentError(f"plan {self.name} has no change {wanted!r}; it has {', '.join(names)}{hint}")
        return [change for change in self.changes if change.name in only or change.group in only]

    def randomisation(self, robot: Any) -> dict[str, Any]:
        """The option ``randomise`` of an environment for training, with the robot's own properties.

        Raises:
            AgentError: the robot has no such property.
        """
        out: dict[str, Any] = {}
        for name, (low, high) in self.randomise.get("scale", {}).items():
            ends = scaled(robot, name, low), scaled(robot, name, high)
            out[name] = [np.minimum(*ends).tolist(), np.maximum(*ends).tolist()]
        for name, limits in self.randomise.get("set", {}).items():
            out[name] = [float(limit) for limit in limits]
        if "latency" in self.randomise:
            out["latency"] = [float(limit) for limit in self.randomise["latency"]]
        if "draws" in self.randomise:
            out["draws"] = self.randomise["draws"]
        return out


def names() -> tuple[str, ...]:
    """Names of the plans that come with the program."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load(name: str | Path) -> Plan:
    """A plan by its name, or by the path of a .toml file.

    Raises:
        AgentError: no such plan, or a file that cannot be used; the message names file, key and value.
    """
    if isinstance(name, str) and not name.endswith(".toml"):
        if name not in names():
            raise AgentError(f"plan {name!r} is not known; it is a .toml file or one of {', '.join(names())}")
        return _read(_FOLDER / f"{name}.toml")
    return _read(Path(name))


def check_names(plans: Sequence[Plan]) -> None:
    """Check that no two plans have the same name.

    Raises:
        AgentError: two have.
    """
    names = [plan.name for plan in plans]
    for name in names:
        if names.count(name) > 1:
            raise AgentError(f"there are two plans {name!r}; each needs a folder of its own")


def plan_for(robot: str) -> Plan:
    """The shipped plan of a robot.

    Raises:
        AgentError: there is none.
    """
    for name in names():
        plan = load(name)
        if robot in plan.robots:
            return plan
    raise AgentError(
        f"there is no plan for robot {robot!r}: give one of your own by --plan (sitl help mental-rehearsal)"
    )


def _read(path: Path) -> Plan:
    try:
        values = documents.toml(path.read_text(encoding="utf-8"))
        _known(f"keys: {', '.join(_KEYS)}", values, _KEYS)
        changes = values.get("change", [])
        if not isinstance(changes, list):
            raise AgentError(f"change = {changes!r}; write each as [[change]]")
        robots = values.get("robots", [])
        if not isinstance(robots, list) or not all(isinstance(robot, str) for robot in robots):
            raise AgentError(f"robots = {robots!r}; it must be a list of names")
        made = tuple(Change.of(change) for change in changes)
        named = [name for one in made for name in code_of("", one.options)]
        recipe = values["training"].get("recipe") if isinstance(values.get("training"), dict) else None
        is_known = recipe is None or (code_in_files.is_name(recipe) and ":" not in recipe)
        if not is_known and not code_in_files.lies_in(path.parent, Path(str(recipe)).absolute()):
            named.append(f"training.recipe = {recipe!r}")
        refused = code_in_files.refusal("it", named, say="")
        if refused is not None:
            raise AgentError(refused)
        return Plan(
            path.stem,
            made,
            tuple(robots),
            str(values.get("summary", "")),
            _mapping("training", values.get("training", {})),
            _mapping("randomise", values.get("randomise", {})),
        )
    except FileNotFoundError:
        raise AgentError(f"there is no plan {path}") from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, AgentError) as error:
        raise AgentError(f"plan {path}: {error}") from None


def _known(title: str, values: Mapping[str, Any], known: Sequence[str]) -> None:
    for key in values:
        if key not in known:
            hint = did_you_mean(key, known)
            raise AgentError(f"{key!r} is none of {title}{hint}")


def _mapping(key: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise AgentError(f"{key} = {value!r}; it must be a table")
    return value


def _range(key: str, value: Any) -> None:
    numbers = isinstance(value, list | tuple) and len(value) == 2 and all(isinstance(v, int | float) for v in value)
    if not numbers or value[0] > value[1]:
        raise AgentError(f"{key} = {value!r}; it must be [low, high]")
