# SPDX-License-Identifier: BSD-3-Clause
"""While the plugin's first test waits for the core, it says so, once."""

from __future__ import annotations

from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.missions.testing.plugin import _Compiling


def config(capture: Any) -> Any:
    return SimpleNamespace(pluginmanager=SimpleNamespace(getplugin={"capturemanager": capture}.get))


def test_it_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    says = _Compiling(config(None))
    for k in range(3):
        says("unit", float(k), 3.0)
    said = capsys.readouterr()
    assert said.err == "\nsitl: compiling the core, once (later runs load it from the cache)\n" and said.out == ""


def test_it_is_said_past_what_pytest_captures(capsys: pytest.CaptureFixture[str]) -> None:
    steps: list[str] = []

    @contextmanager
    def disabled() -> Any:
        steps.append(capsys.readouterr().err)
        yield
        steps.append(capsys.readouterr().err)

    _Compiling(config(SimpleNamespace(global_and_fixture_disabled=disabled)))("unit", 0.0, 1.0)
    assert steps[0] == "" and "compiling the core" in steps[1]
