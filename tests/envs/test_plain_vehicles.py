# SPDX-License-Identifier: BSD-3-Clause
"""What all vehicles of environments have in common, whatever is behind their connections; without any vehicle."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs.mavlink import px4
from sitl.envs.mavlink.preparation import INTERVAL_US
from sitl.envs.options import EnvOptionError
from sitl.envs.robots import vehicles as module
from sitl.envs.robots.vehicles import EpisodeState, Vehicles


class Link:
    """A connection that counts how often it is closed."""

    def __init__(self, origin: Any = None) -> None:
        self.closed, self.inbox, self.name = 0, SimpleNamespace(origin=origin, system=1), "a link"

    def close(self) -> None:
        self.closed += 1


class Plain(Vehicles):
    """Vehicles at a connection."""

    where = "tcp:1"

    def begin(self, index: int, pose: Any, seed: int) -> EpisodeState:
        raise NotImplementedError

    def time_us(self, index: int) -> int:
        return 1000 * (index + 7)


def plain(count: int = 3, takes_off: bool = True, guided: int = 4, prepares: Any = None, **options: Any) -> Any:
    found: Any = Plain.__new__(Plain)
    kind = SimpleNamespace(takes_off=takes_off, guided=guided, prepares=prepares)
    found.setup = SimpleNamespace(count=count, kind=kind, world=SimpleNamespace(name="maze"))
    found.options = SimpleNamespace(take_off=2.5, home=(47.0, 8.0, 400.0, 0.0), **options)
    found.worlds = [SimpleNamespace(floor_z=float(k)) for k in range(count)]
    found.links = [None] * count
    return found


def test_closing_closes_each_connection_once_and_forgets_it() -> None:
    found = plain()
    first, last = Link(), Link()
    found.links = [first, None, last]
    found.close()
    found.close()
    assert (first.closed, last.closed) == (1, 1) and found.links == [None, None, None]


@pytest.mark.parametrize(
    ("what", "says"),
    [
        (lambda found: found.enter(0, SimpleNamespace(name="open")),
         "world 'open': a vehicle of tcp:1 stays in the world 'maze'"),
        (lambda found: found.snapshot(0, None), "tcp:1: only vehicles in process have snapshots"),
        (lambda found: found.restore(0, None), "tcp:1: only vehicles in process have snapshots"),
        (lambda found: found.simulation(0), "tcp:1: only vehicles in process can be looked into"),
        (lambda found: found.view(0), "tcp:1: only vehicles in process can be looked into"),
        (lambda found: found.physics(0), "tcp:1: only vehicles in process can be looked into"),
        (lambda found: found.true_states(0.0, np.zeros((3, 12))), "tcp:1: only vehicles in process can be looked into"),
        (lambda found: found.true_reports(np.zeros((3, 9))), "tcp:1: only vehicles in process can be looked into"),
    ],
)  # fmt: skip
def test_a_vehicle_elsewhere_refuses_what_needs_its_simulation(what: Any, says: str) -> None:
    with pytest.raises(EnvOptionError, match=says):
        what(plain())


def body(down: float) -> Any:
    """Physics of one vehicle that moves up, level, looking north."""
    still = np.zeros((1, 3))
    return {
        "body": {"pos": np.array([[1.0, 2.0, down]]), "vel": np.array([[0.0, 0.0, -0.5]]), "rates": still,
                 "q": np.array([[1.0, 0.0, 0.0, 0.0]]), "specific_force": np.array([[0.0, 0.0, -9.8]])},
        "wind": {"vel": still},
        "battery": {"voltage": np.array([12.5]), "current": np.array([3.0]), "charge": np.array([0.75])},
    }  # fmt: skip


def test_the_truth_of_each_vehicle_is_above_the_floor_of_its_world() -> None:
    """Bodies count from the floor; where there is no body yet, nothing is written."""
    found = plain()
    found.physics = lambda index: None if index == 1 else body(-3.0)
    out = np.full((3, 12), 9.0)
    found.true_states(0.5, out)
    assert out[0, :7].tolist() == pytest.approx([1.5, -2.0, 3.0, 0.0, 0.0, 0.0, 0.5])
    assert out[2, :3].tolist() == pytest.approx([1.5, -2.0, 3.0 + 2.0]) and (out[1] == 9.0).all()
    reports = np.full((3, 9), 9.0)
    found.true_reports(reports)
    assert reports[0].tolist() == pytest.approx([0.0, 0.0, 9.8, 12.5, 3.0, 0.75, 0.0, 0.0, 0.0])
    assert reports[2].tolist() == reports[0].tolist() and (reports[1] == 9.0).all()


def test_physics_are_of_the_vehicle_in_its_simulation() -> None:
    found = plain()
    fleet = np.zeros(4, [("physics", "i8")])
    fleet["physics"] = [10, 11, 12, 13]
    found.simulation = lambda index: SimpleNamespace(fleet=fleet, index=index + 1, v="its record")
    assert found.physics(2).tolist() == [13] and found.physics(0).tolist() == [11] and found.view(0) == "its record"


@pytest.mark.parametrize(("takes_off", "height"), [(True, 2.5), (False, 0.0)])
@pytest.mark.parametrize("by", ["prepare", "px4", "its own"])
def test_preparing_says_where_the_vehicles_local_origin_is(
    monkeypatch: pytest.MonkeyPatch, takes_off: bool, height: float, by: str
) -> None:
    """A ten-thousandth of a degree north is 11.1 m, and east, at 47 degrees, 7.6 m; the world's z is the start's."""
    asked: list[Any] = []
    monkeypatch.setattr(module, "prepare", lambda link, guided, take_off, hold: asked.append(("prepare", take_off)))
    monkeypatch.setattr(px4, "prepare", lambda link, take_off: asked.append(("px4", take_off)))
    own = (lambda link, take_off: asked.append(("its own", take_off))) if by == "its own" else None
    found = plain(takes_off=takes_off, guided=px4.OFFBOARD if by == "px4" else 4, prepares=own)
    link = Link(origin=(470001000, 79999000, 0))
    north, east, down = found.prepare(link, (5.0, 6.0, 1.5, 0.0))
    assert (north, east) == pytest.approx((11.13, -7.59), abs=0.03) and down == -1.5
    assert asked == [(by, height)]


def test_an_episode_begins_now_without_a_set_point() -> None:
    assert plain().begun(2, (1.0, 2.0, 3.0)) == EpisodeState(None, None, (1.0, 2.0, 3.0), 9000, "", INTERVAL_US)
