# SPDX-License-Identifier: BSD-3-Clause
"""What the page of an environment is given: signals, positions, frames, clips; without a browser and without robots."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.core.algebra import euler_of
from sitl.envs.page import source, watchers
from sitl.envs.page.page import EnvPage
from sitl.envs.page.source import EnvSource, SignalError, beside, poses, states
from sitl.envs.page.watchers import Directly, InClips
from sitl.view.layout import GRID, LAYOUTS
from sitl.worlds import World
from sitl.worlds import load as load_world

# ---------------------------------------------------------------- signals


def sourced(observation: Any = None, rewards: Any = (1.0, 2.0), actions: Any = ((0.1, 0.2), (0.3, 0.4))) -> Any:
    found: Any = object.__new__(EnvSource)
    found._session = SimpleNamespace(rewards=np.array(rewards), actions=np.array(actions), varies=False, task=None)
    found._robot = SimpleNamespace(count=2, time=np.array([3.0, 4.0]), scan=np.array([[1.0, 2.0], [3.0, 4.0]]))
    found.chosen, found.layout, found.episode, found.steps, found._total = 0, GRID, 0, 0, 0.0
    found._wanted, found._observation = (), None
    if observation is not None:
        found._observation = observation
    return found


@pytest.mark.parametrize(
    ("observation", "names"),
    [
        (None, []),
        (np.zeros((2, 3)), ["observation[0]", "observation[1]", "observation[2]"]),
        ({"a": np.zeros((2, 1)), "b": np.zeros((2, 2, 1), np.uint8)},
         ["observation.a[0]", "observation.b[0]", "observation.b[1]"]),
        ({"text": np.array([["x"], ["y"]])}, []),
        (np.zeros((2, source._MOST)), [f"observation[{k}]" for k in range(source._MOST)]),
        (np.zeros((2, source._MOST + 1)), []),  # a picture is no curve
    ],
)  # fmt: skip
def test_numbers_can_be_plotted_but_no_pictures(observation: Any, names: list[str]) -> None:
    found = sourced(observation)
    assert found.signal_names() == ["reward", "return", "episode", "action[0]", "action[1]", *names]


def test_signals_are_those_of_the_chosen_robot() -> None:
    found = sourced()
    found.started(0)
    found.started(1)
    found.stepped({"a": np.array([[5.0, 6.0], [7.0, 8.0]])})
    found.stepped({"a": np.array([[5.5, 6.5], [7.5, 8.5]])})
    found.choose_signals(("reward", "return", "episode", "action[1]", "observation.a[1]"))
    assert found._signals(0) == {
        "reward": 1.0, "return": 2.0, "episode": 1.0, "action[1]": 0.2, "observation.a[1]": 6.5,
    }  # fmt: skip
    found.choose(1)
    assert found._signals(1) == {
        "reward": 2.0, "return": 2.0, "episode": 1.0, "action[1]": 0.4, "observation.a[1]": 8.5,
    }  # fmt: skip
    found.started(1)
    assert (found._total, found.episode, found.steps) == (0.0, 2, 2)
    found.started(0)
    assert found.episode == 2, "of the chosen one alone"
    found.choose_signals(("action[0]",))
    with pytest.raises(SignalError, match=r"there is no signal 'action\[2\]' of this environment"):
        found.choose_signals(("reward", "action[2]"))
    assert found._wanted == ("action[0]",), "those before stay"


def test_an_observation_of_one_part_and_none_yet() -> None:
    found = sourced(np.array([[5.0, 6.0], [7.0, 8.0]]))
    found.choose_signals(("observation[1]", "reward"))
    assert found._signals(1) == {"observation[1]": 8.0, "reward": 2.0}
    found._observation = None
    assert found._signals(0) == {"reward": 1.0}


# ---------------------------------------------------------------- what is drawn


def test_positions_are_north_east_down_about_the_bodys_origin() -> None:
    """Of the world's axes (x ahead, y to the left, z up) and a base 0.5 m ahead of the body."""
    state = np.zeros((3, 12))
    state[:, :4] = [(1.0, 2.0, 3.0, 0.0), (1.0, 2.0, 3.0, math.pi / 2), (1.0, 2.0, 3.0, math.pi)]
    pos, attitudes = poses(state, 0.5)
    assert pos == pytest.approx(np.array([(0.5, -2.0, -3.0), (1.0, -1.5, -3.0), (1.5, -2.0, -3.0)]))
    assert attitudes[0] == pytest.approx((1.0, 0.0, 0.0, 0.0))
    assert attitudes[1][3] == pytest.approx(-math.sqrt(0.5)), "to the left is counter-clockwise"


