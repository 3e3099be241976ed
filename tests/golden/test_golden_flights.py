# SPDX-License-Identifier: BSD-3-Clause
"""Our own missions fly as they are kept in ``golden/``; ``sitl mission suite tests/golden`` does the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.missions.suite.cases import Case, find
from sitl.missions.suite.fly_case import fly_case

CASES = find(Path(__file__).parent)
QUICK = ("copter-square", "rover-square")
"""Flown with every run of the tests."""


def check(case: Case) -> None:
    """It flies like golden."""
    result = fly_case(case)
    assert result.ok, (
        f"{case.name}: {result.words}\n"
        "If that is meant to be: sitl mission suite tests/golden --update-golden, and say why"
    )


@pytest.mark.parametrize("case", [case for case in CASES if case.name in QUICK], ids=lambda case: case.name)
def test_a_square_flies_like_golden(case: Case) -> None:
    check(case)


@pytest.mark.slow
@pytest.mark.parametrize("case", [case for case in CASES if case.name not in QUICK], ids=lambda case: case.name)
def test_the_library_flies_like_golden(case: Case) -> None:
    check(case)


def test_every_flight_has_a_golden_and_every_golden_a_flight() -> None:
    kept = {path.stem for path in (Path(__file__).parent / "golden").iterdir()}
    assert kept == {case.name for case in CASES}


def test_goldens_are_small() -> None:
    files = list((Path(__file__).parent / "golden").iterdir())
    assert sum(path.stat().st_size for path in files) < 700_000
