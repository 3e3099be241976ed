# SPDX-License-Identifier: BSD-3-Clause
"""What ``sitl/Navigate-v1`` refuses: options, actions, starts and snapshots that cannot be, each by name."""

from __future__ import annotations

import dataclasses
import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import DependencyNotInstalled, InvalidAction, ResetNeeded

from sitl import vehicles, worlds
from sitl.envs import EnvOptionError
from sitl.envs.actions import DRIVE, VELOCITY, Continuous, Discrete
from sitl.envs.observations import Digits
from sitl.envs.options import COMMON
from sitl.envs.rewards import Nearness
from sitl.envs.session import NavigateOptions
from sitl.envs.tasks import ReachGoal, Task
from sitl.envs.vector import NavigateVector
from sitl.vehicles.turtlebot import Lidar

NAVIGATE = "sitl/Navigate-v1"


def make(**options):
    return gym.make(NAVIGATE, **options).unwrapped


@pytest.mark.parametrize("action", [3, -1, 1.5, None, "0", [0, 1], np.array([0.0])])
def test_actions_outside_of_a_table_are_refused(action):
    env = make()
    env.reset()
    with pytest.raises(InvalidAction, match=r"not in Discrete\(3\): 0 forward, 1 left, 2 right"):
        env.step(action)


@pytest.mark.parametrize("action", [[0.1], [math.nan, 0.0], 1, "ab", None, [0.1, 0.1, 0.1]])
def test_actions_outside_of_a_box_are_refused(action):
    env = make(action="continuous")
    env.reset()
    with pytest.raises(InvalidAction, match=r"forward \[m/s\] 0 .. 0.3, turn \[rad/s\] -0.3 .. 0.3"):
        env.step(action)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"robot": "turtelbot"}, r"robot 'turtelbot' is not known; .*did you mean 'turtlebot'"),
        ({"robot": 3}, r"robot 3 is neither a name"),
        (
            {"robot": "erle_copter", "frame": "erle_rover"},
            r"airframe erle_rover is a rover; those of a copter are erle",
        ),
        ({"world": "moon"}, r"world 'moon' is not known; it is one of circuit"),
        ({"task": "wonder"}, r"task 'wonder' .*did you mean 'wander'"),
        ({"task": Task}, r"task .* nor an object with judge"),
        ({"observation": "smell"}, r"observation 'smell' is not known; it is one of digits, scan"),
        ({"action": "jump"}, r"action 'jump' is not known; it is one of discrete, continuous"),
        ({"action": 3}, r"action 3 is neither a name"),
        ({"action": Continuous(VELOCITY, (0,) * 4, (1,) * 4)}, r"action gives 'velocity'; turtlebot takes drive"),
        ({"setpoint": "velocity"}, r"setpoint 'velocity': turtlebot takes drive"),
        ({"setpoint": "drives"}, r"setpoint 'drives' .* did you mean 'drive'"),
        ({"step_time": 0.0}, r"step_time = 0.0; it must be above 0 s, at most 3600 s, and a whole number of 0.01 s"),
        ({"step_time": 0.123}, r"step_time = 0.123"),
        ({"step_time": math.nan}, r"step_time = nan"),
        ({"step_time": "fast"}, r"step_time = 'fast'"),
        ({"start": "pole"}, r"start 'pole': .*original.* and \"random\""),
        ({"start": (1.0,)}, r"start: pose \(1.0,\)"),
        ({"randomise": {"range_nois": (0, 1)}}, r"property 'range_nois' .* did you mean 'range_noise'"),
        ({"randomise": {"range_noise": (0.2, 0.1)}}, r"range_noise = \(0.2, 0.1\); it must be low <= high within 0"),
        ({"randomise": {"range_noise": 0.1}}, r"range_noise = 0.1; it must be \(low, high\) or a function"),
        ({"lidr": None}, r"option 'lidr' is not known; it is one of airframe, lidar, physics, .*did you mean 'lidar'"),
        ({"wrld": "maze"}, r"option 'wrld' .*did you mean 'world'"),
        ({"render_mode": "ascii"}, r"render_mode 'ascii' is not known"),
        ({"info": None}, r"info = None; it must be names of rewards, true_pose, estimate_error, events"),
        ({"robot": "erle_rover", "start": (1e9, 0.0, 0.0)}, r"start: north = 1000000000.*-100000 .. 100000 m"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*render_mode.*")
def test_wrong_options_are_named_with_what_is_allowed(options, message):
    with pytest.raises(EnvOptionError, match=message):
        gym.make(NAVIGATE, **options)


def test_a_single_environment_has_no_reset_mask():
    with pytest.raises(EnvOptionError, match="'reset_mask' is for vector environments only"):
        make().reset(options={"reset_mask": np.array([True])})


def test_the_options_that_messages_list_are_those_that_there_are():
    assert [field.name for field in dataclasses.fields(NavigateOptions)] == [*COMMON, "robot_options"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Task(["speed"]), r"reward 'speed' is not known; it is one of forward"),
        (lambda: Task([3]), r"reward 3 is neither"),
        (lambda: Task(crash_range=-1.0), r"crash_range = -1.0"),
        (lambda: ReachGoal((1.0, math.nan)), r"goal = "),
        (lambda: ReachGoal(radius=0.0), r"radius = 0.0"),
        (lambda: Digits(parts=0), r"parts=0"),
        (lambda: Nearness(0.0), r"distance=0.0"),
        (lambda: Discrete(DRIVE, {"go": (1.0,)}), r"action 'go' = \(1.0,\); it must be 2 finite numbers"),
        (lambda: Discrete(DRIVE, {}), r"needs a row"),
        (lambda: Continuous(DRIVE, (0.0,), (1.0, 1.0)), r"are not 2 numbers"),
        (lambda: Continuous(DRIVE, (0.0, 1.0), (1.0, 1.0)), r"less than"),
    ],
)
def test_wrong_properties_of_pieces_are_named(call, message):
    with pytest.raises(EnvOptionError, match=message):
        call()


