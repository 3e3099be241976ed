# SPDX-License-Identifier: BSD-3-Clause
"""Changes and plans: what they make of an environment, what they refuse, that the shipped ones fit their robots."""

from __future__ import annotations

import gymnasium as gym
import pytest

import sitl.envs  # noqa: F401 (registers the environments)
from sitl import worlds
from sitl.agents import environments
from sitl.agents.errors import AgentError
from sitl.agents.rehearsal import plan as plans
from sitl.agents.rehearsal.change import Change, altered
from sitl.agents.runs.config import RunConfig

ENVIRONMENTS = {
    "turtlebot": "GazeboCircuit2TurtlebotLIDAR-v0",
    "rover": "GazeboMazeErleRoverLIDAR-v0",
    "copter": "GazeboOfficeErleCopterLIDAR-v0",
}


@pytest.fixture(scope="module")
def turtlebot():
    return gym.make(ENVIRONMENTS["turtlebot"]).unwrapped.robot


def change(**values):
    return Change.of({"name": "x", "group": "vehicle", **values})


def write(path, text):
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_shipped_plans_fit_their_robots(name):
    plan = plans.load(name)
    env = gym.make(ENVIRONMENTS[name]).unwrapped
    assert plans.plan_for(env.robot.name).name == name
    groups = {one.group for one in plan.changes}
    assert {"world", "physics", "vehicle", "sensors", "latency", "together"} <= groups
    config = RunConfig(ENVIRONMENTS[name], "qlearn", versions={})
    for one in plan.changes:
        if one.group != "physics":
            environments.make(config, **one.env_options(env.robot, {})).close()
    drawn = plan.randomisation(env.robot)
    environments.make(config, randomise=drawn).close()
    assert "latency" in drawn and any(name.endswith("noise") for name in drawn)


def test_properties_are_scaled_and_set(turtlebot):
    one = change(scale={"wheel_radius_left": 1.05}, set={"range_noise": 0.02}, latency=0.2)
    options = one.env_options(turtlebot, {"start": "random"})
    assert options["randomise"] == {"wheel_radius_left": (0.03696, 0.03696), "range_noise": (0.02, 0.02)}
    assert (options["latency"], options["start"]) == (0.2, "random")


def test_a_mirrored_world_has_left_and_right_changed():
    world, other = worlds.load("circuit2"), altered("circuit2", mirror=True)
    x0, y0, x1, y1 = world.bounds
    assert other.bounds == pytest.approx((x0, -y1, x1, -y0)) and other.name == "circuit2 mirrored"
    again = altered(other, mirror=True)
    assert [solid.footprint().tolist() for solid in again.solids] == [s.footprint().tolist() for s in world.solids]


def test_a_stretched_world_is_larger_and_as_high():
    world, other = worlds.load("office_erlecopter"), altered("office_erlecopter", stretch=1.5)
    assert other.bounds == pytest.approx([1.5 * b for b in world.bounds])
    assert [s.high for s in other.solids] == [s.high for s in world.solids]
    assert other.start("erle_copter").yaw == world.start("erle_copter").yaw


@pytest.mark.parametrize(
    "values, text",
    [
        ({"group": "vehicles"}, "group = 'vehicles'; it is one of world"),
        ({"scal": {}}, "did you mean 'scale'"),
        ({"latency": -1}, "latency = -1; it must be a number from 0 on"),
        ({"set": {"range_noise": "much"}}, "set.range_noise = 'much'; it must be a number"),
        ({"set": {"inertia": [1.0, "x"]}}, "set.inertia = .* it must be a number, or a list"),
        ({"identified": 1}, "identified = 1; it must be true or false"),
        ({"scale": {"mass": 1.1}, "options": {"frame": "f.toml"}}, "scale is of the robot at home"),
        ({"scale": 1.1}, "scale = 1.1; it must be a table"),
        ({"scale": {"mass": 1.1}, "set": {"mass": 2.0}}, "property 'mass' is both scaled and set"),
        ({"stretch": 0}, "stretch = 0; it must be a number from 0.1"),
        ({"mirror": 1}, "mirror = 1; it must be true or false"),
        ({"episodes": 0}, "episodes = 0"),
        ({"options": {"latency": 1}}, "latency has keys of its own"),
        ({"mirror": True, "options": {"world": "maze"}}, "world has keys of its own"),
    ],
)
def test_wrong_changes_are_refused(values, text):
    with pytest.raises(AgentError, match=text):
        change(**values)


def test_properties_that_the_robot_lacks_are_refused(turtlebot):
    with pytest.raises(AgentError, match="no property 'wheel_radius_lef'; did you mean 'wheel_radius_left'"):
        change(scale={"wheel_radius_lef": 1.1}).env_options(turtlebot, {})


def test_what_is_drawn_at_home_is_drawn_under_a_change(turtlebot):
    wind = {"wind_speed": (0.0, 5.0)}
    options = change(set={"mass": 2.0}).env_options(turtlebot, {}, wind)
    assert options["randomise"] == {**wind, "mass": (2.0, 2.0)}
    assert "randomise" not in change(latency=0.1).env_options(turtlebot, {}, wind)
    identified = change(identified=True, set={"inertia": [1.0, 1.0, 2.0]}).env_options(turtlebot, {}, wind)
    vector = [1.0, 1.0, 2.0]
    assert identified["randomise"] == {**wind, "identified": True, "inertia": (vector, vector)}


ONE = '[[change]]\nname = "a"\ngroup = "sensors"\n'


@pytest.mark.parametrize(
    "text, message",
    [
        ("", "it has no change"),
        (ONE + ONE, "two changes are called 'a'"),
        ("chnage = 1\n" + ONE, "did you mean 'change'"),
        ("change = 1", "write each as"),
        ('robots = "turtlebot"\n' + ONE, "must be a list of names"),
        (ONE + "[randomise]\nlatency = 0.2", r"randomise.latency = 0.2; it must be \[low, high\]"),
        (ONE + "[randomise.scale]\nmass = [1.1, 0.9]", r"randomise.scale.mass = \[1.1, 0.9\]"),
        (ONE + "[training]\nrecpie = 1", "did you mean 'recipe'"),
        ("a = ", "plan"),
    ],
)
def test_wrong_plans_are_refused_with_their_file(tmp_path, text, message):
    with pytest.raises(AgentError, match=message) as raised:
        plans.load(write(tmp_path / "mine.toml", text))
    assert "mine.toml" in str(raised.value)


def test_plans_that_are_not_there(tmp_path):
    with pytest.raises(AgentError, match="one of copter, rover, turtlebot"):
        plans.load("boat")
    with pytest.raises(AgentError, match="there is no plan"):
        plans.load(tmp_path / "none.toml")
    with pytest.raises(AgentError, match="there is no plan for robot 'boat'"):
        plans.plan_for("boat")


def test_changes_are_chosen_by_name_or_group():
    plan = plans.load("rover")
    assert "physics pybullet" not in {one.name for one in plan.chosen()}
    assert [one.name for one in plan.chosen(["physics pybullet"])] == ["physics pybullet"]
    assert {one.group for one in plan.chosen(["latency"])} == {"latency"}
    with pytest.raises(AgentError, match="did you mean 'mass"):
        plan.chosen(["mass + 20 %"])
    slow = plans.Plan("slow", (change(name="bullet", by_default=False),))
    assert [one.name for one in slow.chosen(["bullet"])] == ["bullet"]
    with pytest.raises(AgentError, match="no change that is tried by default; name some of bullet"):
        slow.chosen()
