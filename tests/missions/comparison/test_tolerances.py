# SPDX-License-Identifier: BSD-3-Clause
"""Tolerances: presets, files over them, and errors that name the key."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from sitl.missions.comparison.tolerance import PRESETS, ToleranceError, load


@pytest.mark.parametrize("name", [name for name in PRESETS if name != "exact"])
@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_presets_judge_the_way_of_both_vehicles(name: str, kind: str) -> None:
    tolerance = load(name, kind)
    assert 0.0 < tolerance.limit("cross_track.rms") < tolerance.limit("cross_track.max") < 5.0
    assert math.isfinite(tolerance.limit("items.time"))


def test_a_file_says_only_what_is_otherwise(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('base = "alike"\nalign = "armed"\n[cross_track]\nmax = 0.25\n[rover.speed]\nmax = false\n')
    copter, rover, alike = load(path), load(path, "rover"), load("alike")
    assert copter.align == "armed"
    assert copter.limit("cross_track.max") == rover.limit("cross_track.max") == 0.25
    assert copter.limit("cross_track.rms") == alike.limit("cross_track.rms")
    assert copter.limit("speed.max") == alike.limit("speed.max")
    assert rover.limit("speed.max") == math.inf


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_exactly_leaves_no_room(kind: str) -> None:
    exact = load("exact", kind)
    assert exact.bits and exact.numbers and not exact.ignore
    assert {name for name, limit in exact.limits.items() if limit != 0.0} == {"delay.rms"}, "a delay has no RMS"
    assert not load("same").bits and load({"base": "exact"}).bits and not load({"base": "exact", "bits": False}).bits


@pytest.mark.parametrize(
    ("text", "metres"), [("0.5 m", 0.5), ("2 cm", 0.02), ("1mm", 0.001), (".5 m", 0.5), ("3 m", 3.0)]
)
def test_a_distance_is_a_tolerance(text: str, metres: float) -> None:
    near, alike = load(text), load("alike")
    for name in ("position", "cross_track", "altitude"):
        assert near.limit(f"{name}.max") == pytest.approx(metres) and near.limit(f"{name}.rms") == math.inf
    assert near.limit("heading.max") == alike.limit("heading.max") and near.limit("items.time") == 6.0
    assert near.name == text and not near.bits


@pytest.mark.parametrize("text", ["0.5", "5 ft", "-1 m", "m", "1 m 2", "nan m"])
def test_what_is_no_distance_is_refused_with_what_is_one(text: str) -> None:
    with pytest.raises(ToleranceError, match=r"no distance with its unit such as '0\.5 m' or '2 cm'"):
        load(text)


def test_the_tolerance_of_the_documentation_is_one(tmp_path: Path) -> None:
    page = (Path(__file__).parents[3] / "docs" / "regression.md").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(page.split("```toml\n")[1].split("```")[0])
    assert load(path).limit("cross_track.max") == 0.3
    assert load(path, "rover").limit("speed.max") == 0.5


def test_without_a_base_it_is_the_same_run() -> None:
    assert load({"speed": {"max": 9}}).limit("position.max") == load("same").limit("position.max")


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"cross_trak": {"max": 1.0}}, "'cross_trak' is not known"),
        ({"cross_track": {"mean": 1.0}}, "cross_track.mean is not known; there is max, rms"),
        ({"cross_track": 1.0}, "cross_track is a table of max, rms"),
        ({"cross_track": {"max": -1.0}}, r"cross_track.max = -1.0 is neither a number from 0 on nor false"),
        ({"cross_track": {"max": float("nan")}}, "neither a number"),
        ({"cross_track": {"max": True}}, "neither a number"),
        ({"copter": 3}, r"\[copter\] is a table, not 3"),
        ({"texts": {"ignore": "abc"}}, "texts.ignore is a list of regular expressions, not 'abc'"),
        ({"texts": {"numbers": "no"}}, "texts.numbers is true or false, not 'no'"),
        ({"base": "near"}, "base 'near' is none of exact, same, alike"),
        ({"bits": 1}, "bits is true or false, not 1"),
        ({"align": "noon"}, "align 'noon' is none of"),
        ({"texts": {"ignore": ["("]}}, "texts.ignore is a list of regular expressions"),
        ({"rover": {"rover": {}}}, r"\[rover\]: 'rover' is not known"),
    ],
)
def test_errors_name_the_key(table: dict[str, object], words: str) -> None:
    with pytest.raises(ToleranceError, match=words):
        load(table, "rover")


def test_a_file_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(ToleranceError, match=r"nowhere\.toml.*none of exact, same, alike"):
        load("nowhere.toml")
    path = tmp_path / "bad.toml"
    path.write_text("cross_track = ")
    with pytest.raises(ToleranceError, match=r"bad\.toml.*is no TOML"):
        load(path)
