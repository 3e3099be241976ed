# SPDX-License-Identifier: BSD-3-Clause
"""Somebody else's run folder is opened: whatever its model holds, nothing of it is run."""

from __future__ import annotations

import base64
import io
import json
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
pytest.importorskip("torch", reason="deep agents need the extra 'rl'")

from sitl.agents.deep import checkpoint, plain, training
from sitl.agents.deep.library import torch
from sitl.agents.errors import AgentError
from sitl.agents.runs.folder import RunFolder
from tests.agents.deep_runs import new, train, weights


class Marks:
    """Pickled, it is a program that makes a file."""

    def __init__(self, path):
        self._path = path

    def __reduce__(self):
        return Path.touch, (self._path,)


def rewritten(path, **parts):
    """A model's file with some of its parts replaced, or added."""
    with zipfile.ZipFile(path) as archive:
        kept = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in {**kept, **parts}.items():
            archive.writestr(name, content)


def tensors(value):
    content = io.BytesIO()
    torch().save(value, content)
    return content.getvalue()


def array(value):
    content = io.BytesIO()
    np.savez(content, **{"0": np.array([value], dtype=object)})
    return content.getvalue()


def opened(run):
    """All ways to open a run; what each says when it refuses."""
    said = []
    for way in (lambda: training.policy(RunFolder(run.path)), lambda: train(RunFolder(run.path))):
        try:
            way()
        except AgentError as error:
            said.append(str(error))
    return said


@pytest.fixture
def run(tmp_path):
    """A run in the middle."""
    made = new(tmp_path / "run", steps=10_000, settings={"check_every": 0})
    train(made, episodes=2)
    return made


def test_marks_would_mark(tmp_path):
    pickle.loads(pickle.dumps(Marks(tmp_path / "marker")))
    assert (tmp_path / "marker").exists()


@pytest.mark.parametrize("algorithm", ["ppo", "dqn", "sac"])
def test_a_model_holds_no_pickle_but_tensors(tmp_path, algorithm):
    made = new(tmp_path / "run", algorithm, steps=60)
    train(made)
    with zipfile.ZipFile(made.path / checkpoint.MODEL) as archive:
        for name in archive.namelist():
            content = archive.read(name)
            if name.endswith(".pth"):
                torch().load(io.BytesIO(content), weights_only=True)
            elif name.endswith(".npz"):
                with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
                    assert all(not arrays[part].dtype.hasobject for part in arrays)
            else:
                json.loads(content)


def test_a_pickle_for_weights_is_refused(run, tmp_path):
    rewritten(run.path / checkpoint.MODEL, **{"policy.weights.pth": tensors({"a": Marks(tmp_path / "marker")})})
    said = opened(run)
    assert len(said) == 2 and all("policy.weights.pth holds more than weights" in text for text in said)
    assert not (tmp_path / "marker").exists()


def test_pickled_arrays_are_refused(run, tmp_path):
    rewritten(run.path / checkpoint.MODEL, **{"state.npz": array(Marks(tmp_path / "marker"))})
    assert len(opened(run)) == 1  # to play, nobody reads it
    assert not (tmp_path / "marker").exists()


def test_a_model_as_stable_baselines3_saves_it_is_refused(run, tmp_path):
    """Earlier versions kept such files: their "data" is unpickled by the library, their .pkl by us."""
    marks = pickle.dumps(Marks(tmp_path / "marker"))
    data = {"policy_class": {":type:": "x", ":serialized:": base64.b64encode(marks).decode()}}
    with zipfile.ZipFile(run.path / checkpoint.MODEL, "w") as archive:
        archive.writestr("data", json.dumps(data))
        archive.writestr("spaces.pkl", marks)
        archive.writestr("state.pkl", marks)
    said = opened(run)
    assert len(said) == 2 and all("hold pickles, which can run code" in text for text in said)
    assert not (tmp_path / "marker").exists()


def test_what_lies_beside_is_not_looked_at(run, tmp_path):
    before = weights(run)
    rewritten(run.path / checkpoint.MODEL, **{"spaces.pkl": pickle.dumps(Marks(tmp_path / "marker")), "data": b"{}"})
    assert weights(run) == before and opened(run) == []
    assert not (tmp_path / "marker").exists()


def test_state_comes_back_as_it_was():
    state = {
        "a": (1, 2.5, float("nan"), -0.0, None, True, "text", b"bytes\0"), "big": 2**127 + 1, 3: [np.float32(0.1)],
        "rows": np.arange(6, dtype=np.int16).reshape(2, 3),
    }  # fmt: skip
    arrays = {}
    tree = json.loads(json.dumps(plain.encode(state, arrays)))
    again = plain.decode(tree, arrays)
    assert repr(again) == repr(state)
    assert type(again[3][0]) is np.float32 and again["rows"].dtype == np.int16


@pytest.mark.parametrize("odd", [object(), {1, 2}, np.array([None]), lambda: 0])
def test_other_objects_are_refused(odd):
    with pytest.raises(AgentError, match=r"cannot be kept in a run's folder"):
        plain.encode([odd], {})


@pytest.mark.parametrize("tree", [{"os.system": ["true"]}, {"list": [], "tuple": []}, [1]])
def test_trees_that_say_something_else_are_refused(tree):
    with pytest.raises(AgentError, match=r"is no (record|state)"):
        plain.decode(tree, {})
