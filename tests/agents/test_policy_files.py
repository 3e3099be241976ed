# SPDX-License-Identifier: BSD-3-Clause
"""Policies as files of their own: they play as what they were written from, and what is no policy is refused."""

from __future__ import annotations

import json
import zipfile

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl import cli
from sitl.agents import learnt
from sitl.agents.deep import onnx_file, policy_file
from sitl.agents.deep.actions import Actions
from sitl.agents.deep.features import Features
from sitl.agents.deep.network import Layer, Network
from sitl.agents.deep.policy import DeepPolicy
from sitl.agents.deep.settings import settings_of
from sitl.agents.errors import AgentError
from sitl.agents.rollout import rollout

WIDE = gym.spaces.Box(np.float32([-30.0, -3.0, 0.0]), np.float32([30.0, 3.0, 9.0]))
MOVES = gym.spaces.Box(-1.0, 1.0, (2,), np.float32)
ABOUT = {"env": "sitl/RoverWaypoint-v0", "algorithm": "ppo", "options": {}, "max_steps": 50, "step_time": 0.2,
         "versions": {}}  # fmt: skip


def made(seen=WIDE, moves=MOVES, frames=2, algorithm="ppo", sectors=0):
    """A policy that was never trained."""
    settings = settings_of(algorithm, {"frames": frames, "sectors": sectors})
    features, actions = Features(seen, sectors), Actions(moves, algorithm)
    rng = np.random.default_rng(3)
    sizes = [features.width * frames, 8, int(getattr(moves, "n", 0)) or moves.shape[0]]
    layers = [
        Layer(rng.normal(size=(b, a)).astype(np.float32), rng.normal(size=b).astype(np.float32), how)
        for a, b, how in zip(sizes, sizes[1:], ("tanh", ""))
    ]
    return DeepPolicy(Network(layers, hasattr(moves, "n")), settings, features, actions)


def played(policy, seen, steps=20):
    policy.begin(0)
    rng = np.random.default_rng(1)
    return [policy.act(rng.uniform(seen.low, seen.high).astype(np.float32)) for _ in range(steps)]


@pytest.mark.parametrize("moves", [MOVES, gym.spaces.Discrete(4)])
def test_a_policy_plays_from_its_file_as_before(tmp_path, moves):
    policy = made(moves=moves)
    policy_file.write(tmp_path / "p.npz", policy, ABOUT)
    found = learnt.load(tmp_path / "p.npz")
    assert np.array_equal(played(found.policy, WIDE), played(policy, WIDE))
    assert found.step_time == 0.2 and found.config.env == ABOUT["env"] and found.config.max_steps == 50


def test_numbers_of_either_sign_are_told_apart_near_zero_and_bounded_far_away():
    rows = Features(WIDE, 48)(np.float32([[-30.0, -0.01, 0.0], [30.0, 0.01, 9.0]]))
    assert np.allclose(rows, [[-3.434, -0.00995, 0.0], [3.434, 0.00995, 2.3026]], atol=1e-3)


def changed(path, **changes):
    """The file with other arrays; ``about``: keys of it that are changed."""
    with np.load(path) as arrays:
        kept = dict(arrays)
    about = {**json.loads(bytes(kept["about"])), **changes.pop("about", {})}
    kept |= {"about": np.frombuffer(json.dumps(about).encode(), np.uint8), **changes}
    np.savez(path, **kept)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"about": {"format": 2}}, "has format 2; this version reads 1"),
        ({"about": {"algorithm": "qlearn"}}, "no file of a policy"),
        ({"about": {"activations": ["tanh", "exec"]}}, "no file of a policy: layer 1"),
        ({"about": {"activations": ["tanh", "", ""]}}, "no file of a policy"),
        ({"about": {"actions": {"kind": "discrete", "n": 7, "start": 0}}}, "2 outputs"),
        ({"about": {"env": "their:Env-v0"}}, "names code.*their:Env-v0"),
        ({"about": {"options": {"autopilot": "ardupilot:./theirs"}}}, "names code"),
        ({"weight0": np.zeros((8, 5), np.float32)}, r"layer 0: float32 \(8, 5\)"),
        ({"bias1": np.full(2, np.nan, np.float32)}, "layer 1 has numbers that are not finite"),
        ({"weight1": np.zeros((2, 8), np.complex64)}, "no file of a policy: weight1: an array of '<c8'"),
        ({"weight1": np.zeros((2, 8), "datetime64[s]")}, "no file of a policy: weight1: an array of '<M8"),
    ],
)
def test_what_is_no_policy_is_refused(tmp_path, monkeypatch, changes, says):
    monkeypatch.setenv("SITL_ALLOW_CODE", "")
    policy_file.write(tmp_path / "p.npz", made(), ABOUT)
    changed(tmp_path / "p.npz", **changes)
    with pytest.raises(AgentError, match=says):
        learnt.load(tmp_path / "p.npz")


