# SPDX-License-Identifier: BSD-3-Clause
"""What a tabular learner learns by: the paper's settings, and what its code did otherwise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

from ..errors import AgentError, check_names

RULES = ("qlearn", "sarsa")
EXPLORATIONS = ("uniform", "noise")
CHECKS = ("reward", "crashes")


@dataclass(frozen=True)
class Settings:
    """Hyper-parameters; the defaults are the paper's parameters and the textbooks' algorithm.

    Raises:
        AgentError: a setting outside its limits.
    """

    alpha: float = 0.2
    """Step size, above 0 and up to 1."""
    gamma: float = 0.9
    """Discount, 0 .. 1."""
    epsilon: float = 0.9
    """Probability of exploring in the first episode."""
    epsilon_decay: float = 0.9986
    """Factor from one episode to the next."""
    epsilon_floor: float = 0.05
    """Smallest epsilon."""
    exploration: str = "uniform"
    """"uniform": any action, each as likely; "noise": the best after all values were disturbed (``exploration.py``)."""
    first_visit: bool = False
    """The first update of a pair of state and action stores the reward as it is, instead of alpha of the target."""
    terminal_bootstrap: bool = False
    """The value of the state after a crash counts, as if the episode continued."""
    redraw: bool = False
    """Sarsa: the action that is learnt from is drawn anew, not the one taken. No effect on Q-learning."""
    first_state_apart: bool = False
    """The first state of an episode has its own row, apart from equal digits later on."""
    check_every: int = 50
    """Episodes between two greedy evaluations of the table; the best table is kept (``checks.py``). 0: no checks."""
    check_episodes: int = 20
    """Number of episodes that a check plays."""
    check_by: str = "reward"
    """Criterion of the best table: "reward": the highest mean reward; "crashes": the fewest episodes that ended by
    themselves (the mean reward decides between equals)."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "bool":
                if not isinstance(value, bool):
                    raise AgentError(f"{field.name} = {value!r}; it must be true or false")
            elif field.type == "int":
                if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= 1_000_000:
                    raise AgentError(f"{field.name} = {value!r}; it must be a whole number from 0 on")
            elif field.type == "float":
                number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
                if not number or not 0.0 <= value <= 1.0 or (field.name == "alpha" and value == 0.0):
                    raise AgentError(f"{field.name} = {value!r}; it must be a number from 0 to 1, alpha above 0")
        for name, known in (("exploration", EXPLORATIONS), ("check_by", CHECKS)):
            if getattr(self, name) not in known:
                raise AgentError(f"{name} = {getattr(self, name)!r}; it must be one of {', '.join(known)}")
        if self.check_episodes == 0:
            raise AgentError("check_episodes = 0; it must be 1 or more (check_every = 0 checks never)")

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Settings:
        """From names and values.

        Raises:
            AgentError: no such setting, or a value that cannot be.
        """
        check_names(values, [field.name for field in fields(cls)], "setting {!r}")
        return cls(**values)

    @classmethod
    def as_coded(cls, algorithm: str) -> Settings:
        """The settings of the paper's code, with the paper's parameters."""
        coded = cls(first_visit=True, terminal_bootstrap=True, first_state_apart=True)
        return replace(coded, exploration="noise") if algorithm == "qlearn" else replace(coded, redraw=True)

    def as_dict(self) -> dict[str, Any]:
        """Names and values."""
        return asdict(self)
