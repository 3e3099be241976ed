# SPDX-License-Identifier: BSD-3-Clause
"""Now and then a network plays greedily, and the best one is kept."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
pytest.importorskip("torch", reason="deep agents need the extra 'rl'")

from sitl.agents import environments
from sitl.agents.deep import checkpoint, training
from sitl.agents.deep.checks import BEST, JITTER, SEED, Checks
from sitl.agents.deep.settings import settings_of
from sitl.agents.errors import AgentError
from sitl.agents.evaluate import evaluate, moved_starts
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.plan import EvaluationPlan
from tests.agents.deep_runs import CIRCUIT2, new, train, weights


def checks_of(run, begun=0, path=None):
    """Of a run, as it has them."""
    figures = settings_of(run.config.algorithm, run.config.settings)
    return Checks(run.config, figures, path or run.path / BEST, begun)


def rows_of(run):
    """All of the log that must repeat."""
    return [[repr(value) for value in row[:-1]] for row in run.episodes.rows()]


@pytest.mark.parametrize("algorithm", ["ppo", "dqn", "sac"])
def test_they_change_nothing_of_what_is_learnt(tmp_path, algorithm):
    run = new(tmp_path / "run", algorithm)
    without = new(tmp_path / "without", algorithm, settings={"check_every": 0})
    train(run)
    train(without)
    assert rows_of(run) == rows_of(without) and weights(run) == weights(without)
    assert (run.path / BEST).exists() and not (without.path / BEST).exists()
    training.policy(without)


def test_the_best_network_is_kept_and_plays(tmp_path, monkeypatch):
    run, scores, seen = new(tmp_path / "run"), iter([(1.0,), (5.0,), (4.0,), (5.0,)]), []

    def score(self, model):
        self._made()
        seen.append((model.num_timesteps, {k: v.numpy().tobytes() for k, v in model.policy.state_dict().items()}))
        return next(scores)

    monkeypatch.setattr(Checks, "score", score)
    train(run)
    steps = [at for at, _ in seen]
    assert 3 <= len(steps) <= 4 and all(at // 150 == k for k, at in enumerate(steps[:-1], 1))
    assert checkpoint.score_of(run.path / BEST) == (5.0,) and weights(run, BEST) == seen[1][1] != weights(run)
    played = training.policy(run).model.policy.state_dict()
    assert {name: values.numpy().tobytes() for name, values in played.items()} == seen[1][1]


@pytest.mark.parametrize(("options", "by"), [({}, "reward"), ({"start": "random"}, "crashes")])
def test_a_score_is_what_an_evaluation_finds(tmp_path, options, by):
    run = new(tmp_path / "run", env_options=options, settings={"check_episodes": 4, "check_by": by})
    train(run)
    policy, checks = training.policy(run), checks_of(run, 1)
    env = environments.make(run.config)
    poses = None if options else moved_starts(env, 4, SEED, JITTER)
    found = evaluate(env, policy, 4, SEED, poses)
    crashes = -sum(played.crashed for played in found.episodes)
    expected = (found.mean_reward,) if by == "reward" else (crashes, found.mean_reward)
    assert checks.score(policy.model) == pytest.approx(expected) == checkpoint.score_of(run.path / BEST)
    seen = checks._begun(checks._made())
    for k in range(4):
        begin = {"pose": poses[k]} if poses else None
        assert np.array_equal(seen[k], env.reset(seed=environments.seed_of(SEED, k), options=begin)[0])
    assert not np.array_equal(seen[0], seen[1])
    assert checks.score(policy.model) == pytest.approx(expected)
    checks.close()


def test_a_new_run_forgets_the_best_of_another(tmp_path):
    run = new(tmp_path / "run", env=CIRCUIT2)
    (run.path / BEST).write_bytes(b"no zip")
    with pytest.raises(AgentError, match="is no model"):
        training.policy(run)
    with pytest.raises(AgentError, match="is no model"):
        checks_of(run, 1)
    assert checks_of(RunFolder(run.path))._best == () and not (run.path / BEST).exists()


def test_they_play_as_the_run_is_evaluated(tmp_path):
    run = new(tmp_path / "run", evaluation=EvaluationPlan(max_steps=7, options={"start": "turned"}))
    checks = checks_of(run)
    env = checks._made()
    checks._begun(env)
    headings = env.unwrapped.robot.pose[:, 3]
    assert env.unwrapped.max_episode_steps == 7 and len(set(headings.tolist())) == len(headings) > 1
    checks.close()
