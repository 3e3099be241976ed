# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.baselines``: what is made, in which order, what is kept, and when it is made anew."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.baselines import campaign as campaigns
from benchmarks.baselines import conditions, defaults, entries, page, references, running, shipped, work
from benchmarks.baselines.__main__ import main
from benchmarks.baselines.conditions import MAIN, NOMINAL, ROBUST, Condition
from benchmarks.baselines.records import Records, ResultError, line
from benchmarks.baselines.work import Job
from sitl.agents import baselines
from sitl.agents.errors import AgentError, ResumeError
from sitl.agents.runs.backends import Workers
from sitl.agents.runs.files import make_folder, write_bytes
from sitl.envs.worlds import TEST

NAME = "rover-waypoint"
FOREVER = float("inf")


@pytest.fixture
def few(monkeypatch):
    """A few conditions, of few episodes."""
    found = {
        NOMINAL: Condition("as trained", MAIN, 4),
        "estimate": Condition("by the estimate", MAIN, 4, {"judge": "estimate"}),
        "worlds-unseen": Condition("unseen", MAIN, 2, seeds=(1001, 1100)),
        "mass-120": Condition("mass +20 %", ROBUST, 2, scale={"mass": 1.2}),
    }
    monkeypatch.setattr(conditions, "CONDITIONS", found)
    monkeypatch.setattr(page, "CONDITIONS", found)


@pytest.fixture
def trained(monkeypatch):
    """Trainings give the policy that comes with the package, and are counted."""
    begun = []

    def train(job, send_progress, stopped):
        begun.append((job.name, job.seed))
        make_folder(job.policy.parent)
        write_bytes(job.policy, baselines.file(entries.plain_of(job.name)).read_bytes())
        return trained_record(job)

    monkeypatch.setattr(work, "train", train)
    monkeypatch.setattr(shipped, "key_of", lambda name: "")  # that policy is of no training that is known
    return begun


def trained_record(job, policy=None):
    return {
        "kind": "training", "key": job.key, "name": job.name, "seed": job.seed, "steps": 1000, "took_s": 10.0,
        "policy": policy or work.sha256(job.policy),
    }  # fmt: skip


def made(folder, *names, seeds=1, checked=True, steps=None):
    found = campaigns.campaign(names or (NAME,), folder / "results", folder / "runs", seeds, (), steps)
    if checked:
        found.references.check({entry.plain: entry.playing() for entry in found.chosen})
    return found


def ran(found, until=FOREVER):
    said = []
    return running.run(found, Workers(), until, said.append), said


def record(found, seed, what, reached, policy="p"):
    """An evaluation of a training, without either."""
    entry = found.chosen[0]
    env = found.references.digest(entry.plain)
    return {
        "kind": "episodes", "name": entry.name, "seed": seed, "what": what, "policy": policy, "took_s": 1.0,
        "key": entry.playing_key(seed, what, env), "reached": reached, "crashed": "0" * len(reached),
        "reward": [float(one) for one in reached], "mean_reward": 0.0,
    }  # fmt: skip


def fill(found, reached):
    """Trainings of the first baseline with these episodes, by seed."""
    for seed, one in enumerate(reached):
        job = Job(found.chosen[0].name, seed, (), True, found.references.digest(found.chosen[0].plain), found.runs)
        found.records.add(trained_record(job, "p"))
        found.records.add(record(found, seed, NOMINAL, one))


def test_it_makes_what_is_missing_and_nothing_twice(few, trained, tmp_path):
    done, said = ran(made(tmp_path))
    assert done and trained == [(NAME, 0)] and any("success 100.0 %" in text for text in said)
    path = tmp_path / "results" / f"{NAME}.jsonl"
    kept = path.read_text()
    rows = [json.loads(text) for text in kept.splitlines()]
    assert [(row["kind"], row["seed"], row.get("what")) for row in rows] == [
        ("episodes", 0, "estimate"), ("episodes", 0, "mass-120"), ("episodes", 0, NOMINAL),
        ("episodes", "random", NOMINAL), ("training", 0, None),
    ]  # fmt: skip
    assert rows[2]["reached"] == "1111" and rows[3]["reached"] != "1111"
    assert made(tmp_path).stages() == [] and ran(made(tmp_path)) == (True, [])
    assert trained == [(NAME, 0)] and path.read_text() == kept


