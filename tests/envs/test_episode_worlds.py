# SPDX-License-Identifier: BSD-3-Clause
"""Episodes of one environment in several worlds."""

import pickle
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import TimeLimit

from sitl import worlds
from sitl.envs.ids import camel_case
from sitl.envs.navigate import Navigate
from sitl.envs.options import EnvOptionError
from sitl.envs.page.source import EnvSource
from sitl.envs.parts import Height
from sitl.envs.presets import PRESETS, options_of
from sitl.envs.robots.robot import floors_of, world_of
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.envs.starts import ReachableCells
from sitl.envs.targets.among import Among
from sitl.envs.targets.gates import Gates
from sitl.envs.targets.parking import Park
from sitl.envs.targets.waypoints import Waypoints
from sitl.envs.tasks import ReachGoal
from sitl.envs.vector import NavigateVector
from sitl.envs.worlds import TEST, TRAINING, WorldDraw
from sitl.worlds import Box, Start
from tests.envs.vector_equality import same

ROOMS = ["rooms:seed=1", "rooms:seed=2", "maze"]
FEW = "rooms:seed=1..5"
WIDE = "rooms:seed=1..5,size=40,scale=2"
"""With room for rovers."""
HIGH = replace(worlds.load("open"), name="high", floor_z=2.0, starts=(Start("up", (1.0, 0.0, 2.0), 0.0),))
BLOCK = Box((0.0, 0.0, 1.0), (2.0, 2.0, 2.0), name="block")
BLOCKED = replace(worlds.load("open"), name="blocked", solids=(BLOCK,))
COPTER = {"robot": "erle_copter", "take_off": 1.5, "action": "normalised", "observation": ["pose", "scan"]}


def rover(world, **options):
    return Navigate(**{"robot": "erle_rover", "world": world, "observation": ["pose", "scan"], **options})


def copter(world, **options):
    return Navigate(**{**COPTER, "world": world, **options})


def flown(env, seed, steps=6, **options):
    """Observations of an episode, and the world that it is in."""
    seen, info = env.reset(seed=seed, options=options or None)
    env.action_space.seed(seed)
    out = [seen]
    for _ in range(steps):
        seen, _, over, _, info = env.step(env.action_space.sample())
        out.append(seen)
        if over:
            break
    return out, info.get("world")


def test_the_seed_draws_the_world_whichever_episodes_came_before():
    env, later = Navigate(world=FEW), Navigate(world=FEW)
    first = [flown(env, seed) for seed in range(20)]
    again = [flown(later, seed) for seed in reversed(range(20))][::-1]
    assert same(first, again)
    names = [name for _, name in first]
    assert len(set(names)) == 5 and set(names) <= {world.name for world in worlds.load_all(FEW)}
    env.reset(seed=3)
    assert env.world.name == env.unwrapped.robot.world.name == names[3]


@pytest.mark.parametrize("option", [FEW, ["rooms:seed=1", "maze"]])
def test_worlds_are_equally_likely(option):
    draw, rng = WorldDraw(option), np.random.default_rng(5)
    count = 300 * len(worlds.load_all(option))
    drawn = []
    for _ in range(count):
        drawn.append(draw.draw(rng).name)
        rng.random()
    _, counts = np.unique(drawn, return_counts=True)
    assert counts.min() > 240 and counts.max() < 360  # 3.5 standard deviations


def test_the_draw_takes_no_number_from_the_episode():
    one, many = Navigate(world="maze", start="turned"), Navigate(world=ROOMS, start="turned")
    for seed in range(6):
        one.reset(seed=seed), many.reset(seed=seed)
        assert one.robot.pose[0, 3] == many.robot.pose[0, 3]
        assert one.np_random.random() == many.np_random.random()


@pytest.mark.parametrize("make", [Navigate, copter, rover], ids=["turtlebot", "copter", "rover"])
def test_an_episode_is_that_of_an_environment_with_this_world_alone(make):
    names = ["rooms:seed=1", "rooms:seed=2,difficulty=1"]  # both have their start at the origin
    many = make(world=names)
    for name in names[::-1]:
        for seed in (1, 2):
            assert same(flown(many, seed, world=name)[0], flown(make(world=name), seed)[0])


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_vectors_draw_and_tell_as_gymnasiums_do(mode):
    ours = NavigateVector(3, 4, world=ROOMS, autoreset_mode=mode)
    theirs = SyncVectorEnv([lambda: TimeLimit(Navigate(world=ROOMS), 4)] * 3, autoreset_mode=mode)
    assert same(ours.reset(seed=4), theirs.reset(seed=4))
    seen = set()
    ours.action_space.seed(1)
    for _ in range(14):
        actions = ours.action_space.sample()
        a, b = ours.step(actions), theirs.step(actions)
        assert same(a, b)
        seen |= set(a[4]["world"])
        if mode is AutoresetMode.DISABLED and (a[2] | a[3]).any():
            over = {"reset_mask": a[2] | a[3]}
            assert same(ours.reset(options=over)[0], theirs.reset(options=over)[0])
    assert len(seen) == 3


