# SPDX-License-Identifier: BSD-3-Clause
"""``--json``: what programs read says what people read."""

from __future__ import annotations

import json
import math

import pytest

from sitl import worlds
from sitl.cli import main
from sitl.cli.output import print_json


def printed(words: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    assert main(words.split()) == 0
    return capsys.readouterr().out.splitlines()


def read(words: str, capsys: pytest.CaptureFixture[str]):
    return json.loads("\n".join(printed(f"{words} --json", capsys)))


def test_parameters(capsys) -> None:
    rows = {row["name"]: row for row in read("params --frame erle_copter", capsys)}
    shown = dict(line.split(",") for line in printed("params --frame erle_copter", capsys))
    assert set(shown) <= set(rows)
    assert all(float(value) == pytest.approx(rows[name]["value"], rel=1e-5) for name, value in shown.items())
    angle = rows["ANGLE_MAX"]
    assert (angle["unit"], angle["low"] < angle["default"] < angle["high"]) == ("cdeg", True)


def test_worlds(capsys) -> None:
    rows = read("world list", capsys)
    assert [row["name"] for row in rows] == list(worlds.names())
    assert all(line.endswith(row["description"]) for line, row in zip(printed("world list", capsys), rows, strict=True))
    assert all(len(start["position"]) == 3 for row in rows for start in row["starts"])


def test_the_cache(capsys) -> None:
    found, (folder, library, compiler, *lines) = read("cache show", capsys), printed("cache show", capsys)
    assert (found["folder"], found["compiler"]) == (folder, compiler)
    assert library.startswith(found["library"] or "no machine code came")
    assert not any(row["shipped"] for row in found["units"] if not row["ready"] or not found["library"])
    assert [f"{row['vehicle']}: {row['unit']}" for row in found["units"]] == [line[12:] for line in lines]


def test_the_library_of_missions(capsys) -> None:
    rows = read("mission library", capsys)
    assert [row["name"] for row in rows] == [line.split()[0] for line in printed("mission library", capsys)]


def test_numbers_that_json_does_not_have_are_null(capsys) -> None:
    print_json({"a": [math.nan, 1.5], "b": (math.inf, "x")})
    assert json.loads(capsys.readouterr().out) == {"a": [None, 1.5], "b": [None, "x"]}
