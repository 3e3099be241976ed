# SPDX-License-Identifier: BSD-3-Clause
"""Vectors take actions of other libraries, and give observations to them, on the same memory."""

from __future__ import annotations

import builtins

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.tensors import ALIGNED, as_numpy, rows
from sitl.errors import MissingExtra

ID = "sitl/RoverReachGoal-v1"
LIBRARIES = {"torch": lambda tensor: tensor.data_ptr(), "jax": lambda array: array.unsafe_buffer_pointer()}


class Shared:
    """An array of a library that has nothing but DLPack."""

    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


class Elsewhere(Shared):
    """One in the memory of another device."""

    def __dlpack__(self, **options):
        raise BufferError("memory of a GPU")


def vector(**options):
    return gym.make_vec(ID, num_envs=3, vectorization_mode="vector_entry_point", **options)


@pytest.mark.parametrize("library", LIBRARIES)
def test_observations_are_the_librarys_on_numpys_memory(library, monkeypatch):
    pytest.importorskip(library)
    env, like, made = vector(array=library), vector(), []
    observation = env.unwrapped.session.observation
    observe = observation.observe
    monkeypatch.setattr(observation, "observe", lambda robot: made.append(observe(robot)) or made[-1])
    actions = like.action_space.sample()
    env.reset(seed=1), like.reset(seed=1)
    for _ in range(3):
        found, wanted = env.step(actions), like.step(actions)
        address = LIBRARIES[library]
        assert {k: address(v) for k, v in found[0].items()} == {k: v.ctypes.data for k, v in made[-1].items()}
        for name, value in wanted[0].items():
            np.testing.assert_array_equal(np.asarray(found[0][name]), value)
        assert all(type(one) is type(found[0]["observation"]) for one in found[1:4])
        np.testing.assert_allclose(np.asarray(found[1]), wanted[1], rtol=1e-6)


@pytest.mark.parametrize("library", LIBRARIES)
def test_actions_of_a_library_are_numpys_on_its_memory(library):
    module = pytest.importorskip("torch" if library == "torch" else "jax.numpy")
    given = module.ones((3, 2))
    assert as_numpy(given).ctypes.data == LIBRARIES[library](given)
    env, like = vector(array=library), vector()
    env.reset(seed=1), like.reset(seed=1)
    found, wanted = env.step(given), like.step(np.ones((3, 2), np.float32))
    np.testing.assert_array_equal(np.asarray(found[0]["observation"]), wanted[0]["observation"])


def test_actions_by_dlpack_are_taken_from_their_memory():
    given = np.ones((3, 2), np.float32)
    assert as_numpy(Shared(given)).ctypes.data == given.ctypes.data
    env, like = vector(), vector()
    env.reset(seed=1), like.reset(seed=1)
    found, wanted = env.step(Shared(given)), like.step(given)
    np.testing.assert_array_equal(found[0]["observation"], wanted[0]["observation"])


def test_actions_in_other_memory_are_refused():
    env = vector()
    env.reset(seed=1)
    with pytest.raises(gym.error.InvalidAction, match=r"memory of a GPU; they must be in the processor's memory"):
        env.step(Elsewhere(np.ones((3, 2), np.float32)))


@pytest.mark.parametrize("bad", [2.0, np.nan])
def test_actions_outside_of_the_space_are_refused_and_no_robot_gets_any(bad):
    env = vector(clip_actions=False)
    env.reset(seed=1)
    actions = np.zeros((3, 2), np.float32)
    actions[0], actions[2, 1] = 0.5, bad
    with pytest.raises(gym.error.InvalidAction, match="is not in Box"):
        env.step(actions)
    assert not env.unwrapped.session.acted.any()


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_that_is_missing_is_named_with_its_package(library, monkeypatch):
    load = builtins.__import__

    def missing(name, *rest):
        if name.partition(".")[0] == library:
            raise ImportError(f"No module named {name!r}")
        return load(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(MissingExtra, match=f"pip install {library}$"):
        vector(array=library)


def test_a_library_that_is_not_known_is_refused():
    with pytest.raises(EnvOptionError, match="array 'tensorflow' is not known; it is one of numpy, torch, jax"):
        vector(array="tensorflow")


def test_new_rows_begin_where_jax_takes_memory():
    assert all(rows(5, 7).ctypes.data % ALIGNED == 0 for _ in range(50))
    assert rows(5, 7).shape == (5, 7) and rows(4, 3, np.int64).dtype == np.int64