def test_a_vector_of_vehicles_flies_as_each_alone():
    vector = NavigateVector(4, **COPTER, world=ROOMS)
    seen, infos = vector.reset(seed=2)
    alone = [copter(ROOMS) for _ in range(4)]
    each = [env.reset(seed=2 + k) for k, env in enumerate(alone)]
    assert len({info["world"] for _, info in each}) > 1
    assert infos["world"].tolist() == [info["world"] for _, info in each]
    vector.action_space.seed(0)
    for _ in range(5):
        assert same(list(seen), [one for one, *_ in each])
        actions = vector.action_space.sample()
        seen, *_ = vector.step(actions)
        each = [env.step(action) for env, action in zip(alone, actions)]
    assert [env.world.name for env in vector.envs] == [env.world.name for env in alone]


def test_threads_change_no_bit():
    two, one = (NavigateVector(5, **COPTER, world=ROOMS, threads=n) for n in (2, 1))
    assert same(two.reset(seed=1)[0], one.reset(seed=1)[0])
    actions = np.ones((5, 4), np.float32)
    for _ in range(4):
        assert same(two.step(actions)[0], one.step(actions)[0])


@pytest.mark.parametrize("make", [Navigate, copter], ids=["turtlebot", "copter"])
def test_snapshots_keep_the_world(make):
    env = make(world=ROOMS, task=ReachGoal())
    env.reset(seed=1, options={"world": "rooms:seed=2"})
    kept = pickle.loads(pickle.dumps(env.snapshot()))
    assert kept.world == worlds.load("rooms:seed=2").name
    before = [env.step(env.action_space.sample() * 0)[:2] for _ in range(3)]
    env.reset(seed=2, options={"world": "maze"})
    other = make(world=ROOMS, task=ReachGoal())
    other.reset(seed=3, options={"world": "maze"})
    for each in (env, other):
        each.restore(kept)
        assert each.world.name == kept.world
        assert same([each.step(each.action_space.sample() * 0)[:2] for _ in range(3)], before)


@pytest.mark.parametrize("make", [Navigate, copter], ids=["turtlebot", "copter"])
def test_pickled_environments_go_on_in_their_world(make):
    env = make(world=ROOMS)
    env.reset(seed=1, options={"world": "rooms:seed=2"})
    copied = pickle.loads(pickle.dumps(env))
    action = env.action_space.sample() * 0
    assert copied.world == env.world
    for _ in range(3):
        assert same(env.step(action), copied.step(action))
    assert same(env.reset(seed=5), copied.reset(seed=5))


def test_worlds_of_programs_are_in_snapshots():
    env = Navigate(world=["open", HIGH])
    env.reset(options={"world": HIGH})
    assert env.snapshot().world == HIGH
    env.reset(options={"world": "open"})
    assert env.snapshot().world == "open"


def test_snapshots_of_one_world_are_as_before():
    env = Navigate(world="maze")
    _, info = env.reset(seed=1)
    assert env.snapshot().world is None and "world" not in info and "world" not in env.step(0)[4]


def test_floors_starts_and_truth_follow():
    env = copter(["open", HIGH], observation=["height", "true_height", "pose"])
    for world, floor in ((HIGH, 2.0), ("open", 0.0), (HIGH, 2.0)):
        seen, _ = env.reset(seed=1, options={"world": world})
        true = env.unwrapped.robot.true_state()[0]
        assert true[:3] == pytest.approx(worlds.load(world).start().position + np.array([0.0, 0.0, 1.5]), abs=0.5)
        assert true[2] - floor == pytest.approx(seen[1], abs=1e-5) == pytest.approx(1.5, abs=0.3)
        assert seen[0] == pytest.approx(1.5, abs=0.4)


