# SPDX-License-Identifier: BSD-3-Clause
"""What a run is: environment, algorithm, settings, seed, length. Together with the versions it repeats the run."""

from __future__ import annotations

import platform
from collections.abc import Container, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import gymnasium as gym

from sitl import envs
from sitl.core import code_in_files, documents
from sitl.version import __version__

from ..errors import AgentError
from .curriculum import Stage, stages_of
from .evaluation_plan import EvaluationPlan
from .files import write_json

EPISODES = 3000
MAX_STEPS = 1500
"""Default lengths, the paper's: episodes of a run, steps of an episode."""
_NO_DIFFERENCE = ("versions", "episodes", "steps", "evaluation")
_OF_OLD_GYM = "GymV"
"""Environments that Gymnasium makes with the package gym, by a name of their own."""
_LIBRARIES = ("numpy", "numba", "gymnasium")


def versions(*libraries: str) -> dict[str, str]:
    """Versions of this program, of Python, and of the libraries that results depend on."""
    found = {"gym-sitl": __version__, "python": platform.python_version()}
    return {**found, **{name: metadata.version(name) for name in (*_LIBRARIES, *libraries)}}


def code_of(env: Any, *options: Any) -> list[str]:
    """What of an environment's id and options reaches outside of this process (``sitl.core.code_in_files``); an id of
    "" may be any of this package."""
    runs = isinstance(env, str) and (":" in env or env.startswith(_OF_OLD_GYM))  # Gymnasium imports what stands before
    named, is_ours = [f"env = {env!r}"] if runs else [], env == "" or _is_ours(env)
    tables = [table for table in options if isinstance(table, Mapping)]
    return named + [name for table in tables for name in code_in_files.code_of_options(table, is_ours)]


def _is_ours(env: Any) -> bool:
    spec = gym.registry.get(env) if isinstance(env, str) else None
    return spec is not None and isinstance(spec.entry_point, str) and spec.entry_point.startswith(f"{envs.__name__}.")


@dataclass(frozen=True)
class RunConfig:
    """The configuration of a run.

    Raises:
        AgentError: a length or a seed that cannot be.
    """

    env: str
    """Id of the environment."""
    algorithm: str
    env_options: Mapping[str, Any] = field(default_factory=dict)
    """Keyword arguments of ``gymnasium.make``, of JSON types."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Settings of the algorithm."""
    seed: int = 0
    episodes: int | None = EPISODES
    """Length in episodes; None: ``steps`` gives it."""
    steps: int | None = None
    """Length in steps of all episodes together; None: ``episodes`` gives it."""
    max_steps: int = MAX_STEPS
    """Longest episode [steps]."""
    versions: Mapping[str, str] = field(default_factory=versions)
    """Versions that the run was started with."""
    evaluation: EvaluationPlan = field(default_factory=EvaluationPlan)
    """Default plan of evaluations."""
    curriculum: Sequence[Stage] = ()
    """Worlds that follow on those of the options."""

    def __post_init__(self) -> None:
        for name in ("episodes", "steps", "max_steps"):
            value = getattr(self, name)
            if (value is None and name != "max_steps") or (isinstance(value, int) and value >= 1):
                continue
            raise AgentError(f"{name} = {value!r}; it must be a whole number from 1 on")
        if not isinstance(self.seed, int) or not 0 <= self.seed < 2**32:
            raise AgentError(f"seed = {self.seed!r}; it must be a whole number from 0 to 2^32 - 1")
        if self.episodes is None and self.steps is None:
            raise AgentError("a run needs an end: episodes or steps")

    @property
    def name(self) -> str:
        """Default name of its folder."""
        return f"{self.env.replace(':', '-').replace('/', '-')}-{self.algorithm}"

    @property
    def code(self) -> list[str]:
        """What reaches outside of this process (``sitl.core.code_in_files``)."""
        return self.code_but(())

    def code_but(self, replaced: Container[str]) -> list[str]:
        """The same without what of the options is replaced."""
        tables = (self.env_options, self.evaluation.options, *({"world": stage.world} for stage in self.curriculum))
        return code_of(self.env, *(code_in_files.without(table, replaced) for table in tables))

    def with_(self, **changes: Any) -> RunConfig:
        """A copy with some fields replaced."""
        return replace(self, **changes)

    def differences(self, other: RunConfig) -> list[str]:
        """Names of the fields in which two trainings differ, but for versions and lengths."""
        a, b = asdict(self), asdict(other)
        return [name for name in a if name not in _NO_DIFFERENCE and a[name] != b[name]]

    def save(self, path: Path) -> None:
        """Write it as JSON."""
        write_json(path, asdict(self))

    @classmethod
    def load(cls, path: Path, replaced: Container[str] = ()) -> RunConfig:
        """Read a configuration that ``save`` wrote.

        Args:
            path: of the file.
            replaced: options in whose place others come, so that it does not matter what the file says of them.

        Raises:
            AgentError: it is something else, or it reaches outside of this process and the user has not said so.
        """
        try:
            values = documents.of_json(path.read_text())
        except FileNotFoundError:
            raise AgentError(f"{path.parent} is no run: it has no {path.name}") from None
        except (OSError, ValueError) as error:
            raise AgentError(f"{path} cannot be read: {error}") from None
        known = {item.name for item in fields(cls)}
        if not isinstance(values, dict) or not {"env", "algorithm"} <= values.keys() or not values.keys() <= known:
            raise AgentError(f"{path} does not describe a run")
        try:
            plan, stages = EvaluationPlan.of(values.get("evaluation", {})), stages_of(values.get("curriculum", ()))
            found = cls(**{**values, "evaluation": plan, "curriculum": stages})
        except AgentError as error:
            raise AgentError(f"{path}: {error}") from None
        refused = code_in_files.refusal(path, found.code_but(replaced))
        if refused is not None:
            raise AgentError(refused)
        return found