def test_foreign_snapshots_are_refused():
    env = make()
    env.reset()
    with pytest.raises(EnvOptionError, match="no snapshot"):
        env.restore(3)
    other = make(lidar=Lidar(10, 10, 1.0))
    other.reset()
    with pytest.raises(EnvOptionError, match="snapshot"):
        env.restore(other.snapshot())


@pytest.mark.parametrize("step_time", [1e-9, 1e-8, 0.600001, np.float32(0.605), 1e300])
def test_step_time_that_is_no_whole_number_of_ticks_is_refused(step_time):
    with pytest.raises(EnvOptionError, match=r"step_time = .* a whole number of 0.01 s"):
        make(step_time=step_time)


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        (
            "randomise",
            "none",
            r"randomise = 'none'; it must map properties to \(low, high\), or be 'identified' or None",
        ),
        ("randomise", 1.5, r"randomise = 1.5; it must map"),
        ("setpoint", ["rc"], r"setpoint \['rc'\] is not known; it is one of"),
        ("action", {"ahead": 1}, r"action 'ahead' = 1; it must be 2 finite numbers"),
        ("action", {"ahead": "ab"}, r"action 'ahead' = 'ab'; it must be 2 finite numbers"),
    ],
)
def test_options_of_another_kind_are_refused(option, value, message):
    with pytest.raises(EnvOptionError, match=message):
        make(**{option: value})


PILLAR = worlds.World(
    "pillar", (worlds.Cylinder((0.0, 0.0, 0.5), 0.5, 1.0, "post"),), (worlds.Start("o", (0.0, 0.0, 0.0), 0.0),)
)


def test_starts_inside_of_solids_are_refused():
    with pytest.raises(EnvOptionError, match=r"start: \(0, 0, 0\) in world 'pillar' is inside of cylinder 'post'"):
        make(world=PILLAR)
    with pytest.raises(EnvOptionError, match=r"turtlebot has no room at start 'o'"):
        make(world=PILLAR, start="random")
    env = make(world=PILLAR, start=lambda rng: (0.4, 0.0, 0.0))
    with pytest.raises(EnvOptionError, match="inside of"):
        env.reset()
    env = make(world=PILLAR, start=(2.0, 0.0, 0.0))
    env.reset()
    with pytest.raises(EnvOptionError, match="inside of"):
        env.reset(options={"pose": (0.0, 0.3, 0.0)})


def test_reset_options_that_are_not_known_are_named():
    with pytest.raises(
        EnvOptionError, match=r"reset: option 'psoe' is not known; it is one of pose, world; did you mean"
    ):
        make().reset(options={"psoe": (0.0, 0.0, 0.0)})


def test_reward_by_action_needs_a_table():
    with pytest.raises(EnvOptionError, match="needs a table of actions"):
        make(task="paper", action="continuous")


def test_a_class_of_actions_is_no_action():
    with pytest.raises(EnvOptionError, match="nor an Action"):
        make(action=Discrete)