def test_each_robot_is_in_its_own_world_above_its_own_floor():
    """A robot that stays where it was made has one world and one floor."""
    travelling = SimpleNamespace(worlds=[HIGH, BLOCKED], world=HIGH, floors=np.array([2.0, 0.0]))
    assert floors_of(travelling).tolist() == [2.0, 0.0]
    assert [world_of(travelling, k) for k in range(2)] == [HIGH, BLOCKED]
    staying = SimpleNamespace(world=HIGH)
    assert floors_of(staying) == 2.0 and world_of(staying, 1) is HIGH
    for robot, heights in ((travelling, [1.0, 4.5]), (staying, [1.0, 2.5])):
        robot.pose = np.array([(0.0, 0.0, 3.0, 0.0), (0.0, 0.0, 4.5, 0.0)])
        height, out = Height(), np.zeros((2, 1), np.float32)
        height.prepare(SimpleNamespace(robot=robot))
        height.write(out)
        assert out[:, 0].tolist() == heights


def test_contacts_are_with_the_solids_of_the_episodes_world():
    wall = Box((3.0, 0.0, 1.0), (0.2, 20.0, 2.0), name="wall")
    walled = replace(worlds.load("open"), name="walled", solids=(wall,))
    env = rover(["open", walled])
    for world, hits in (("open", False), (walled, True), ("open", False)):
        env.reset(seed=1, options={"world": world})
        over = [env.step(0)[2] for _ in range(30)]
        assert any(over) == hits
        assert np.isfinite(env.unwrapped.robot.scan).any() == hits


def test_gates_are_those_of_the_episodes_world():
    env = rover(["slalom:difficulty=1", "slalom:difficulty=0"], task=Gates(laps=2), observation=["path", "scan"])
    counts = set()
    for seed in range(12):
        _, info = env.reset(seed=seed)
        marked = [m for m in worlds.load(info["world"]).markings if m.name.startswith("gate ")]
        task = env.task
        assert len(task.gates) == len(marked)
        assert task.positions[0, 0, :2] == pytest.approx(marked[0].centre)
        assert task.positions[0, len(marked), :2] == pytest.approx(marked[0].centre)  # the second lap
        assert np.allclose(task.positions[0, 2 * len(marked) - 1 :, :2], marked[-1].centre)
        counts.add(len(marked))
        kept = env.snapshot()
        env.restore(kept)
    assert len(counts) > 1


def test_snapshots_of_a_slalom_are_restored_where_no_longer_one_has_been():
    few = rover(["slalom:seed=1,difficulty=0", "slalom:seed=1,difficulty=1"], task=Gates(), observation=["path"])
    few.reset(options={"world": "slalom:seed=1,difficulty=1"})
    few.reset(options={"world": "slalom:seed=1,difficulty=0"})
    other = rover("slalom:seed=1,difficulty=0", task=Gates(), observation=["path"])
    seen = other.restore(few.snapshot())
    assert same(seen, few.restore(few.snapshot()))


def test_bays_and_waypoints_are_those_of_the_episodes_world():
    env = rover("car_park:seed=1..4", task=Park())
    for seed in range(6):
        _, info = env.reset(seed=seed)
        bays = [m.centre for m in worlds.load(info["world"]).markings if m.name.startswith("bay ")]
        assert tuple(env.task.positions[0, 0, :2].tolist()) in [pytest.approx(bay) for bay in bays]
    env = rover(WIDE, task=Waypoints(3, reachable=True))
    for seed in range(6):
        env.reset(seed=seed)
        cells = ReachableCells(env.robot, env.task.limit, world=env.world)
        assert all(cells.is_free(*place[:2]) for place in env.task.positions[0])


def test_ways_around_solids_are_those_of_the_episodes_world():
    env = rover(WIDE, task=Among())
    for seed in (0, 1, 2, 3):
        _, info = env.reset(seed=seed)
        alone = rover(info["world"], task=Among())
        alone.reset(seed=seed)
        assert env.task.positions[0] == pytest.approx(alone.task.positions[0])
        assert env.task._left[0] == alone.task._left[0] > 0.0


def test_the_arena_ends_where_the_episodes_world_does():
    env = rover(["rooms:seed=1,size=20", "rooms:seed=1,size=60"], task=Waypoints(1))
    for size in (60, 20, 60):
        env.reset(seed=1, options={"world": f"rooms:seed=1,size={size}", "pose": (1.0, 1.0, 0.0)})
        _, high = env.task.arena_at(0)
        assert high[0] == pytest.approx(0.5 * size, abs=0.2)
        assert env.task._high[0, 0] == pytest.approx(0.5 * size + 5.0, abs=0.2)


