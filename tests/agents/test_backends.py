# SPDX-License-Identifier: BSD-3-Clause
"""Work on a Ray cluster: the results, errors, interrupts of the local backend, without a folder that both see."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from sitl.agents.errors import AgentError
from sitl.agents.runs import local
from sitl.agents.runs.backends import Workers, each
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.training import train_all, train_one
from sitl.core import ray_cluster as instances
from sitl.errors import MissingExtra, OptionError
from tests.agents import ray_works
from tests.agents.small_runs import CIRCUIT2, new, result
from tests.ports import free_port

REASON = "Ray is not installed: pip install 'gym-sitl[ray]'"
on_ray = partial(each, backend="ray")


@pytest.fixture(scope="module")
def ray():
    """An instance on this machine, for all tests of this file."""
    pytest.importorskip("ray", reason=REASON)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join(sys.path))  # the works of these tests are not of the package
        patch.delenv("RAY_ADDRESS", raising=False)
        with instances.cluster(2) as module:
            yield module


def seeds(folder, count=3, **fields):
    return [new(folder / str(seed), seed=seed, **fields) for seed in range(count)]


@pytest.mark.slow
def test_runs_are_those_of_local_processes(ray, tmp_path):
    here, there = seeds(tmp_path / "here"), seeds(tmp_path / "there")
    reported = []
    assert train_all([run.path for run in here])
    assert train_all(
        [run.path for run in there], 2, lambda index, rows: reported.extend((index, r) for r in rows), on_ray
    )
    assert [result(run) for run in there] == [result(run) for run in here]
    rows = [[row[:-1] for row in run.episodes.rows()] for run in there]
    assert [[row[:-1] for index, row in reported if index == k] for k in range(3)] == rows
    assert {path.name for path in there[0].path.iterdir()} == {"config.json", "episodes.csv", "model.npz", "best.npz"}


@pytest.mark.slow
def test_deep_runs_are_those_of_local_processes(ray, tmp_path):
    pytest.importorskip("stable_baselines3", reason="deep agents are not installed: pip install 'gym-sitl[rl]'")
    from tests.agents.deep_runs import new as new_deep
    from tests.agents.deep_runs import weights

    here, there = new_deep(tmp_path / "here", steps=100), new_deep(tmp_path / "there", steps=100)
    assert train_all([here.path]) and train_all([there.path], do=on_ray)
    rows = [repr([row[:-1] for row in run.episodes.rows()]) for run in (here, there)]
    assert rows[0] == rows[1] and weights(here) == weights(there)


@pytest.mark.slow
@pytest.mark.parametrize("backends", [("ray", "local"), ("local", "ray")])
def test_interrupted_on_one_backend_it_goes_on_with_the_other(ray, tmp_path, backends):
    whole, parts = new(tmp_path / "whole", episodes=3000), new(tmp_path / "parts", episodes=3000)
    train_one(whole.path, lambda rows: None, lambda: False)
    asked = []

    def interrupt(index, message):
        if not asked and not isinstance(message, int):
            asked.append(True)
            signal.raise_signal(signal.SIGTERM)

    assert each(ray_works.train_eagerly, [parts.path], 1, interrupt, backends[0]) == [False]
    done = len(parts.episodes.rows())
    assert 0 < done < 3000
    assert train_all([parts.path], do=partial(each, backend=backends[1]))
    assert result(parts) == result(whole)


@pytest.mark.slow
def test_items_not_begun_before_an_interrupt_have_no_result(ray, tmp_path):
    runs = seeds(tmp_path, episodes=20_000)
    reported = lambda index, message: isinstance(message, int) and signal.raise_signal(signal.SIGINT)  # noqa: E731
    assert on_ray(ray_works.train_eagerly, [run.path for run in runs], 1, reported) == [False, None, None]


@pytest.mark.slow
def test_a_killed_worker_is_replaced_and_goes_on_from_what_was_kept(ray, tmp_path):
    whole, killed = new(tmp_path / "whole", episodes=5000), new(tmp_path / "killed", episodes=5000)
    train_one(whole.path, lambda rows: None, lambda: False)
    processes, kept = [], []

    def reported(index, message):
        if isinstance(message, int):
            processes.append(message)
        elif not kept and (killed.path / "model.npz").exists():
            kept.append(len(killed.episodes.rows()))
            os.kill(processes[0], signal.SIGKILL)

    assert on_ray(ray_works.train_eagerly, [killed.path], 1, reported) == [True]
    assert len(set(processes)) == 2 and 0 < kept[0] < 5000
    assert result(killed) == result(whole)


@pytest.mark.slow
def test_an_item_that_kills_its_workers_is_given_up(ray):
    with pytest.raises(RuntimeError, match="3 Ray workers in a row died of item 1 \\(bad\\)"):
        on_ray(_die_if_bad, ["good", "bad"], 2)


def _die_if_bad(item, tell, stopped):
    return ray_works.die(item, tell, stopped) if item == "bad" else item


@pytest.mark.slow
def test_errors_of_the_work_are_raised_here_and_name_our_folders(ray, tmp_path):
    bad = new(tmp_path / "bad", env_options={"world": "nowhere"})
    with pytest.raises(AgentError, match="nowhere"):
        on_ray(train_one, [bad.path])
    with pytest.raises(AgentError) as error:
        on_ray(train_one, [tmp_path / "none"])
    assert str(error.value) == f"{tmp_path / 'none'} is no run: it has no config.json"
    with pytest.raises(RuntimeError, match="OddError: this and that"):
        on_ray(ray_works.fail_oddly, [1])


@pytest.mark.slow
def test_folders_go_and_come_back(ray, tmp_path):
    for name in ("old", "same", "inner/deep", ".hidden"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(name)
    reported = []
    ((place, there),) = on_ray(ray_works.write_and_list, [(tmp_path, "word")], 1, lambda *words: reported.append(words))
    assert place != str(tmp_path) and not Path(place).exists()
    assert there == ["inner/deep", "old", "same"] and reported == [(0, "word")]
    found = {path.relative_to(tmp_path).as_posix(): path.read_text() for path in tmp_path.rglob("*") if path.is_file()}
    assert found == {"same": "same", "inner/deep": "inner/deep", ".hidden": ".hidden", "inner/new": "word"}


@pytest.mark.slow
def test_workers_with_other_versions_are_refused(ray, monkeypatch):
    from sitl.agents.runs import on_ray as module

    known = module.libraries()
    monkeypatch.setattr(module, "libraries", lambda: {**known, "gym-sitl": "0.0.0", "torch": "1.0"})
    with pytest.raises(AgentError, match=f"has gym-sitl {known['gym-sitl']}, not 0.0.0.*install the same there"):
        on_ray(train_one, ["never"])
    pool = module._Pool(ray, train_one, [], lambda *words: None, {})
    with pytest.raises(AgentError, match=r"worker at far cannot load gym-sitl: No module"):
        pool._check({"host": "far", "error": "No module named 'agents'"})


@pytest.mark.slow
def test_workers_of_a_cluster_get_the_threads_of_the_command(ray, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    assert on_ray(ray_works.threads, [1]) != ["3"]  # of an instance that began before
    assert on_ray(ray_works.threads, [1], address="127.0.0.1:1") == ["3"]  # as if that were a cluster's


@pytest.mark.slow
def test_an_instance_of_ours_is_this_machines_alone(ray):
    assert ray.util.get_node_ip_address() == "127.0.0.1"
    before = signal.getsignal(signal.SIGTERM)
    with instances.cluster(1) as same:
        assert same is ray and ray.cluster_resources()["CPU"] == 2
    assert ray.is_initialized() and signal.getsignal(signal.SIGTERM) is before
    assert on_ray(train_one, []) == []


def test_backends_that_cannot_be_are_refused(monkeypatch):
    with pytest.raises(AgentError, match="'cloud' is not known; it is one of local, ray"):
        each(train_one, [], backend="cloud")
    with pytest.raises(AgentError, match="only the backend ray has one"):
        Workers(2, "local", "127.0.0.1:6379")
    monkeypatch.setattr(instances.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"gym-sitl\[ray\]"):
        Workers(2, "ray")


def test_addresses_where_no_cluster_is_are_refused_at_once():
    port = free_port()
    for address, message in ((f"127.0.0.1:{port}", "no Ray cluster answers"), ("there", "must be HOST:PORT")):
        with pytest.raises(OptionError, match=message):
            instances._knock(*instances._host_and_port(address), address)


def test_local_is_the_default():
    assert Workers().each(lambda item, tell, stopped: item + 1, [1, 2]) == [2, 3]
    assert each(lambda item, tell, stopped: item + 1, [1]) == local.each(lambda item, tell, stopped: item + 1, [1])


@pytest.mark.slow
def test_ctrl_c_in_a_terminal_meets_the_command_and_not_its_workers(tmp_path):
    pytest.importorskip("ray", reason=REASON)
    folder = tmp_path / "runs"
    command = [sys.executable, "-c", "import sys; from sitl.cli import main; sys.exit(main())", "train"]
    words = [CIRCUIT2, "--max-steps", "60", "--seeds", "2", "--jobs", "2", "--backend", "ray", "--out", str(folder)]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    env.pop("RAY_ADDRESS", None)
    log = (tmp_path / "log").open("w+")
    process = subprocess.Popen(
        [*command, *words, "--episodes", "200k"], env=env, stdout=log, stderr=log, start_new_session=True
    )
    deadline = time.monotonic() + 120.0
    models = [folder / f"seed-{seed}" / "model.npz" for seed in range(2)]
    while not all(model.exists() for model in models) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.1)
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(60) == 130
    log.seek(0)
    text = log.read()
    assert f"interrupted; continue with: sitl train --resume {folder}" in text
    assert "Ray" not in text and "ray" not in text
    for seed in range(2):
        run = RunFolder(folder / f"seed-{seed}")
        done = len(run.episodes.rows())
        again = new(tmp_path / str(seed), seed=seed, episodes=done, settings=run.config.settings)
        assert 0 < done < 200_000 and train_one(again.path, lambda rows: None, lambda: False)
        assert result(again) == result(run)
