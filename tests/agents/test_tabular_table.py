# SPDX-License-Identifier: BSD-3-Clause
"""Tables: numbers of states, growth, files, spaces that they are refused for."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agents.errors import AgentError
from agents.tabular.slots import EMPTY, slot_of
from agents.tabular.table import Table


def fill(table, keys):
    for taken, key in enumerate(keys):
        table.make_room(taken, 1)
        slot = slot_of(table.keys, key)
        assert table.keys[slot] == EMPTY
        table.keys[slot], table.values[slot], table.visits[slot] = key, [key, -key, 0.5], [1, 2, 3]


@given(st.lists(st.integers(0, 20), min_size=6, max_size=6))
def test_number_of_a_state_gives_its_digits_back(digits):
    table = Table([21] * 6, 3)
    key = table.key(np.array(digits))
    assert 0 <= key < table.size and table.digits(key) == digits


def test_growing_keeps_every_state():
    table = Table([21] * 5, 3)
    keys = np.unique(np.random.default_rng(1).integers(0, table.size, 5000)).tolist()
    fill(table, keys)
    assert len(table) == len(keys) and 2 * len(keys) <= len(table.keys)
    assert all(table.row(key).tolist() == [key, -key, 0.5] for key in keys)
    assert table.row(next(k for k in range(table.size) if k not in set(keys))).tolist() == [0.0, 0.0, 0.0]


def test_file_holds_the_table_and_does_not_depend_on_the_order_of_states(tmp_path):
    one, other = Table([21] * 5, 3), Table([21] * 5, 3)
    keys = list(range(0, 90_000, 37))
    fill(one, keys)
    fill(other, keys[::-1])
    one.save(tmp_path / "one.npz")
    other.save(tmp_path / "other.npz")
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "other.npz").read_bytes()
    back = Table.load(tmp_path / "one.npz")
    assert len(back) == len(keys) and all(back.row(key).tolist() == one.row(key).tolist() for key in keys)
    assert back.radix.tolist() == [21] * 5 and back.visits.sum() == 6 * len(keys)


def test_files_that_are_no_tables_are_refused(tmp_path):
    (tmp_path / "text.npz").write_text("no table")
    np.savez(tmp_path / "other.npz", a=1)
    for name, message in (("text.npz", "no model"), ("other.npz", "no table"), ("none.npz", "no model")):
        with pytest.raises(AgentError, match=message):
            Table.load(tmp_path / name)


def test_only_discrete_spaces_have_tables():
    digits, three = gym.spaces.MultiDiscrete([7] * 5), gym.spaces.Discrete(3)
    assert Table.for_spaces(digits, three).size == 7**5
    assert Table.for_spaces(gym.spaces.Discrete(16), three).size == 16
    with pytest.raises(AgentError, match="observation = digits"):
        Table.for_spaces(gym.spaces.Box(0.0, 1.0, (5,)), three)
    with pytest.raises(AgentError, match="action = discrete"):
        Table.for_spaces(digits, gym.spaces.Box(0.0, 1.0, (1,)))
    with pytest.raises(AgentError, match="too many"):
        Table.for_spaces(gym.spaces.MultiDiscrete([100] * 12), three)