def test_random_starts_and_goals_are_free_places_of_the_episodes_world():
    env = Navigate(world=ROOMS, start="random", task=ReachGoal())
    for seed in range(8):
        env.reset(seed=seed)
        cells = ReachableCells(env.robot, world=env.world)
        assert cells.is_free(*env.robot.pose[0, :2]) and cells.is_free(*env.task.goals[0])


def test_pictures_show_the_episodes_world():
    options = {"observation": {"depth": "depth", "camera": "camera"}, "world": ROOMS}
    vector = NavigateVector(3, **options)
    seen, infos = vector.reset(seed=0, options={"world": ROOMS})
    assert infos["world"].tolist() == [worlds.load(name).name for name in ROOMS]
    for k, name in enumerate(ROOMS):
        alone, _ = Navigate(**{**options, "world": name}).reset(seed=k)
        assert same(alone["depth"], seen["depth"][k]) and same(alone["camera"], seen["camera"][k])


def test_renderers_draw_the_episodes_world_in_one_size():
    env = Navigate(world=["maze", "rooms:seed=1"], render_mode="rgb_array")
    first = {}
    for name in ("maze", "rooms:seed=1", "maze"):
        env.reset(seed=1, options={"world": name})
        picture = env.render()
        assert same(first.setdefault(name, picture), picture)
    assert first["maze"].shape == first["rooms:seed=1"].shape
    assert not same(first["maze"], first["rooms:seed=1"])


# ---------------------------------------------------------------------- curricula


def test_a_function_draws_worlds_from_any_distribution():
    def harder(rng):
        return f"rooms:seed={rng.integers(10)},difficulty={rng.choice([0.25, 0.75])}"

    env, other = Navigate(world=harder), Navigate(world=harder)
    names = [env.reset(seed=seed)[1]["world"] for seed in range(20)]
    assert names == [other.reset(seed=seed)[1]["world"] for seed in range(20)]
    assert {name.split(",")[1] for name in names} == {"difficulty=0.25", "difficulty=0.75"}


def test_a_curriculum_changes_the_worlds_of_later_episodes():
    env = gym.make("sitl/Navigate-v1", world="rooms:seed=1..20,difficulty=0")
    env.reset(seed=1)
    before = env.unwrapped.world
    env.unwrapped.set_worlds("rooms:seed=1..20,difficulty=1")
    assert env.unwrapped.world is before
    assert "difficulty=0," in env.step(0)[4]["world"]
    assert "difficulty=1," in env.reset()[1]["world"]
    vector = gym.make_vec("sitl/Navigate-v1", 2, world="maze")
    vector.reset(seed=0)
    vector.unwrapped.set_worlds(["rooms:seed=1"])
    assert set(vector.reset()[1]["world"]) == {worlds.load("rooms:seed=1").name}


def test_training_and_test_worlds_have_none_in_common():
    assert TRAINING.keys() == TEST.keys()
    for preset, option in TRAINING.items():
        train, test = (WorldDraw(given[preset])._list for given in (TRAINING, TEST))
        assert len(train) == 200 and len(test) == 100, option
        names = {text for part in train._parts for text in part}
        assert not names & {text for part in test._parts for text in part}


# ---------------------------------------------------------------------- refusals


def refused(why, make, *args, **options):
    with pytest.raises(EnvOptionError, match=why):
        make(*args, **options)


def test_lists_that_cannot_be_are_refused():
    refused("has one at least", Navigate, world=[])
    refused("runs backwards", Navigate, world="rooms:seed=9..1")
    refused("'nowhere' is not known", Navigate, world=["maze", "nowhere"])
    refused("function nothing gave None: .*neither a name", Navigate, world=nothing)


def nothing(rng):
    return None


@pytest.mark.parametrize("make", [Navigate, copter, rover], ids=["turtlebot", "copter", "rover"])
def test_a_world_in_which_the_robot_cannot_start_is_refused(make):
    refused("'?blocked'?.*block|block.*'blocked'", make, world=["rooms:seed=3", BLOCKED])
    env = make(world=["rooms:seed=3", "open"])
    env.reset(seed=1)
    refused("blocked", env.set_worlds, ["open", BLOCKED])
    refused("blocked", env.reset, options={"world": BLOCKED})
    assert env.reset(seed=2)[1]["world"] in (worlds.load("rooms:seed=3").name, "open")


