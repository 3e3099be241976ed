# SPDX-License-Identifier: BSD-3-Clause
"""A table of state and action: values and visits, for the states that were met."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from ..runs.files import read_arrays, write_arrays
from .exploration import EMPTY, Memory, key_of, move_rows, slot_of

_LEAST_ROWS = 4096
_FIRST_KEY_LIMIT = 2**62


class Table:
    """Values of actions in states that are made of digits.

    Args:
        radix: number of values of each digit.
        actions: number of actions.

    Raises:
        AgentError: no digits or actions, or more states than can be numbered.
    """

    def __init__(self, radix: Sequence[int], actions: int) -> None:
        self.radix = np.array([int(n) for n in radix], np.int64)
        if len(self.radix) < 1 or self.radix.min() < 1 or actions < 1:
            raise AgentError(f"a table needs digits and actions, not {list(radix)} and {actions}")
        total = 1
        for n in self.radix.tolist():
            total *= n
        if total > _FIRST_KEY_LIMIT // 2:
            raise AgentError(f"{total:.1e} states are too many for a table")
        self.size = total
        """Number of possible states."""
        self.actions = actions
        self.keys = np.full(_LEAST_ROWS, EMPTY, np.int64)
        self.values = np.zeros((_LEAST_ROWS, actions))
        """Rows in no order of use; see ``row``."""
        self.visits = np.zeros((_LEAST_ROWS, actions), np.int64)
        """Number of updates of each value."""

    @classmethod
    def for_spaces(cls, observations: gym.Space[Any], actions: gym.Space[Any]) -> Table:
        """An empty one for an environment's spaces.

        Raises:
            AgentError: they are not discrete.
        """
        if not isinstance(actions, gym.spaces.Discrete) or int(actions.start) != 0:
            raise AgentError(
                f"a table needs discrete actions, not {actions}: take --algo ppo or sac, or --option action=discrete"
            )
        if isinstance(observations, gym.spaces.Discrete) and int(observations.start) == 0:
            return cls([int(observations.n)], int(actions.n))
        if isinstance(observations, gym.spaces.MultiDiscrete) and observations.nvec.ndim == 1:
            if not observations.start.any():
                return cls(observations.nvec.tolist(), int(actions.n))
        raise AgentError(f"a table needs observations of digits (observation = digits), not {observations}")

    def key(self, observation: Any) -> int:
        """Number of the state that an observation shows."""
        return int(key_of(np.atleast_1d(observation), self.radix))

    def digits(self, key: int) -> list[int]:
        """The observation of a state."""
        out: list[int] = []
        for n in reversed(self.radix.tolist()):
            key, digit = divmod(key, n)
            out.append(digit)
        return out[::-1]

    def row(self, key: int) -> npt.NDArray[np.float64]:
        """Values of the actions in a state, shape (actions,); zeros for one not met."""
        out: npt.NDArray[np.float64] = self.values[slot_of(self.keys, key)]
        return out

    def __len__(self) -> int:
        return int(np.count_nonzero(self.keys != EMPTY))

    @property
    def memory(self) -> Memory:
        """The arrays as laws take them."""
        return Memory(self.keys, self.values, self.visits)

    def reserve(self, taken: int, more: int) -> None:
        """Grow until ``more`` states beside the ``taken`` ones leave half of the rows empty."""
        rows = len(self.keys)
        while 2 * (taken + more) > rows:
            rows *= 2
        if rows > len(self.keys):
            old = self.memory
            self.keys = np.full(rows, EMPTY, np.int64)
            self.values = np.zeros((rows, self.actions))
            self.visits = np.zeros((rows, self.actions), np.int64)
            move_rows(old, self.memory)

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Arrays for a file: the states met, sorted, with their values and visits."""
        rows = np.flatnonzero(self.keys != EMPTY)
        rows = rows[np.argsort(self.keys[rows], kind="stable")]
        return {"radix": self.radix, "keys": self.keys[rows], "values": self.values[rows], "visits": self.visits[rows]}

    @classmethod
    def of_arrays(cls, arrays: Mapping[str, npt.NDArray[Any]]) -> Table:
        """A table from what ``arrays`` returned.

        Raises:
            AgentError: something else.
        """
        missing = [name for name in ("radix", "keys", "values", "visits") if name not in arrays]
        if missing:
            raise AgentError(f"this is no table: it has no {', '.join(missing)}")
        radix, keys, values, visits = (arrays[name] for name in ("radix", "keys", "values", "visits"))
        for name, array, kind, axes in (
            ("radix", radix, "i", 1), ("keys", keys, "i", 1), ("values", values, "f", 2), ("visits", visits, "i", 2),
        ):  # fmt: skip
            if array.dtype.kind != kind or array.ndim != axes:
                raise AgentError(f"this is no table: its {name} are {array.dtype} of shape {array.shape}")
        if values.shape != visits.shape or len(values) != len(keys):
            raise AgentError(f"this is no table: {len(keys)} states, values {values.shape}, visits {visits.shape}")
        table = cls(radix.tolist(), values.shape[1])
        if len(np.unique(keys)) != len(keys) or (len(keys) and not 0 <= keys.min() <= keys.max() < 2 * table.size):
            raise AgentError(f"this is no table: its states are not numbers from 0 to {2 * table.size - 1}, each once")
        if not np.isfinite(values).all() or (visits < 0).any():
            raise AgentError("this is no table: it has values that are no numbers")
        table.reserve(0, len(keys))
        for key, row, count in zip(keys.tolist(), values, visits):
            slot = slot_of(table.keys, key)
            table.keys[slot], table.values[slot], table.visits[slot] = key, row, count
        return table

    def save(self, path: str | Path) -> None:
        """Write a .npz file, whole or not at all."""
        write_arrays(Path(path), self.arrays())

    @classmethod
    def load(cls, path: str | Path) -> Table:
        """Read what ``save`` wrote, or a run's model.

        Raises:
            AgentError: there is none, or it is something else.
        """
        try:
            return cls.of_arrays(read_arrays(Path(path)))
        except AgentError as error:
            raise AgentError(str(error).replace("this is no table", f"{path} is no table")) from None
