# SPDX-License-Identifier: BSD-3-Clause
"""How a run is evaluated when the user does not say otherwise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from ..errors import AgentError, check_names

EPISODES = 100
MAX_JITTER = 1.0
"""Limit of ``jitter``: start poses moved farther are in walls (the option ``start`` gives others)."""


@dataclass(frozen=True)
class EvaluationPlan:
    """Part of what a run is. Nothing that is learnt depends on it, but which network is kept as the best does.

    Raises:
        AgentError: a setting that cannot be.
    """

    episodes: int = EPISODES
    """Number of episodes."""
    jitter: float = 0.0
    """Start poses are moved by up to so much, in x and y [m] and in yaw [rad]."""
    max_steps: int | None = None
    """Longest episode [steps]; None: as in training."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the environment, in place of the run's."""

    def __post_init__(self) -> None:
        for name in ("episodes", "max_steps"):
            value = getattr(self, name)
            if value is None and name == "max_steps":
                continue
            if not isinstance(value, int) or isinstance(value, bool) or value < 1:
                raise AgentError(f"evaluation: {name} = {value!r}; it must be a whole number from 1 on")
        number = isinstance(self.jitter, int | float) and not isinstance(self.jitter, bool)
        if not number or not 0.0 <= self.jitter <= MAX_JITTER:
            raise AgentError(f"evaluation: jitter = {self.jitter!r}; it must be a number 0 .. {MAX_JITTER:g} [m, rad]")
        if not isinstance(self.options, Mapping):
            raise AgentError(f"evaluation: options = {self.options!r}; it must be a table of names and values")

    @classmethod
    def of(cls, values: Any) -> EvaluationPlan:
        """From the keys and values of a file.

        Raises:
            AgentError: no such name, or a value that cannot be.
        """
        if not isinstance(values, Mapping):
            raise AgentError(f"evaluation = {values!r}; it must be a table")
        check_names(values, [item.name for item in fields(cls)], "evaluation: key {!r}")
        return cls(**values)

    def changed(
        self,
        episodes: int | None = None,
        jitter: float | None = None,
        max_steps: int | None = None,
        options: Mapping[str, Any] | None = None,
    ) -> EvaluationPlan:
        """A copy with what is given. When ``options`` set the start, starts are moved only if ``jitter`` says so:
        moved starts
        are all near one position."""
        if jitter is None:
            jitter = 0.0 if "start" in (options or {}) else self.jitter
        return EvaluationPlan(
            self.episodes if episodes is None else episodes,
            jitter,
            self.max_steps if max_steps is None else max_steps,
            {**self.options, **(options or {})},
        )
