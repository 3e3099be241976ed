# SPDX-License-Identifier: BSD-3-Clause
"""A curriculum: the worlds that a run learns in, one stage after the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any

import gymnasium as gym

from sitl.envs import EnvOptionError

from ..errors import AgentError, check_names

Worlds = str | Sequence[str]


@dataclass(frozen=True)
class Stage:
    """A part of a run; the part before the first stage is in the worlds of the run's options.

    Raises:
        AgentError: a value that cannot be.
    """

    after: int
    """Steps of the run after which it begins: episodes that begin from then on are in its worlds."""
    world: Worlds
    """As the option ``world`` of environments: a name, a range of seeds, or a list."""

    def __post_init__(self) -> None:
        if not isinstance(self.after, int) or isinstance(self.after, bool) or self.after < 1:
            raise AgentError(f"curriculum: after = {self.after!r}; it must be a whole number of steps from 1 on")
        names = self.world if isinstance(self.world, list | tuple) else (self.world,)
        if not names or not all(isinstance(name, str) for name in names):
            raise AgentError(f"curriculum: world = {self.world!r}; it must be a text, or a list of texts")
        object.__setattr__(self, "world", self.world if isinstance(self.world, str) else tuple(self.world))


def stages_of(values: Any) -> tuple[Stage, ...]:
    """From the tables of a file, in order.

    Raises:
        AgentError: no such key, a key that is missing, a value that cannot be, or stages that are not in order.
    """
    if not isinstance(values, list | tuple):
        raise AgentError(f"curriculum = {values!r}; it must be a list of tables")
    keys = [item.name for item in fields(Stage)]
    for table in values:
        if not isinstance(table, Mapping):
            raise AgentError(f"curriculum: {table!r}; each stage must be a table of {' and '.join(keys)}")
        check_names(table, keys, "curriculum: key {!r}")
        for key in keys:
            if key not in table:
                raise AgentError(f"curriculum: key {key!r} is missing in {dict(table)!r}")
    stages = tuple(Stage(**table) for table in values)
    for before, after in pairwise(stages):
        if after.after <= before.after:
            raise AgentError(
                f"curriculum: after = {after.after} follows after = {before.after}; each stage must begin later than "
                "the one before"
            )
    return stages


class Curriculum:
    """Puts the robots of a run into the worlds of its stages.

    Args:
        stages: of the run.
        env: that it learns in; its worlds are changed.

    Raises:
        AgentError: there are stages, and this environment has no worlds to change.
    """

    def __init__(self, stages: Sequence[Stage], env: gym.Env[Any, Any] | gym.vector.VectorEnv[Any, Any, Any]) -> None:
        self._left = list(stages)
        self._set = getattr(env.unwrapped, "set_worlds", None)
        if self._left and self._set is None:
            raise AgentError(f"curriculum: {type(env.unwrapped).__name__} has no set_worlds: it stays in its world")

    def follow(self, steps: int) -> None:
        """So many steps of the run are done.

        Raises:
            AgentError: the worlds cannot be used.
        """
        reached = None
        while self._left and steps >= self._left[0].after:
            reached = self._left.pop(0)
        if reached is None:
            return
        assert self._set is not None
        try:
            self._set(reached.world)
        except EnvOptionError as error:
            raise AgentError(f"curriculum, after {reached.after} steps: {error}") from None
