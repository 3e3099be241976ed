# SPDX-License-Identifier: BSD-3-Clause
"""Run folders, recipes, plans and suites of others: what they name is not run unless the user allows it."""

from __future__ import annotations

import json
import os

import pytest

from sitl import cli, vehicles, worlds
from sitl.agents import environments
from sitl.agents.errors import AgentError
from sitl.agents.recipes import recipe
from sitl.agents.rehearsal import plan
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.folder import CONFIG, RunFolder
from sitl.core import code_in_files
from sitl.envs.options import COMMON
from sitl.envs.robots.vehicles import AutopilotOptions
from sitl.missions.suite import cases
from sitl.worlds import generated

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


OUTSIDE = [
    ({"connection": "tcp:127.0.0.1:1"}, "connection = 'tcp:127.0.0.1:1'", "connection=tcp:127.0.0.1:1"),
    ({"connection": "serial:/dev/ttyACM0:57600"}, "connection = 'serial:", "connection=serial:/dev/ttyACM0:57600"),
    ({"gcs": "udp:127.0.0.1:14550"}, "gcs = 'udp:127.0.0.1:14550'", "gcs=udp:127.0.0.1:14550"),
    ({"world": "theirs.toml"}, r"world = 'theirs\.toml'", "world=theirs.toml"),
    ({"world": "x:.toml"}, r"world = 'x:\.toml'", "world=x:.toml"),
    ({"world": "forest:.toml"}, r"world = 'forest:\.toml'", "world=forest:.toml"),
    ({"world": "forest:seed=1.toml"}, r"world = 'forest:seed=1\.toml'", "world=forest:seed=1.toml"),
    ({"world": "theirs:seed=1"}, "world = 'theirs:seed=1'", "world=theirs:seed=1"),
    ({"threads": 100_000}, "threads = 100000", "threads=100000"),
    ({"world": "/dev/zero"}, "world = '/dev/zero'", "world=/dev/zero"),
    ({"world": "../a b.toml"}, r"world = '\.\./a b\.toml'", "world='../a b.toml'"),
    ({"world": ["maze", "theirs.toml"]}, r"world = \['maze', 'theirs\.toml'\]", """world='["maze", "theirs.toml"]'"""),
    ({"world": "rooms:seed=1../x.toml"}, r"world = 'rooms:seed=1\.\./x\.toml'", "world=rooms:seed=1../x.toml"),
    ({"physics": "json:127.0.0.1:9002"}, "physics = 'json:127.0.0.1:9002'", "physics=json:127.0.0.1:9002"),
    ({"params": "/etc/theirs.parm"}, "params = '/etc/theirs.parm'", "params=/etc/theirs.parm"),
    ({"render_mode": "human"}, "render_mode = 'human'", "render_mode=human"),
    ({"save_to": "/tmp/log"}, "save_to = '/tmp/log'", "save_to=/tmp/log"),
    ({"address": {"host": "a"}}, "address = {'host': 'a'}", "address='{'"),
]


@pytest.mark.parametrize(("options", "said", "option"), OUTSIDE)
def test_what_opens_a_socket_a_window_or_a_file(tmp_path, options, said, option):
    with pytest.raises(AgentError, match=f"config.json reaches outside of this process: {said}") as error:
        RunFolder(run_folder(tmp_path / "run", env_options=options))
    assert option[:-1] in str(error.value) and "SITL_ALLOW_CODE=1" in str(error.value)
    code_in_files.allow_options(options)
    assert RunFolder(run_folder(tmp_path / "run", env_options=options)).config.env_options == options


@pytest.mark.parametrize("autopilot", ["ardupilot:tcp:127.0.0.1:5760", "px4:udp:127.0.0.1:14540"])
def test_an_autopilot_that_runs_elsewhere(tmp_path, autopilot):
    with pytest.raises(AgentError, match=REFUSED.format(f"autopilot = '{autopilot}'")):
        RunFolder(run_folder(tmp_path / "run", env_options={"autopilot": autopilot}))


def test_environments_of_others_take_numbers_alone(tmp_path):
    theirs = {"env": "FrozenLake-v1", "env_options": {"is_slippery": False, "reward_schedule": [1, 0, 0]}}
    assert RunFolder(run_folder(tmp_path / "run", **theirs)).config.code == []
    with pytest.raises(AgentError, match="reaches outside of this process: map_name = '8x8'"):
        RunFolder(run_folder(tmp_path / "run", env="FrozenLake-v1", env_options={"map_name": "8x8"}))


def test_names_of_worlds_are_no_files():
    assert set(code_in_files.MADE) == set(generated.GENERATORS)
    made = ("forest", "forest:", "forest:seed=3,difficulty=0.8", "car-park:size=4e1", *worlds.names())
    lists = ("rooms:seed=1..3", ["maze", "labyrinth:size=60,seed=1..2,scale=3"])
    free = [{"world": name} for name in (*made, *lists)] + [{"threads": count} for count in (1, os.cpu_count())]
    assert [named for options in free for named in code_in_files.code_of_options(options)] == []
    for name in (*made, *lists):
        worlds.load_all(name)


@pytest.mark.parametrize("world", ["rooms:seed=1..100", ["maze", "labyrinth:size=60,seed=5..9"], []])
def test_nor_are_lists_of_worlds(world):
    assert code_in_files.code_of_options({"world": world}) == []


