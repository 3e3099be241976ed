# SPDX-License-Identifier: BSD-3-Clause
"""Runs of DQN, PPO and SAC: trained, interrupted, resumed, checked on the way, played."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")
pytest.importorskip("torch", reason="deep agents need the extra 'rl'")

from sitl.agents import algorithms, environments
from sitl.agents.deep import checkpoint, training
from sitl.agents.deep.checks import BEST, JITTER, SEED, Checks
from sitl.agents.deep.settings import settings_of
from sitl.agents.errors import AgentError, ResumeError
from sitl.agents.evaluate import evaluate, evaluate_run, moved_starts
from sitl.agents.runs.evaluation_plan import EvaluationPlan
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.training import is_done
from tests.agents.deep_runs import CIRCUIT2, NAVIGATE, new, train, weights

ALGORITHMS = ("ppo", "dqn", "sac")


def rows_of(run):
    """All of the log that must repeat: nan as text, which equals itself."""
    return [[repr(value) for value in row[:-1]] for row in run.episodes.rows()]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_run_learns_to_its_end_and_plays(tmp_path, algorithm):
    run = new(tmp_path / "run", algorithm)
    reported = train(run)
    rows = run.episodes.rows()
    assert [row.episode for row in rows] == [row.episode for row in reported] == list(range(len(rows)))
    assert sum(row.steps for row in rows) >= 400 and is_done(run)
    assert all(row.steps == 50 or (row.steps < 50 and row.terminated) for row in rows)
    assert all(row.simulated_s == pytest.approx(environments.make(run.config).unwrapped.step_time * row.steps)
               for row in rows[:3])  # fmt: skip
    assert np.isnan(rows[-1].epsilon) == (algorithm != "dqn")
    found = evaluate_run(run, EvaluationPlan(episodes=2), seed=5)
    again = evaluate_run(RunFolder(run.path), EvaluationPlan(episodes=2), seed=5)
    assert found == again and all(1 <= played.steps <= 50 for played in found.episodes)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_an_interrupted_and_resumed_run_equals_an_uninterrupted_one(tmp_path, algorithm):
    whole, parts = new(tmp_path / "whole", algorithm), new(tmp_path / "parts", algorithm)
    train(whole)
    train(parts, episodes=2)
    between = len(parts.episodes.rows())
    assert not is_done(parts) and between >= 2
    train(RunFolder(parts.path), episodes=3)
    train(RunFolder(parts.path))
    assert rows_of(parts) == rows_of(whole)
    assert weights(parts) == weights(whole) and weights(parts, BEST) == weights(whole, BEST)
    assert checkpoint.score_of(parts.path / BEST) == checkpoint.score_of(whole.path / BEST)


def test_a_run_that_has_learnt_enough_ends(tmp_path, monkeypatch):
    """Two checks in a row with every episode solved; the second and third are."""
    whole, solved = Checks.score, iter([1, 2, 2, 2])

    def score(self, model):
        found = whole(self, model)
        self.solved = next(solved)
        return found

    monkeypatch.setattr(Checks, "score", score)
    run = new(tmp_path / "run", steps=5000, settings={"enough": 2})
    train(run, episodes=1)
    assert not is_done(run)
    train(RunFolder(run.path))
    steps = sum(row.steps for row in run.episodes.rows())
    assert is_done(run) and steps < 1000 and next(solved) == 2
    train(RunFolder(run.path))
    assert sum(row.steps for row in run.episodes.rows()) == steps


def test_another_seed_is_another_run_and_a_done_one_stays_as_it_is(tmp_path):
    one, same, other = (new(tmp_path / str(k), seed=seed) for k, seed in enumerate((1, 1, 2)))
    for run in (one, same, other):
        train(run)
    assert rows_of(one) == rows_of(same) != rows_of(other)
    before = weights(one)
    train(RunFolder(one.path))
    assert weights(one) == before and rows_of(one) == rows_of(same)


def test_learning_through_mavlink(tmp_path):
    options = {"observation": "scan", "start": "random:3", "step_time": 0.2}
    run = new(tmp_path / "run", env="GazeboMazeErleRoverLIDAR-v0", env_options=options, steps=150)
    train(run)
    assert is_done(run)
    found = evaluate_run(run, EvaluationPlan(episodes=3, options={"start": "turned"}), seed=2)
    assert len(found.episodes) == 3


def test_dictionaries_of_observations_are_learnt_from(tmp_path):
    options = {"observation": "scan+pose+goal", "task": "goal", "world": "maze", "step_time": 0.3}
    run = new(tmp_path / "run", env=NAVIGATE, env_options=options, steps=150)
    train(run)
    policy = training.policy(run)
    env = environments.make(run.config)
    policy.check(env.observation_space, env.action_space)
    policy.begin(0)
    assert env.action_space.contains(np.int64(policy.act(env.reset(seed=1)[0])))


def test_a_log_that_knows_more_than_the_model_is_cut_and_a_model_of_others_refused(tmp_path):
    run = new(tmp_path / "run")
    train(run, episodes=2)
    known = rows_of(run)
    run.episodes.append(run.episodes.rows()[:1])
    train(RunFolder(run.path), episodes=0)
    assert rows_of(run)[: len(known)] == known and [row.episode for row in run.episodes.rows()] == list(
        range(len(run.episodes.rows()))
    )
    other = new(tmp_path / "other", env_options={"observation": "digits"})
    (other.path / checkpoint.MODEL).write_bytes((run.path / checkpoint.MODEL).read_bytes())
    with pytest.raises(ResumeError, match="cannot be gone on with"):
        train(other)
    with pytest.raises(AgentError, match="features"):
        training.policy(run).check(environments.make(other.config).observation_space, None)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_the_network_that_plays_is_the_one_that_learnt(tmp_path, algorithm):
    run = new(tmp_path / "run", algorithm, steps=50)
    train(run)
    model, _ = checkpoint.load(training.model_of(run), algorithm)
    network, rng = training.policy(run).network, np.random.default_rng(0)
    for row in rng.uniform(-2.0, 2.0, (50, *model.observation_space.shape)).astype(np.float32):
        expected, _ = model.predict(row, deterministic=True)
        assert network(row[None])[0] == pytest.approx(expected, abs=1e-5)


def test_what_cannot_be_is_refused(tmp_path):
    for name, value in (
        ("gama", 0.9),
        ("gamma", 1.5),
        ("robots", 0),
        ("batch", 2.5),
        ("reward_scale", 0.0),
        ("check_by", "luck"),
    ):
        with pytest.raises(AgentError, match=name):
            training.settings("ppo", {name: value})
    with pytest.raises(AgentError, match="'rollout' of sac"):
        training.settings("sac", {"rollout": 3})
    with pytest.raises(AgentError, match="sac learns continuous actions"):
        environments.try_all([new(tmp_path / "a", "sac", env_options={"action": "discrete"}).config])
    with pytest.raises(AgentError, match="dqn learns discrete actions"):
        options = {"action": "continuous", "task": "wander"}
        environments.try_all([new(tmp_path / "b", "dqn", env_options=options).config])
    with pytest.raises(AgentError, match="there is no model"):
        algorithms.policy_of(new(tmp_path / "c"))
    broken = new(tmp_path / "d", env=CIRCUIT2)
    (broken.path / checkpoint.MODEL).write_bytes(b"no zip")
    with pytest.raises(AgentError, match="is no model"):
        train(broken)


def checks_of(run, begun=0, path=None):
    """Of a run, as it has them."""
    settings = settings_of(run.config.algorithm, run.config.settings)
    return Checks(run.config, settings, path or run.path / BEST, begun)


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
    played = checkpoint.load(training.model_of(run), run.config.algorithm)[0].policy.state_dict()
    assert {name: values.numpy().tobytes() for name, values in played.items()} == seen[1][1]


@pytest.mark.parametrize(("options", "by"), [({}, "reward"), ({"start": "random"}, "crashes")])
def test_a_score_is_what_an_evaluation_finds(tmp_path, options, by):
    run = new(tmp_path / "run", env_options=options, settings={"check_episodes": 4, "check_by": by})
    train(run)
    policy, checks = training.policy(run), checks_of(run, 1)
    model, _ = checkpoint.load(training.model_of(run), run.config.algorithm)
    env = environments.make(run.config)
    poses = None if options else moved_starts(env, 4, SEED, JITTER)
    found = evaluate(env, policy, 4, SEED, poses)
    crashes = -sum(played.crashed for played in found.episodes)
    expected = (found.mean_reward,) if by == "reward" else (crashes, found.mean_reward)
    assert checks.score(model) == pytest.approx(expected) == checkpoint.score_of(run.path / BEST)
    seen = checks._begun(checks._made())
    for k in range(4):
        begin = {"pose": poses[k]} if poses else None
        assert np.array_equal(seen[k], env.reset(seed=environments.seed_of(SEED, k), options=begin)[0])
    assert not np.array_equal(seen[0], seen[1])
    assert checks.score(model) == pytest.approx(expected)
    checks.close()


class Straight:
    """A model that always goes forward."""

    def predict(self, rows, deterministic):
        return np.zeros(len(rows), np.int64), None


def test_a_network_that_crashes_more_often_than_the_best_is_not_played_to_the_end(tmp_path, monkeypatch):
    run = new(tmp_path / "run", env_options={"start": "random"}, settings={"check_episodes": 6, "check_by": "crashes"})
    checks = checks_of(run)
    env, steps = checks._made(), []
    step = env.step
    monkeypatch.setattr(env, "step", lambda actions: steps.append(1) or step(actions))
    score = checks.score(Straight())
    crashes, whole = -score[0], len(steps)
    assert crashes > 1
    for most, plays_all in ((crashes, True), (0.0, False)):
        steps.clear()
        checks._best = (-most, 1e6)
        found = checks.score(Straight())
        assert not found > checks._best and (found == score) == plays_all
        assert (len(steps) == whole) == plays_all
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