@pytest.mark.parametrize(
    "task",
    [
        partial(Waypoints, places=[(1.0, 0.0, 0.0)]),
        partial(Gates, [(1.0, 0.0, 0.0, 0.0)]),
        partial(Park, [(1.0, 0.0, 0.0)]),
        partial(ReachGoal, (1.0, 0.0)),
    ],
)
def test_places_of_one_world_are_refused_in_several(task):
    refused("was given positions of one world", rover, ["rooms:seed=3", "open"], task=task())
    rover("open", task=task()).reset(seed=1)


def test_worlds_without_what_a_task_needs_are_refused():
    refused("Park: world 'open' has no markings \"bay 1\"", rover, ["car_park:seed=1", "open"], task=Park())
    refused("Gates: world 'open' needs markings", rover, ["slalom:seed=1", "open"], task=Gates())


def test_robots_that_stay_in_one_world_are_refused_in_several():
    class Staying:
        """What a robot of somebody else has: it cannot enter worlds."""

        def __init__(self, world=None, count=1):
            self._own = Turtlebot(world, count)

        def __getattr__(self, name):
            if name in ("worlds", "floors", "enter"):
                raise AttributeError(name)
            return getattr(self._own, name)

    refused("robot 'turtlebot' stays in the world 'maze'", Navigate, robot=Staying, world=["maze", "open"])
    Navigate(robot=Staying, world="maze").reset(seed=1)


def test_reset_options_are_checked():
    env = Navigate(world=ROOMS)
    refused("'nowhere' is not known", env.reset, options={"world": "nowhere"})
    vector = NavigateVector(2, world=ROOMS)
    refused("3 worlds for num_envs = 2", vector.reset, options={"world": ROOMS})


# ---------------------------------------------------------------------- the page


def test_frames_of_the_page_have_the_episodes_world():
    env = Navigate(world=ROOMS)
    source = EnvSource(env.session, "many")
    env.reset(seed=1, options={"world": "rooms:seed=2"})
    assert source.frame(source.capture()).world is env.world
    env.reset(seed=1, options={"world": "maze"})
    assert source.frame(source.capture()).world is env.world is worlds.load("maze")
    alone = Navigate(world="maze")
    alone.reset(seed=1)
    source = EnvSource(alone.session, "one")
    assert source.frame(source.capture()).world is None


def test_frames_of_many_robots_have_their_worlds_side_by_side():
    vector = NavigateVector(2, world=ROOMS)
    source = EnvSource(vector.session, "many")
    vector.reset(seed=1, options={"world": ["maze", "rooms:seed=1"]})
    drawn, offsets = source.frame(source.capture()).world, source.stage.copies
    solids = [*worlds.load("maze").solids, *worlds.load("rooms:seed=1").solids]
    assert len(drawn.solids) == len(solids)
    assert drawn.solids[0].centre == pytest.approx(solids[0].centre + offsets[0])
    assert drawn.solids[-1].centre == pytest.approx(solids[-1].centre + offsets[1])
    source.layout, source.chosen = "", 1
    assert source.frame(source.capture()).world is worlds.load("rooms:seed=1")


AMONG = {"sitl/" + camel_case(preset): preset for preset in TRAINING}


@pytest.mark.parametrize("name", AMONG)
def test_tasks_among_solids_are_in_many_worlds_and_their_first_versions_in_one(name):
    for form in ("", "Discrete"):
        env = gym.make(f"{name}{form}-v1").unwrapped
        assert env.session.worlds.text == TRAINING[AMONG[name]] and env.session.varies
    with pytest.warns(DeprecationWarning, match="out of date"):
        first = gym.make(f"{name}-v0").unwrapped
    assert "seed=1" in first.world.name and not first.session.varies


def test_what_belongs_to_one_world_is_in_that_of_the_first_version():
    one = PRESETS["rover-parking"]()["world"]
    there = {"connection": "udp:127.0.0.1:14551"}, {"gcs": "udpout:127.0.0.1:1"}
    for given in (*there, {"task": Waypoints(places=[(1.0, 2.0, 0.0)])}, {"robot": lambda world, count: None}):
        assert options_of("rover-parking-v1", given)["world"] == one, given
        assert options_of("rover-parking-v1", {**given, "world": "maze"})["world"] == "maze"
    here = {"connection": "inprocess", "autopilot": "native", "gcs": None}
    for given in ({}, here, {"autopilot": "ardupilot:x"}, {"task": Among()}):
        assert options_of("rover-parking-v1", given)["world"] == TRAINING["rover-parking"]
