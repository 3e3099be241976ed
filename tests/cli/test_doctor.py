# SPDX-License-Identifier: BSD-3-Clause
"""``sitl doctor``: what it finds, and what it says mends it."""

from __future__ import annotations

import json
import socket
import sys
import tomllib

import pytest

from sitl.cli import doctor, main
from sitl.run import runner
from tests.cli.command import ROOT

WITHOUT_MODULES = {"all", "test", "dev", "docs", "exec"}
"""Extras of other extras, those of contributors, or looked at in another way."""


def found(capsys: pytest.CaptureFixture[str]) -> dict[str, dict[str, str]]:
    main(["doctor", "--json"])
    return {one["name"]: one for one in json.loads(capsys.readouterr().out)}


def test_every_extra_is_looked_at() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert set(project["optional-dependencies"]) - WITHOUT_MODULES == set(doctor.EXTRAS)


def test_what_is_there_and_what_is_not(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    real = doctor.util.find_spec
    monkeypatch.setattr(doctor.util, "find_spec", lambda name: None if name == "matplotlib" else real(name))
    assert main(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("absent  viz ") and "matplotlib" in line for line in lines)
    assert "viz" in lines[-1] and lines[-1].lstrip().startswith("pip install 'gym-sitl[")
    assert found(capsys)["numba"]["state"] == doctor.OK


def test_a_port_in_use_is_named(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        number = taken.getsockname()[1]
        monkeypatch.setattr(runner, "BASE_TCP_PORT", number)
        ports = found(capsys)["ports"]
    assert ports["state"] == doctor.ABSENT and str(number) in ports["what"] and "--instance" in ports["mend"]


def test_units_to_compile_are_counted(no_library, monkeypatch, tmp_path, capsys) -> None:
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path / "not" / "yet"))
    core = found(capsys)["core of copter"]
    assert core["state"] == doctor.ABSENT and core["mend"] == "sitl cache build"
    assert not (tmp_path / "not").exists(), "it only looks"


def test_what_is_broken_ends_with_code_1(monkeypatch, capsys) -> None:
    monkeypatch.setattr(doctor.os, "access", lambda place, how: False)
    assert main(["doctor"]) == 1
    out = capsys.readouterr().out
    assert "BROKEN  cache" in out and "The simulator does not work until you do this:\n  export SITL_CACHE_DIR" in out


def test_an_old_python_is_told_of(monkeypatch) -> None:
    monkeypatch.setattr(sys, "version_info", (3, 10, 4))
    assert next(doctor.system()).state == doctor.BROKEN