def test_what_was_cut_off_goes_on(few, trained, tmp_path):
    assert ran(made(tmp_path), until=0.0)[0] is False and not trained
    found = made(tmp_path)
    job = replace(dict(found.stages())["training, seed 0"][0], whats=(NOMINAL,))
    sent = []
    assert work.do(job, sent.append, lambda: bool(sent)) is None  # stopped after the training
    for one in sent:
        found.records.add(one)
    assert [one["kind"] for one in sent] == ["training"]
    assert ran(made(tmp_path))[0] and trained == [(NAME, 0)]


def test_a_run_that_cannot_be_gone_on_with_begins_anew(few, tmp_path, monkeypatch):
    """Another version's: its vehicles had another state."""
    pytest.importorskip("stable_baselines3")
    job = replace(dict(made(tmp_path, checked=False).stages())["training, seed 0"][0], whats=())
    folders, sent = [], []

    def train_one(path, report, stopped):
        folders.append(sorted(file.name for file in path.iterdir()))
        if len(folders) == 1:
            (path / "model.zip").touch()
            raise ResumeError("model.zip is of another version")
        return True

    monkeypatch.setattr(work, "train_one", train_one)
    monkeypatch.setattr(work.learnt, "save", lambda run, path: path.touch())
    assert work.do(job, sent.append, lambda: False)
    assert folders == [["config.json"]] * 2
    assert sent[0] == ("anew", "model.zip is of another version") and sent[1]["kind"] == "training"
    said = []
    running.Progress(made(tmp_path, checked=False), 1.0, 1, said.append).take(job, sent[0])
    assert said == [f"{NAME}, seed 0 begins anew: model.zip is of another version"]


def test_a_policy_that_is_not_at_hand_is_trained_again(few, trained, tmp_path):
    ran(made(tmp_path))
    path = next((tmp_path / "runs" / "policies").iterdir())
    path.unlink()
    assert made(tmp_path).stages() == []  # for what is there, nobody needs it
    results = tmp_path / "results" / f"{NAME}.jsonl"
    results.write_text("".join(text for text in results.read_text().splitlines(True) if "mass-120" not in text))
    assert ran(made(tmp_path))[0] and trained == [(NAME, 0)] * 2


def test_evaluations_of_another_policy_do_not_count(few, tmp_path):
    found = made(tmp_path, checked=False)
    fill(found, ["1111"])
    assert found.episodes(found.chosen[0], 0, NOMINAL)
    found.records.add({**found.training(found.chosen[0], 0), "policy": "another"})
    assert found.episodes(found.chosen[0], 0, NOMINAL) is None


def test_another_recipe_makes_results_old(few, tmp_path, monkeypatch):
    found = made(tmp_path, checked=False)
    fill(found, ["1111"])
    entry = found.chosen[0]
    for change in ({"settings": {**entry.recipe.settings, "gamma": 0.9}}, {"steps": 7}, {"max_steps": 9}):
        assert found.training(replace(entry, recipe=replace(entry.recipe, **change)), 0) is None
    assert found.training(entry, 0) and found.training(replace(entry, steps=7), 0) is None
    monkeypatch.setitem(conditions.CONDITIONS, NOMINAL, Condition("as trained", MAIN, 5))
    assert found.training(entry, 0) and found.episodes(entry, 0, NOMINAL) is None