def test_worlds_stand_side_by_side() -> None:
    first, second = load_world("maze"), load_world("car_park:seed=1")
    offsets = np.array([[0.0, 0.0, 0.0], [100.0, -50.0, 0.0]])
    both: World = beside([first, second], offsets)
    assert len(both.solids) == len(first.solids) + len(second.solids)
    assert len(both.markings) == len(first.markings) + len(second.markings)
    assert both.solids[0].centre == pytest.approx(first.solids[0].centre)
    moved = np.subtract(both.solids[-1].centre, second.solids[-1].centre)
    assert moved == pytest.approx((100.0, -50.0, 0.0))
    if second.markings:
        assert np.subtract(both.markings[-1].centre, second.markings[-1].centre) == pytest.approx((100.0, -50.0))
    assert both.floor_z == first.floor_z


@pytest.mark.parametrize(
    ("before", "now", "rolled"),
    [
        ((0, 2.0), (0, 2.5), (0.5 * (2.0 - 0.3), 0.5 * (2.0 + 0.3))),
        ((1, 2.0), (0, 2.5), (0.0, 0.0)),  # another robot
        ((0, 2.5), (0, 2.5), (0.0, 0.0)),
        ((0, 3.0), (0, 2.5), (0.0, 0.0)),  # another episode
        ((0, 2.0), (0, 12.0), (0.0, 0.0)),
        ((0, math.nan), (0, 2.5), (0.0, 0.0)),
    ],
)
def test_wheels_roll_by_what_was_driven_since_the_last_frame(before: Any, now: Any, rolled: Any) -> None:
    found = sourced()
    found._rolled, found._last = np.zeros(2), before
    found._robot.volume = SimpleNamespace(radius=0.25)
    state = np.zeros((2, 12))
    state[0, 7] = 1.2  # turns left [rad/s]
    found._roll(SimpleNamespace(chosen=now[0], time=now[1], state=state), 2.0)
    assert found._rolled.tolist() == pytest.approx(rolled) and found._last == now


@pytest.mark.parametrize(
    ("ranges", "count"), [([], None), ([1.0, 2.0, 5.0], 3), ([1.0, 5.01, math.inf], 1), ([math.nan, 6.0, math.inf], 0)]
)
def test_a_scan_shows_what_it_met(ranges: list[float], count: int | None) -> None:
    found = sourced()
    found._robot.angles, found._robot.range_max, found._lidar = [0.0, 1.0, 2.0][: len(ranges)], 5.0, np.zeros(3)
    shown = found._scan(SimpleNamespace(scan=np.array(ranges)))
    assert (None if shown is None else len(shown)) == count


def test_targets_are_marks_in_their_order_in_the_worlds_place_on_the_grid() -> None:
    found = sourced()
    found._plan = (b"", source.Plan())
    plan = found._planned(np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), np.array([10.0, 0.0, 0.0]))
    assert [(mark.name, tuple(mark.position), mark.number) for mark in plan.items] == [
        ("target 1", (11.0, -2.0, -3.0), 0), ("target 2", (14.0, -5.0, -6.0), 1),
    ]  # fmt: skip
    assert found._planned(np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), np.array([10.0, 0.0, 0.0])) is plan
    assert found._planned(np.array([[1.0, 2.0, 3.0]]), np.zeros(3)) is not plan


