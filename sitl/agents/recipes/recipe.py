# SPDX-License-Identifier: BSD-3-Clause
"""A recipe: what is trained where, by which settings, for how long, and how what was learnt is played."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .. import algorithms
from ..errors import AgentError
from ..runs.config import MAX_STEPS, RunConfig, versions
from ..runs.plan import EvaluationPlan


@dataclass(frozen=True)
class Recipe:
    """A run without its seed.

    Raises:
        AgentError: no such algorithm, or a length that cannot be.
    """

    name: str
    """File name without the ending."""
    env: str
    """Id of the environment."""
    algorithm: str
    summary: str = ""
    """One line for reports and lists."""
    episodes: int | None = None
    steps: int | None = None
    """Length of a run; both None: the algorithm's default."""
    max_steps: int = MAX_STEPS
    """Longest episode [steps]."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the environment."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Settings of the algorithm; the others have their defaults."""
    evaluation: EvaluationPlan = field(default_factory=EvaluationPlan)

    def __post_init__(self) -> None:
        module = algorithms.load(self.algorithm)
        length = self._length(module)
        RunConfig(self.env, self.algorithm, max_steps=self.max_steps, versions={}, **length)

    def _length(self, module: algorithms.Algorithm) -> dict[str, Any]:
        if self.episodes is None and self.steps is None:
            return {"episodes": None, "steps": None, **module.LENGTH}
        return {"episodes": self.episodes, "steps": self.steps}

    def config(
        self,
        seed: int = 0,
        episodes: int | None = None,
        steps: int | None = None,
        max_steps: int | None = None,
        options: Mapping[str, Any] | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> RunConfig:
        """A run by this recipe; what is given replaces what the recipe says, options and settings one by one.

        Raises:
            AgentError: a setting that the algorithm does not have, or a figure that cannot be.
            MissingExtra: the algorithm needs what is not installed.
        """
        module = algorithms.load(self.algorithm)
        try:
            module.settings(self.algorithm, self.settings)
        except AgentError as error:
            raise AgentError(f"recipe {self.name}: {error}") from None
        length: dict[str, Any] = {"episodes": episodes, "steps": steps}
        if episodes is None and steps is None:
            length = self._length(module)
        return RunConfig(
            env=self.env,
            algorithm=self.algorithm,
            env_options={**self.options, **(options or {})},
            settings=module.settings(self.algorithm, {**self.settings, **(settings or {})}),
            seed=seed,
            max_steps=max_steps or self.max_steps,
            versions=versions(*module.LIBRARIES),
            evaluation=self.evaluation,
            **length,
        )