@pytest.mark.parametrize(
    ("header", "says"),
    [
        (b"{'descr': '<f4', 'fortran_order': False, 'shape': (300000, 300000), }\n", "360,000,000,000 bytes"),
        (b"{'descr': '<f4', 'fortran_order': False, 'sha", "header of an array is damaged"),
        (b"{'descr': '|O', 'fortran_order': False, 'shape': (2,), }\n", "an array of '|O'"),
    ],
)
def test_a_header_that_lies_is_refused_by_the_commands(tmp_path, capsys, header, says):
    policy_file.write(tmp_path / "p.npz", made(), ABOUT)
    with zipfile.ZipFile(tmp_path / "p.npz") as before:
        members = {name: before.read(name) for name in before.namelist()}
    members["weight1.npy"] = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(64)
    with zipfile.ZipFile(tmp_path / "p.npz", "w") as after:
        for name, content in members.items():
            after.writestr(name, content)
    for words in (["rollout", "--episodes", "1"], ["deploy", "--connection", "udpout:127.0.0.1:1"]):
        assert cli.main([words[0], str(tmp_path / "p.npz"), *words[1:]]) == 2
        said = capsys.readouterr().err
        assert "p.npz is no file of a policy: weight1: " in said and says in said and said.count("\n") == 1


def test_what_is_no_policy_at_all_is_told_what_one_is(tmp_path, capsys):
    (tmp_path / "junk.txt").write_text("junk")
    (tmp_path / "p.onnx").write_text("junk")
    for name, says in [
        (tmp_path / "junk.txt", "junk.txt is not a policy: a policy is the folder of a run (sitl train), a"),
        (tmp_path / "p.onnx", "; .onnx is for other programs: export it as .npz"),
        (tmp_path / "nothing", "nothing is not there"),
        ("copter-hovr", "did you mean 'copter-hover'?"),
    ]:
        for words in (["rollout", "--episodes", "1"], ["deploy", "--connection", "udpout:127.0.0.1:1"]):
            assert cli.main([words[0], str(name), *words[1:]]) == 2
            assert says in capsys.readouterr().err


def test_files_that_are_not_there_or_something_else(tmp_path):
    with pytest.raises(AgentError, match=r"p\.npz cannot be read"):
        learnt.load(tmp_path / "p.npz")
    (tmp_path / "p.npz").write_bytes(b"PK nothing")
    with pytest.raises(AgentError, match="no file of a policy"):
        learnt.load(tmp_path / "p.npz")
    with pytest.raises(AgentError, match="is no run"):
        learnt.load(tmp_path)


SCAN = gym.spaces.Box(0.0, 10.0, (6,), np.float32)


@pytest.mark.parametrize(("seen", "moves"), [(WIDE, MOVES), (WIDE, gym.spaces.Discrete(4)), (SCAN, MOVES)])
def test_onnx_gives_what_the_policy_gives(tmp_path, seen, moves):
    reference = pytest.importorskip("onnx.reference")
    policy = made(seen, moves)
    onnx_file.write(tmp_path / "p.onnx", policy, ABOUT)
    run = reference.ReferenceEvaluator(str(tmp_path / "p.onnx"))
    kept = {prop.key: json.loads(prop.value) for prop in run.proto_.metadata_props}
    assert kept["step_time"] == 0.2 and kept["frames"] == 2
    policy.begin(0)
    rng, before = np.random.default_rng(1), None
    for _ in range(10):
        now = rng.uniform(seen.low, seen.high).astype(np.float32)
        stack = np.concatenate([now, now if before is None else before])[None]
        (actions,) = run.run(None, {"observations": stack})
        assert np.allclose(actions[0], policy.act(now), atol=1e-5)
        before = now


def test_onnx_without_a_graph_is_refused(tmp_path):
    pytest.importorskip("onnx")
    with pytest.raises(AgentError, match=r"write \.npz"):
        onnx_file.write(tmp_path / "p.onnx", made(SCAN, sectors=3), ABOUT)


def test_rollouts_play_a_file_in_the_environment_that_it_says(tmp_path):
    env = gym.make("sitl/RoverWaypointDiscrete-v0")
    policy = made(env.observation_space, env.action_space, algorithm="dqn")
    env.close()
    policy_file.write(tmp_path / "p.npz", policy, {**ABOUT, "env": "sitl/RoverWaypointDiscrete-v0", "algorithm": "dqn"})
    found = rollout(tmp_path / "p.npz", episodes=3, robots=2)
    assert [one.steps for one in found.episodes] == [50, 50, 50]
    with pytest.raises(AgentError, match="the policy was trained on"):
        rollout(tmp_path / "p.npz", "sitl/CopterWaypointDiscrete-v0", episodes=1)