@pytest.mark.parametrize("factor, changed", [(1.0 + 1e-9, False), (1.1, True)])
def test_another_environment_makes_results_old_but_last_bits_do_not(few, tmp_path, factor, changed):
    made(tmp_path)
    path = tmp_path / "results" / references.FILE
    kept = json.loads(path.read_text())
    kept[NAME]["play"] = [figure * factor for figure in kept[NAME]["play"]]
    path.write_text(json.dumps(kept))
    fill(old := made(tmp_path, checked=False), ["1111"])
    assert old.references.check({NAME: old.chosen[0].playing()}) == [NAME] * changed
    assert (old.training(old.chosen[0], 0) is None) == changed


def test_other_rewards_are_another_environment():
    plain = references.play(entries.load(NAME).playing())
    assert references.same(plain, plain)
    assert not references.same(plain, {**plain, "task": {**plain["task"], "place_reward": 1.0}})


def test_seed_0_of_all_comes_first_and_the_shortest_first(tmp_path):
    names = ("copter-rooms", "copter-hover", "copter-hover-robust")
    found = made(tmp_path, *names, seeds=3, checked=False)
    stages = found.stages()
    assert [title for title, _ in stages] == [
        "random policy", "training, seed 0", "robustness, seed 0", "variants, seed 0",
        "training and robustness, seed 1", "training and robustness, seed 2", "variants, seed 1", "variants, seed 2",
    ]  # fmt: skip
    assert [job.name for job in dict(stages)["training and robustness, seed 1"]] == ["copter-hover", "copter-rooms"]
    whats = {(title, job.name): job.whats for title, jobs in stages for job in jobs}
    assert "worlds-unseen" in whats["training, seed 0", "copter-rooms"]
    assert "wind-8" in whats["variants, seed 0", "copter-hover-robust"]
    assert "worlds-unseen" not in whats["training, seed 0", "copter-hover"]
    assert {"nominal", "wind-8"} <= {*whats["training and robustness, seed 1", "copter-hover"]}
    assert found.left(stages) > found.left(stages[:2]) > 0.0


def test_a_training_that_two_stages_need_counts_once(tmp_path):
    found = made(tmp_path, checked=False)
    first, second = (
        found.seconds(dict(found.stages())[title][0]) for title in ("training, seed 0", "robustness, seed 0")
    )
    assert first[0] == second[0] > 0.0
    assert found.left(found.stages()[1:]) == pytest.approx(first[0] + first[1] + second[1])


def test_one_that_fails_does_not_stop_the_others(few, trained, tmp_path, monkeypatch):
    whole = work.evaluate

    def fail(job, policy, what):
        if job.name == NAME and job.seed == 0:
            raise AgentError("no such wheel")
        return whole(job, policy, what)

    monkeypatch.setattr(work, "evaluate", fail)
    done, said = ran(made(tmp_path, NAME, "rover-slalom"))
    assert not done and f"{NAME}, seed 0 failed: AgentError: no such wheel" in said
    assert any(text.startswith("rover-slalom, seed 0: success") for text in said)


def test_files_of_two_machines_are_merged_line_by_line(few, tmp_path):
    one, other = made(tmp_path / "one", checked=False), made(tmp_path / "other", checked=False)
    fill(one, ["1111"])
    fill(other, ["0000", "1100"])
    texts = [(tmp_path / name / "results" / f"{NAME}.jsonl").read_text() for name in ("one", "other")]
    (tmp_path / "one" / "results" / f"{NAME}.jsonl").write_text("".join(texts))
    merged = made(tmp_path / "one", seeds=2, checked=False)
    assert len(page.of_seeds(merged, merged.chosen[0], NOMINAL)) == 2
    merged.records.add(record(merged, 0, NOMINAL, "1010"))
    assert len(list(Records(tmp_path / "one" / "results").all())) == 4


def test_a_damaged_line_is_named(tmp_path):
    (tmp_path / "x.jsonl").write_text(line({"key": "k", "kind": "training", "name": "x"}) + "<<<<<<< HEAD\n")
    with pytest.raises(ResultError, match=r"x\.jsonl:2 is no result: '<<<<<<< HEAD'"):
        Records(tmp_path)