@pytest.mark.parametrize("columns", [(2,), (-1,)])
def test_columns_of_actions_are_those_of_the_setpoint(columns):
    with pytest.raises(EnvOptionError, match=r"columns .* 0 \.\. 1"):
        Continuous(DRIVE, (0.0,), (1.0,), columns)


def test_snapshot_of_another_task_is_refused():
    env, other = make(task="goal"), make()
    env.reset(seed=1), other.reset(seed=1)
    with pytest.raises(EnvOptionError, match="a task without a goal"):
        env.restore(other.snapshot())


@pytest.mark.parametrize(
    ("robot", "world"),
    [("turtlebot", "circuit2"), ("erle_rover", "maze_erlerover"), ("erle-copter", "office_erlecopter")],
)
def test_each_robot_has_a_world_that_it_has_room_in(robot, world):
    env = gym.make(NAVIGATE, robot=robot)
    assert env.unwrapped.world.name == world
    env.reset(seed=1)
    assert not env.unwrapped.task.limit > env.unwrapped.robot.scan.min()
    env.close()


@pytest.mark.parametrize("name", [NAVIGATE, "sitl/CopterHover-v0"])
def test_a_step_before_the_first_reset_is_refused(name):
    env = gym.make(name).unwrapped
    with pytest.raises(ResetNeeded, match=r"before the first reset\(\)"):
        env.step(env.action_space.sample())
    env.reset(seed=1)
    snapshot = env.snapshot()
    other = gym.make(name).unwrapped
    other.restore(snapshot)
    other.step(other.action_space.sample())
    env.close()
    other.close()


def test_a_vector_that_was_refused_while_it_was_made_closes_in_silence(recwarn, capfd):
    NavigateVector.__new__(NavigateVector).close()  # as older Gymnasiums do when it is deleted
    assert not recwarn.list and capfd.readouterr() == ("", "")


def test_a_window_needs_a_screen(monkeypatch, capfd):
    pytest.importorskip("pygame")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    env = gym.make(NAVIGATE, render_mode="window")
    says = r'render_mode "window" finds no screen .*; "rgb_array" needs none'
    with pytest.raises(DependencyNotInstalled, match=says):
        env.reset(seed=1)
    env.close()
    assert "XDG_RUNTIME_DIR" not in capfd.readouterr().err


@pytest.mark.parametrize("start", ["turned", "random"])
def test_a_vehicle_at_a_connection_starts_where_it_is(start):
    with pytest.raises(EnvOptionError, match=f"start '{start}': a vehicle at a connection.*--option start=original"):
        gym.make("GazeboMazeErleRoverLIDAR-v0", connection="udpout:127.0.0.1:9", start=start)


def test_a_vehicle_at_a_connection_keeps_its_own_wind():
    env = gym.make("sitl/CopterHover-v0", connection="udpout:127.0.0.1:9")
    assert not env.unwrapped.session.randomisation.ranges
    with pytest.raises(EnvOptionError, match="randomise: property 'wind_speed' is not known"):
        gym.make("sitl/CopterHover-v0", connection="udpout:127.0.0.1:9", randomise={"wind_speed": (0.0, 5.0)})


def test_a_misspelt_name_of_many_is_answered_with_the_one_that_is_meant() -> None:
    with pytest.raises(EnvOptionError) as error:
        gym.make("GazeboOfficeErleCopterLIDAR-v0", randomise={"wind_sped": (0.0, 5.0)})
    assert str(error.value) == "randomise: property 'wind_sped' is not known; did you mean 'wind_speed'?"
    with pytest.raises(EnvOptionError, match=r"'zzz' is not known; it is one of .*wind_speed"):
        gym.make("GazeboOfficeErleCopterLIDAR-v0", randomise={"zzz": (0.0, 5.0)})


@pytest.mark.parametrize("robot", ["turtlebot", "erle_copter"])
def test_an_unknown_option_is_an_unexpected_argument_in_pythons_words_too(robot):
    """TorchRL offers each environment a ``frameskip``, and goes without where this is what it hears."""
    with pytest.raises(TypeError, match=r"option 'frameskip' is not known.*unexpected keyword argument 'frameskip'"):
        gym.make("sitl/Navigate-v1", robot=robot, frameskip=1)


def test_the_file_of_another_kind_of_vehicle_is_named(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(vehicles.to_toml(vehicles.load("erle_copter")))
    for options in ({}, {"randomise": "identified"}):
        with pytest.raises(
            EnvOptionError, match=r"airframe file '.*mine\.toml' is a copter; those of a rover are erle_"
        ):
            gym.make("sitl/RoverWaypoint-v1", frame=str(path), **options)
