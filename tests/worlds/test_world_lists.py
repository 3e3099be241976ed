# SPDX-License-Identifier: BSD-3-Clause
"""Lists of worlds, and ranges of seeds that stand for many."""

import pytest

from sitl import worlds
from sitl.worlds import WorldError


def names(given):
    return [world.name for world in worlds.load_all(given)]


def test_a_range_of_seeds_has_both_its_ends():
    found = worlds.load_all("rooms:seed=3..5,difficulty=0.25")
    assert len(found) == 3 and found.size_of_ranges == 3
    assert [w.name for w in found] == [f"rooms:seed={k},difficulty=0.25,size=20,scale=1" for k in (3, 4, 5)]
    assert found[-1] is worlds.load("rooms:seed=5,difficulty=0.25")
    assert names("labyrinth:size=60,seed=7..7,scale=3") == ["labyrinth:seed=7,difficulty=0.5,size=60,scale=3"]


def test_lists_have_names_ranges_and_worlds():
    own = worlds.World("own", (), worlds.load("open").starts)
    assert names(["maze", "rooms:seed=8..9", own])[:1] == ["maze"]
    found = worlds.load_all(["maze", "rooms:seed=8..9", own])
    assert len(found) == 4 and found[3] is own and [w.name for w in found.loaded] == ["maze", "own"]
    assert [w.name[:12] for w in found[1:3]] == ["rooms:seed=8", "rooms:seed=9"]
    with pytest.raises(IndexError):
        found[4]


def test_worlds_of_a_range_are_made_when_they_are_asked_for():
    found = worlds.load_all("rooms:seed=0..4294967295")
    assert len(found) == 1 << 32
    assert found[-1].name.startswith("rooms:seed=4294967295,")


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ([], "has one at least"),
        ("rooms:seed=5..1", "runs backwards; it is written seed=1..5"),
        ("rooms:seed=a..2", "'a' is no seed"),
        ("rooms:seed=1..", "'' is no seed"),
        ("rooms:seed=-1..2", "'-1' is no seed"),
        ("rooms:seed=1..4294967296", "'4294967296' is no seed"),
        ("rooms:difficulty=0..1", "a range is one of seeds"),
        ("rooms:seed=1..3,colour=2", "'colour' is not known"),
        ("rooms:seed=1..3,difficulty=2", "difficulty must be 0 .. 1"),
        ("rooms:seed=1..3,seed=4..5", "one world has one seed"),
        (["open", 3], "world 3 is neither"),
        (5, "neither a name nor a list"),
        (["open", "nowhere"], "'nowhere' is not known"),
    ],
)
def test_what_cannot_be_says_what_is_allowed(given, why):
    with pytest.raises(WorldError, match=why):
        worlds.load_all(given)


def test_one_world_is_not_named_by_a_range():
    with pytest.raises(WorldError, match="one world has one seed; a range stands for a list of worlds"):
        worlds.load("rooms:seed=1..3")


def test_two_different_worlds_have_two_names():
    start = worlds.load("open").starts
    first, second = worlds.World("own", (), start), worlds.World("own", (), start, friction=0.5)
    with pytest.raises(WorldError, match="two different worlds are called 'own'"):
        worlds.load_all([first, second])
    assert len(worlds.load_all([first, first])) == 2


@pytest.mark.parametrize("text", ["forest:seed=1234567890", "rooms:difficulty=0.123456789012345", "track:size=33.3"])
def test_the_name_of_a_world_makes_the_same_world(text):
    world = worlds.load(text)
    assert worlds.load(world.name) == world