def test_only_old_results_of_the_named_are_deleted(few, tmp_path):
    found = made(tmp_path, checked=False)
    fill(found, ["1111"])
    for name in (NAME, "rover-slalom"):
        found.records.add({"kind": "training", "key": f"old {name}", "name": name, "seed": 0})
    assert found.records.prune([NAME], found.wanted_keys()) == 1
    keys = {one["key"] for one in Records(tmp_path / "results").all()}
    assert "old rover-slalom" in keys and f"old {NAME}" not in keys and len(keys) == 3


def test_conditions_change_what_they_say_and_keep_the_rest():
    hover = entries.load("copter-hover").playing()
    found = conditions.named("mass-120").config(hover).env_options["randomise"]
    assert found["mass"] == pytest.approx((1.368, 1.368)) and found["wind_speed"] == (0.0, 5.0)
    assert conditions.named("wind-8").config(hover).env_options["randomise"]["wind_speed"] == (8.0, 8.0)
    rooms = entries.load("copter-rooms-discrete").playing()
    assert conditions.named("worlds-unseen").config(rooms).env_options["world"] == "rooms:seed=1001..1100"
    labyrinth = entries.load("rover-labyrinth").playing()
    world = conditions.named("worlds-unseen").config(labyrinth).env_options["world"]
    assert world == TEST["rover-labyrinth"]
    assert "wind-8" not in conditions.of_group(ROBUST, "rover-race")


def test_variants_are_evaluated_where_their_plain_ones_are():
    robust, plain = entries.load("copter-gates-robust"), entries.load("copter-gates")
    assert robust.playing() == plain.playing() and "randomise" in robust.recipe.options
    assert robust.training_key(0, "e") != plain.training_key(0, "e") != plain.training_key(1, "e")


def test_the_median_training_is_shipped():
    assert shipped.median({0: (0.9, 1.0), 1: (1.0, 3.0), 2: (0.95, 0.0), 3: (1.0, 2.0), 4: (0.1, 0.0)}) == 2
    assert shipped.median({0: (0.9, 1.0), 1: (1.0, 3.0)}) == 0
    assert shipped.median({0: (1.0, 1.0), 1: (1.0, 1.0), 2: (1.0, 1.0)}) == 1


def test_shipping_takes_the_medians_file_and_figures(few, tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "FILE", tmp_path / "baselines.json")
    monkeypatch.setattr(baselines, "file", lambda name: tmp_path / f"{name}.npz")
    found, said, given = made(tmp_path, seeds=5, checked=False), [], iter([b"others", b"p"])
    monkeypatch.setattr(work, "sha256", lambda path: path.read_text())

    def train(job, send_progress, stopped):
        make_folder(job.policy.parent)
        job.policy.write_bytes(next(given))

    monkeypatch.setattr(work, "train", train)
    fill(found, ["1111", "1110", "1100", "1000", "0000"])
    page.ship(found, said.append)
    assert "seed 2 is trained again" in said[0] and "another policy" in said[1] and shipped.kept() == {}
    path = work.policy_file(found.runs, NAME, 2, found.training(found.chosen[0], 2)["key"])
    path.unlink()
    page.ship(found, said.append)
    row = shipped.kept()[NAME]
    assert (tmp_path / f"{NAME}.npz").read_bytes() == b"p" and len(said) == 3
    assert (row["training"], row["trainings"], row["solved"], row["episodes"]) == (2, 5, 2, 4)
    path.unlink()
    job = Job(NAME, 2, (), False, found.references.digest(NAME), found.runs)
    assert work._shipped(job) and path.read_bytes() == b"p"  # it is not trained again