@pytest.mark.parametrize("world", ["rooms:seed=1..x", "/etc:seed=1..2", ["maze", "./mine.toml"], "rooms:seed=1...2"])
def test_a_list_with_a_file_in_it_is_one(world):
    assert code_in_files.code_of_options({"world": world})


@pytest.mark.parametrize(
    "options", [{"num_envs": 10**9}, {"vector_kwargs": None}, {"disable_env_checker": True}, {"self": 1}]
)
def test_what_is_not_the_environments_is_no_option(tmp_path, options):
    run = RunFolder(run_folder(tmp_path / "run", env_options=options))
    name = next(iter(options))
    for make in (environments.make, lambda config: environments.make_many(config, 2)):
        with pytest.raises(AgentError, match=f"{ROVER}: .*{name}"):
            make(run.config)


def test_every_option_that_a_file_may_say_is_an_option():
    known = {*COMMON, *AutopilotOptions.names(), "render_mode", "max_episode_steps", "autoreset_mode", "tiled"}
    assert set(code_in_files.FREE) == known


@pytest.mark.parametrize(
    ("options", "again"), [({"world": "circuit2"}, ()), ({"world": "there.toml"}, ["--option", "world=there.toml"])]
)
def test_the_command_line_says_it(tmp_path, capsys, options, again):
    folder = run_folder(tmp_path / "run", env_options=options)
    assert cli.main(["export", str(folder), str(tmp_path / "p.npz"), *again]) == 2
    assert "reaches outside" not in capsys.readouterr().err


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


@pytest.mark.parametrize(
    "options",
    [
        {"frame": "erle_rover"},
        {},
        {"world": "forest:seed=3,difficulty=0.8", "physics": "pybullet", "connection": "inprocess"},
        {"world": "maze-erlerover", "randomise": {"mass": [0.9, 1.1]}, "faults": {"motor:2=0.5": [1, 2]}},
        {"observation": {"seen": "scan", "goal": ["goal", "velocity"]}, "action": {"ahead": [1, 0, 0, 0]}},
        {"start": "random:400", "home": [-35.0, 149.0, 584.0, 0.0], "params": {"SIM_WIND_SPD": 3.0}},
    ],
)
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


def test_a_plan_whose_recipe_is_a_file(tmp_path):
    file = tmp_path / "theirs.toml"
    file.write_text('[training]\nrecipe = "/etc/a.toml"\n[[change]]\nname = "a"\ngroup = "world"\nmirror = true\n')
    with pytest.raises(AgentError, match=r"it reaches outside of this process: training.recipe = '/etc/a\.toml'"):
        plan.load(str(file))


SUITES = [
    ('world = "/etc/hosts"', "world = '/etc/hosts'"),
    ('world = "elsewhere.toml"', r"world = 'elsewhere\.toml'"),
    ('physics = "hil:tcp:127.0.0.1:4560"', "physics = 'hil:tcp:127.0.0.1:4560'"),
    ('tolerance = "../t.toml"', r"tolerance = '\.\./t\.toml'"),
]


@pytest.mark.parametrize(("line", "said"), SUITES)
@pytest.mark.parametrize("table", ["[defaults]", "[[missions]]\nlibrary = 'rover/*'"])
def test_a_suite_reaches_no_further_than_its_folder(tmp_path, monkeypatch, table, line, said):
    (tmp_path / "suite").mkdir()
    monkeypatch.chdir(tmp_path)
    (tmp_path / "elsewhere.toml").write_text("")
    (tmp_path / "suite" / cases.TOML).write_text(f"{table}\n{line}\n")
    with pytest.raises(cases.SuiteError, match=rf"suite\.toml reaches outside of this process: {said}"):
        cases.find(tmp_path / "suite")


def test_a_suite_may_name_the_data_of_an_airframe_in_its_folder(tmp_path):
    (tmp_path / "mine.toml").write_text(vehicles.to_toml(vehicles.load("erle_rover")))
    (tmp_path / cases.TOML).write_text("[[missions]]\nlibrary = 'rover/square'\nframe = 'mine.toml'\n")
    assert [case.frame for case in cases.find(tmp_path)] == [str(tmp_path / "mine.toml")]


@pytest.mark.parametrize("file", ["/etc/hosts", "../*.txt", "link.txt", "*.txt"])
def test_a_suites_missions_lie_in_its_folder(tmp_path, file):
    (tmp_path / "suite").mkdir()
    (tmp_path / "m.txt").write_text("QGC WPL 110\n")
    (tmp_path / "suite" / "link.txt").symlink_to(tmp_path / "m.txt")
    (tmp_path / "suite" / cases.TOML).write_text(f"[[missions]]\nfile = '{file}'\n")
    with pytest.raises(cases.SuiteError, match="reaches outside of this process: file = "):
        cases.find(tmp_path / "suite")


@pytest.mark.parametrize("table", ["[defaults]", "[[missions]]\nlibrary = 'rover/*'"])
@pytest.mark.parametrize("frame", ["theirs.py", "../mine.toml"])
def test_a_suite(tmp_path, table, frame):
    marking(tmp_path)
    text = f"{table}\nframe = {frame!r}\n"
    (tmp_path / cases.TOML).write_text(text)
    with pytest.raises(cases.SuiteError, match=r"suite\.toml " + REFUSED.format("frame")):
        cases.find(tmp_path)
    assert not (tmp_path / "marker").exists()
