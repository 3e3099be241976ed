# SPDX-License-Identifier: BSD-3-Clause
"""Run folders, recipes, plans and suites of others: what they name is not run unless the user allows it."""

from __future__ import annotations

import json
import os

import pytest

from sitl.agents.errors import AgentError
from sitl.agents.recipes import recipe
from sitl.agents.rehearsal import plan
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.folder import CONFIG, RunFolder
from sitl.core import code_in_files
from sitl.missions.suite import cases

ROVER = "GazeboMazeErleRoverLIDAR-v0"
REFUSED = "names code that would be run, or acts on a vehicle: {}.*SITL_ALLOW_CODE=1"
NAMED = [
    ({"frame": "theirs.py"}, r"frame = 'theirs\.py'"),
    ({"autopilot": "ardupilot:./theirs"}, r"autopilot = 'ardupilot:\./theirs'"),
    ({"autopilot": "px4"}, "autopilot = 'px4'"),
    ({"autopilot": "ardupilot:./a:tcp:b/theirs"}, r"autopilot = 'ardupilot:\./a:tcp:b/theirs'"),
    ({"autopilot": "px4:./a:udp:b/theirs"}, r"autopilot = 'px4:\./a:udp:b/theirs'"),
    ({"autopilot_path": "./theirs"}, r"autopilot_path = '\./theirs'"),
    ({"connection": "tcp:127.0.0.1:1", "reset": "force"}, "reset = 'force'"),
    ({"connection": "tcp:127.0.0.1:1", "guard": False}, "guard = False"),
    ({"params": "/etc/theirs.parm"}, "params = '/etc/theirs.parm'"),
]


@pytest.fixture(autouse=True)
def untrusting(monkeypatch):
    """Nothing is allowed, and what a test allows is forgotten."""
    monkeypatch.setenv(code_in_files.VARIABLE, "")


def marking(folder):
    """A Python file of an airframe that leaves a mark."""
    code = f"from sitl import vehicles\nopen({str(folder / 'marker')!r}, 'w')\nAIRFRAME = vehicles.load('erle_rover')\n"
    (folder / "theirs.py").write_text(code)
    return folder / "theirs.py"


def run_folder(folder, **fields):
    """As somebody has sent it."""
    folder.mkdir(exist_ok=True)
    values = {"env": ROVER, "algorithm": "qlearn", **fields}
    (folder / CONFIG).write_text(json.dumps(values))
    return folder


@pytest.mark.parametrize(("options", "said"), NAMED)
def test_a_run_folder(tmp_path, options, said):
    for fields in ({"env_options": options}, {"evaluation": {"options": options}}):
        with pytest.raises(AgentError, match=REFUSED.format(said)):
            RunFolder(run_folder(tmp_path / "run", **fields))


def test_a_module_before_an_id_is_code(tmp_path):
    """Gymnasium would import it."""
    with pytest.raises(AgentError, match=REFUSED.format("env = 'theirs:Env-v0'")):
        RunFolder(run_folder(tmp_path / "run", env="theirs:Env-v0"))


def test_an_environment_of_the_old_gym_is_code(tmp_path):
    """It takes the id of another one, which may name a module."""
    with pytest.raises(AgentError, match=REFUSED.format("env = 'GymV26Environment-v0'")):
        RunFolder(run_folder(tmp_path / "run", env="GymV26Environment-v0", env_options={"env_id": "theirs:Env-v0"}))


def test_an_autopilot_that_runs_elsewhere_is_no_program(tmp_path):
    options = {"autopilot": "ardupilot:tcp:127.0.0.1:5760"}
    assert RunFolder(run_folder(tmp_path / "run", env_options=options)).config.code == []


def test_what_the_user_allows(tmp_path, monkeypatch):
    theirs = run_folder(tmp_path / "theirs", env_options={"frame": "theirs.py"})
    monkeypatch.setenv(code_in_files.VARIABLE, "1")
    assert RunFolder(theirs).config.env_options == {"frame": "theirs.py"}
    monkeypatch.setenv(code_in_files.VARIABLE, "")
    own = RunFolder.create(tmp_path / "own", RunConfig(ROVER, "qlearn", {"frame": "my.py"}))
    assert RunFolder(own.path).config.code == ["frame = 'my.py'"]
    assert "my.py" in os.environ[code_in_files.VARIABLE]  # workers of this process may, too
    with pytest.raises(AgentError, match=r"theirs\.py"):
        RunFolder(theirs)


@pytest.mark.parametrize("options", [{"frame": "erle_rover"}, {"autopilot": "ardupilot:tcp:127.0.0.1:5760"}, {}])
def test_data_are_taken(tmp_path, options):
    assert RunFolder(run_folder(tmp_path / "run", env_options=options)).config.code == []


def test_a_recipe(tmp_path):
    file = tmp_path / "theirs.toml"
    file.write_text(f'env = "{ROVER}"\nalgorithm = "qlearn"\n[options]\nframe = "{marking(tmp_path)}"\n')
    with pytest.raises(AgentError, match="recipe .*theirs.toml: it " + REFUSED.format("frame")):
        recipe.read(file)
    assert not (tmp_path / "marker").exists()


def test_a_rehearsal_plan(tmp_path):
    file = tmp_path / "theirs.toml"
    file.write_text('[[change]]\nname = "a"\ngroup = "world"\noptions = {frame = "theirs.py"}\n')
    with pytest.raises(AgentError, match="plan .*theirs.toml: it " + REFUSED.format("frame")):
        plan.load(str(file))


@pytest.mark.parametrize("table", ["[defaults]", "[[missions]]\nlibrary = 'rover/*'"])
def test_a_suite(tmp_path, table):
    marking(tmp_path)
    text = f"{table}\nframe = 'theirs.py'\n"
    (tmp_path / cases.TOML).write_text(text)
    with pytest.raises(cases.SuiteError, match=r"suite\.toml " + REFUSED.format("frame")):
        cases.find(tmp_path)
    assert not (tmp_path / "marker").exists()