def test_a_policy_that_is_not_there_is_trained_and_evaluated_as_a_whole(few, trained, tmp_path):
    """It may be another one on this machine: results of the one before do not stand beside its own."""
    found = made(tmp_path, seeds=1, checked=False)
    fill(found, ["1111"])
    path = work.policy_file(found.runs, NAME, 0, found.training(found.chosen[0], 0)["key"])
    make_folder(path.parent)
    path.write_bytes(b"p")
    stages = dict(found.stages())
    assert stages["robustness, seed 0"][0].whats == ("mass-120",)
    path.unlink()
    assert dict(found.stages())["robustness, seed 0"][0].whats == ("mass-120", NOMINAL, "estimate")


def test_a_training_that_has_not_learnt_is_not_shipped(few, tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "FILE", tmp_path / "baselines.json")
    found, said = made(tmp_path, seeds=1, checked=False), []
    fill(found, ["0100"])
    page.ship(found, said.append)
    assert said == [f"{NAME}: seed 0 has not learnt its task; the policy in the package stays"]
    assert shipped.kept() == {}


def test_programs_fly_what_is_trained_and_nothing_else_is_done(few, trained, tmp_path):
    programs = (
        conditions.Program("ardupilot", tmp_path / "arducopter"),
        conditions.Program("ardupilot", tmp_path / "ardurover"),
        conditions.Program("px4", tmp_path / "px4"),
    )
    names = ["rover-waypoint", "copter-hover", "copter-waypoint"]

    def found():
        return campaigns.campaign(names, tmp_path / "results", tmp_path / "runs", 1, programs, None, True)

    assert found().stages() == []  # nothing is trained
    for name in names[:2]:
        entry = entries.load(name)
        job = Job(name, 0, (), False, "", tmp_path / "runs")
        Records(tmp_path / "results").add(work.train(job, print, bool))
        Records(tmp_path / "results").add(played(entry, 0, NOMINAL, "1111", job))
    [(title, jobs)] = found().stages()
    assert title == "other autopilots"
    assert {job.name: job.whats for job in jobs} == {
        "rover-waypoint": ("ardupilot",),
        "copter-hover": ("ardupilot", "px4"),
    }
    assert conditions.program_of("copter-hover", "px4", programs).option == f"px4:{tmp_path / 'px4'}"
    for what, bits in (("ardupilot", "111"), ("px4", "110")):
        Records(tmp_path / "results").add(played(entries.load("copter-hover"), 0, what, bits, jobs[1]))
    assert [job.name for job in dict(found().stages())[title]] == ["rover-waypoint"]
    assert "| `copter-hover` | 100.0 (51 .. 100) | 3 of 3 | 3 of 3 | 2 of 3, 1 crashed |" in page.autopilots(found())


def test_programs_fly_the_policy_of_the_package_where_none_has_flown(few, trained, tmp_path, monkeypatch):
    found = made(tmp_path, seeds=3, checked=False)
    fill(found, ["1111", "1110", "1100"])
    jobs = [Job(NAME, seed, (), False, found.references.digest(NAME), found.runs) for seed in range(3)]
    assert found.flown_seed(found.chosen[0]) == 0  # of none is the policy here
    make_folder(jobs[1].policy.parent)
    jobs[1].policy.write_bytes(b"p")
    assert found.flown_seed(found.chosen[0]) == 1
    monkeypatch.setattr(shipped, "key_of", lambda name: jobs[2].key)
    assert found.flown_seed(found.chosen[0]) == 2
    found.records.add(record(found, 0, "ardupilot", "1111"))
    assert found.flown_seed(found.chosen[0]) == 0


def played(entry, seed, what, bits, job):
    return {
        "kind": "episodes", "name": entry.name, "seed": seed, "what": what, "key": entry.playing_key(seed, what, ""),
        "policy": work.sha256(job.policy), "reached": bits, "crashed": bits.translate({48: 49, 49: 48}), "took_s": 1.0,
    }  # fmt: skip


