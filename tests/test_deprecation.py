# SPDX-License-Identifier: BSD-3-Clause
"""Deprecated names warn where they are used, and go with the version that was told."""

from __future__ import annotations

import ast
import dataclasses
from pathlib import Path

import pytest

import sitl
from sitl.deprecation import SitlDeprecationWarning, deprecated, renamed

PACKAGE = Path(sitl.__file__).parent


@deprecated(since="0.2", removed_in="0.4", instead="fly()")
def flew(height: float, *, speed: float = 1.0) -> float:
    """Old."""
    return height * speed


def test_a_call_warns_at_the_users_line_and_does_what_it_did() -> None:
    with pytest.warns(
        SitlDeprecationWarning, match=r"flew is deprecated since gym-sitl 0\.2 .* 0\.4; use fly"
    ) as found:
        assert flew(2.0, speed=3.0) == 6.0
    assert found[0].filename == __file__
    assert flew.__name__ == "flew" and flew.__doc__ == "Old."


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclasses.dataclass(frozen=True)
class Vehicle:
    name: str
    properties: float = 0.0


def test_an_argument_that_was_renamed_warns_at_the_users_line_and_does_what_it_did() -> None:
    with pytest.warns(
        SitlDeprecationWarning, match=r"Vehicle\(figures=\) is deprecated since gym-sitl 0\.2 .* 0\.4; use properties="
    ) as found:
        assert Vehicle("x", figures=2.0) == Vehicle("x", 2.0)  # type: ignore[call-arg]
    assert found[0].filename == __file__
    with pytest.warns(SitlDeprecationWarning, match=r"Vehicle\.figures is deprecated .*; use properties") as found:
        assert Vehicle("x", 2.0).figures == 2.0  # type: ignore[attr-defined]
    assert found[0].filename == __file__
    with pytest.warns(SitlDeprecationWarning, match=r"Vehicle\(figures=\)"):
        assert dataclasses.replace(Vehicle("x", 2.0), figures=3.0) == Vehicle("x", 3.0)


def test_the_new_name_of_an_argument_does_not_warn(recwarn: pytest.WarningsRecorder) -> None:
    assert dataclasses.replace(Vehicle("x", properties=2.0), name="y").properties == 2.0
    assert not recwarn.list


def version(text: str) -> tuple[int, int]:
    major, minor = text.split(".")[:2]
    return int(major), int(minor)


def promised() -> list[tuple[str, str]]:
    """(place, version) of each removal that the package's code promises."""
    found = []
    for file in PACKAGE.rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        if "removed_in=" not in text or file.name == "deprecation.py":
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call):
                for word in node.keywords:
                    if word.arg == "removed_in" and isinstance(word.value, ast.Constant):
                        found.append((f"{file.relative_to(PACKAGE)}:{node.lineno}", str(word.value.value)))
    return found


def test_what_was_to_go_has_gone() -> None:
    late = [place for place, goes in promised() if version(goes) <= version(sitl.__version__)]
    assert not late, "these go with this version"