@pytest.mark.parametrize(
    ("yaw", "velocity"),
    [
        (0.0, (3.0, -1.0, -0.5)),  # it looks north: left is west
        (math.pi / 2, (-1.0, -3.0, -0.5)),  # to the left of that, west: its left is south
        (math.pi, (-3.0, 1.0, -0.5)),
    ],
)
def test_a_frame_is_in_north_east_down(yaw: float, velocity: Any) -> None:
    """State: x, y, z, yaw counter-clockwise; forward 3, left 1, up 0.5 m/s."""
    found = sourced()
    found._ahead, found._offsets, found._rotors = 0.0, np.array([[0.0, 0.0, 0.0], [100.0, 50.0, 0.0]]), ()
    found._rolled, found._last, found._lidar, found._drawn = np.zeros(2), (0, math.nan), np.zeros(3), None
    found._plan, found._robot.volume = (b"", source.Plan()), SimpleNamespace(radius=0.25)
    found._robot.angles, found._robot.range_max = [0.0, 1.0], 5.0
    state = np.zeros((2, 12))
    state[1, :8] = 10.0, 20.0, 5.0, yaw, 3.0, 1.0, 0.5, 0.0
    captured = source.Captured(1, 2.5, state, np.array([1.0, 9.0]), np.zeros((0, 3)), 4, 7.25, {"reward": 1.0}, ())
    frame = found.frame(captured)
    assert tuple(frame.vel) == pytest.approx(velocity)
    assert tuple(frame.pos) == pytest.approx((110.0, -70.0, -5.0)), "beside the first one's world"
    assert (frame.time_us, frame.mode, frame.signals, frame.company.chosen) == (
        2_500_000, "episode 4", {"reward": 1.0}, 1,
    )  # fmt: skip
    assert dict(frame.facts) == {
        "time": "2.5 s", "return": "7.25", "position (robot)": "10.00, 20.00, 5.00 m", "speed (robot)": "3.16 m/s",
    }  # fmt: skip
    alone = found.frame(captured._replace(chosen=0, state=state[1:]))
    assert alone.company is None and tuple(alone.pos) == pytest.approx((10.0, -20.0, -5.0))


def test_a_robot_that_knows_the_truth_is_drawn_where_it_is() -> None:
    truth = np.arange(24.0).reshape(2, 12)
    robot: Any = SimpleNamespace(count=2, pose=np.ones((2, 4)), velocity=np.full((2, 4), 2.0))
    assert states(robot).tolist() == [[1.0] * 4 + [2.0] * 4 + [0.0] * 4] * 2
    robot.true_state, robot.camera_mount = (lambda: truth), (0.0, 0.0, 0.0, 0.0)
    assert (states(robot) == truth).all() and states(robot) is not truth


@pytest.mark.parametrize(("yaw", "at"), [(0.0, (9.0, -20.0)), (math.pi / 2, (10.0, -19.0)), (math.pi, (11.0, -20.0))])
def test_a_body_is_behind_the_base_that_lies_ahead_of_it(yaw: float, at: Any) -> None:
    state = np.zeros((1, 12))
    state[0, :4] = 10.0, 20.0, 5.0, yaw
    pos, (q,) = poses(state, 1.0)
    assert pos[0].tolist() == pytest.approx((*at, -5.0))
    assert euler_of(q).yaw == pytest.approx(-yaw) or abs(yaw) == math.pi


@pytest.mark.parametrize(
    ("mount", "lidar", "ahead"),
    [((0.1, 0.2, 0.3, 0.4), (0.1, -0.2, -0.3), 0.4), (None, (0.0, 0.0, 0.0), 0.0)],
)
def test_a_lidar_is_drawn_where_the_robot_has_it(mount: Any, lidar: Any, ahead: float) -> None:
    """Forward, left, up of its base, and how far that lies ahead [m]; in the scene right and down."""
    world = load_world("open")
    robot: Any = SimpleNamespace(count=1, world=world, volume=SimpleNamespace(radius=0.2, bottom=0.0, top=0.3))
    if mount is not None:
        robot.camera_mount = mount
    session: Any = SimpleNamespace(robot=robot, task=None)
    found = EnvSource(session, "toy")
    assert found._lidar.tolist() == pytest.approx(lidar) and found._ahead == ahead
    assert (found.stage.title, found.stage.world, found.stage.company) == ("toy", world, ())


def test_a_robots_world_is_drawn_alone_or_with_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Any] = []
    monkeypatch.setattr(source, "beside", lambda worlds, offsets: drawn.append(worlds) or "all")
    found = sourced()
    found._drawn, found._offsets = None, np.zeros((2, 3))

    def world(time: float, worlds: Any, chosen: int = 1) -> Any:
        return found._world(SimpleNamespace(worlds=worlds, chosen=chosen, time=time))

    assert world(0.0, ()) is None and world(0.0, ("a",), 0) == "a" and drawn == []
    assert world(0.0, ("a", "b")) == "all" == world(100.0, ("a", "b")) and drawn == [("a", "b")], "as long as they stay"
    assert world(200.0, ("a", "c")) == "all" and drawn[1:] == [("a", "c")]
    found.layout = next(layout for layout in LAYOUTS if layout != GRID)
    assert world(0.0, ("a", "b")) == "b" and len(drawn) == 2