def test_tables_say_on_how_many_trainings_they_rest(few, tmp_path):
    found = made(tmp_path, seeds=5, checked=False)
    fill(found, ["1110"])
    assert "| 1 | 75.0 (30 .. 95) |" in page.results(found)  # Wilson's
    fill(found, ["1111", "1110", "1100", "1000", "0000"])
    found.records.add(record(found, 0, "mass-120", "01"))
    assert "| 5 | 50.0 (" in page.results(found) and page.suites(found) != page.NONE
    assert page.elsewhere(found, "rover").splitlines()[0] == "| policy | trainings | as trained | mass +20 % |"
    assert page.elsewhere(found, "copter") == page.NONE


def test_default_settings_have_a_curve_for_each_algorithm(tmp_path):
    found = made(tmp_path, "copter-hover", "copter-hover-discrete", "copter-hover-robust", checked=False)
    curves = defaults.missing(found)
    assert [(curve.env, curve.algorithm) for curve in curves] == [
        ("sitl/CopterHover-v1", "ppo"), ("sitl/CopterHoverDiscrete-v1", "ppo"), ("sitl/CopterHover-v1", "sac"),
        ("sitl/CopterHoverDiscrete-v1", "dqn"),
    ]  # fmt: skip
    found.records.add({
        "kind": "default", "key": curves[0].key, "name": "copter-hover", "what": "ppo", "seed": 0, "learnt": True,
        "curve": [(20480, 30.0, 0.5, 1.0), (40960, 72.0, 0.95, 2.0)],
    })  # fmt: skip
    assert defaults.missing(found) == curves[1:] and curves[0] in defaults.wanted(found)
    assert defaults.table_rows(found) == [("`sitl/CopterHover-v1`", "**95 % after 40,960 steps, 1.2 min**", "")]


def test_curves_are_not_out_of_date_because_no_training_wants_them(few, tmp_path):
    found = made(tmp_path)
    curve = defaults.wanted(found)[0]
    for key in (curve.key, "old"):
        found.records.add({"kind": "default", "key": key, "name": NAME, "what": "ppo", "seed": 0})
    words = [NAME, "--plan", "--prune", "--seeds", "1", "--results", str(tmp_path / "results")]
    assert main([*words, "--runs", str(tmp_path / "runs")]) == 0
    assert [one["key"] for one in Records(tmp_path / "results").all()] == [defaults.wanted(made(tmp_path))[0].key]


def test_the_plan_lists_and_makes_nothing(few, tmp_path, capsys):
    words = [NAME, "--plan", "--seeds", "2", "--results", str(tmp_path / "results"), "--runs", str(tmp_path / "runs")]
    assert main(words) == 0
    out = capsys.readouterr().out
    assert "== training and robustness, seed 1" in out and f"{NAME}: training" in out and "all: " in out
    assert not (tmp_path / "runs").exists()
    assert main(["rover-waypiont"]) == 1
    assert "baseline 'rover-waypiont' is not known" in capsys.readouterr().err


def test_lines_say_how_long_the_rest_takes(few, tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "kept", dict)
    found, said, now = made(tmp_path, checked=False), [], [0.0]
    monkeypatch.setattr(running.time, "monotonic", lambda: now[0])
    job = dict(found.stages())["training, seed 0"][0]
    training = found.expected(job.entry, None)
    progress = running.Progress(found, 4 * training, 2, said.append)
    assert progress.rest() == running.duration(2 * training)  # two at a time
    now[0] = 3 * training  # three times as slow as was expected
    progress.take(job, ("steps", job.entry.recipe.steps // 2))
    assert said[-1].endswith(f"150,000 of 300,000 steps; about {running.duration(1.75 * training)} left")
    progress.take(job, trained_record(job, "p"))
    assert said[-1].endswith(f"; about {running.duration(9 * training)} left")


def test_times_are_told_for_people():
    assert [running.duration(s) for s in (40.0, 420.0, 7500.0)] == ["40 s", "7 min", "2 h 05 min"]


def test_figures_of_a_record_are_numbers():
    assert np.array_equal(work.figures({"reached": "101"}, "reached"), [1.0, 0.0, 1.0])