# ---------------------------------------------------------------- layouts


@pytest.mark.parametrize(("layout", "copies"), [(GRID, "offsets"), (next(x for x in LAYOUTS if x != GRID), None)])
def test_worlds_are_copied_on_a_grid_alone(layout: str, copies: Any) -> None:
    placed: list[Any] = []
    page: Any = object.__new__(EnvPage)
    page.env_source = SimpleNamespace(stage=SimpleNamespace(copies="offsets", company=(1, 2)), layout="?")
    page.scene = SimpleNamespace(place_world=placed.append)
    page.cameras = SimpleNamespace(view="above", choose=placed.append)
    page._lay_out(layout)
    assert page.env_source.layout == layout and placed == [copies, "above"]


@pytest.mark.parametrize(("company", "asked"), [((), 0), ((1, 2), 1)])
def test_one_robot_alone_has_no_layout_to_choose(company: Any, asked: int) -> None:
    added: list[Any] = []
    page: Any = object.__new__(EnvPage)
    page.env_source = SimpleNamespace(stage=SimpleNamespace(company=company))
    page.guarded = lambda function: function
    gui = SimpleNamespace(add_dropdown=lambda *given, **more: added.append((given, more)) or SimpleNamespace(
        on_update=lambda function: None))  # fmt: skip
    page._add_looks(gui)
    assert len(added) == asked and all(more["initial_value"] == GRID for _, more in added)


# ---------------------------------------------------------------- watchers


class Source:
    def __init__(self, company: Any = ()) -> None:
        self.stage, self.chosen, self.steps, self.seen = SimpleNamespace(company=company), 0, 0, []
        self.seen: list[Any] = []

    def started(self, index: int) -> None:
        self.seen.append(("started", index))

    def stepped(self, observations: Any) -> None:
        self.steps += 1
        self.seen.append(observations)

    def capture(self) -> int:
        return self.steps


def in_clips(company: Any = (), wanted: bool = True) -> Any:
    found: Any = object.__new__(InClips)
    found._source, found._taken, found._alone, found.given = Source(company), None, not company, []

    def give(moments: Any) -> None:
        found.given.append(list(moments))
        found.clips.is_wanted = False

    found.clips = SimpleNamespace(is_wanted=wanted, give=give, close=lambda: found.given.append("closed"))
    return found


def test_a_clip_of_one_robot_is_an_episode() -> None:
    found = in_clips()
    found.stepped("before")
    assert found._source.steps == 0, "it waits for an episode"
    assert found.wants_steps()
    found.started(0)
    for k in range(3):
        found.stepped(k)
    assert found.given == []
    found.started(0)
    assert found.given == [[1, 2, 3]] and not found.wants_steps()
    found.stepped("nobody looks")
    found.started(0)
    assert found._source.steps == 3 and len(found.given) == 1
    found.close()
    assert found.given[-1] == "closed"


def test_a_clip_of_many_begins_at_once_and_is_of_three_hundred_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    assert watchers._LENGTH == 300
    monkeypatch.setattr(watchers, "_LENGTH", 4)
    found = in_clips(company=(1, 2))
    found.started(1)
    assert found._source.seen == [], "episodes of the chosen one alone"
    found.started(0)
    for k in range(6):
        found.stepped(k)
    assert found.given == [[1, 2, 3, 4]] and found._source.steps == 4
    found.clips.is_wanted = True
    found.stepped(7)
    found.started(0)
    assert found.given == [[1, 2, 3, 4]], "an episode does not end it"


def test_steps_are_shown_as_they_come_and_the_last_one_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[Any] = []
    clock: list[Any] = []
    monkeypatch.setattr(
        watchers, "Watched", lambda page, time_us: clock.append(time_us) or (lambda: done.append("look"))
    )
    page: Any = SimpleNamespace(
        env_source=Source(), capture=lambda left: done.append(("captured", left)),
        wait_drawn=lambda: done.append("drawn"), close=lambda: done.append("closed"),
    )  # fmt: skip
    watcher = Directly(page, 0.25)
    watcher.started(0)
    watcher.stepped("a")
    watcher.stepped("b")
    assert page.env_source.seen == [("started", 0), "a", "b"] and done == ["look", "look"]
    assert clock[0]() == 500_000, "simulated time of two steps"
    watcher.close()
    assert done[2:] == [("captured", 0.0), "drawn", "closed"]
