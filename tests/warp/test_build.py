# SPDX-License-Identifier: BSD-3-Clause
"""Compiling on the user's machine: what goes wrong is said in words."""

import sys

import pytest

from sitl.cli import execute, main
from sitl.warp import CannotBuild, build
from tests.platforms import on_linux


@pytest.fixture(autouse=True)
def fresh(monkeypatch, tmp_path):
    """No compiled library remembered by this process; an empty cache."""
    monkeypatch.setattr(build, "preload_library", build.preload_library.__wrapped__)
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path))


@on_linux
def test_no_compiler_says_what_to_install(monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(build.shutil, "which", lambda _name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(CannotBuild, match=r"pip install .gym-sitl\[exec\]"):
        build.preload_library()


@on_linux
def test_compiler_that_does_not_exist_is_named(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(CannotBuild, match="no-such-compiler"):
        build.preload_library()


@on_linux
def test_compiler_that_fails_is_quoted(monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(CannotBuild, match="the C compiler failed: false"):
        build.preload_library()


@on_linux
def test_folder_with_a_space_is_refused(monkeypatch, tmp_path):
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path / "my cache"))
    with pytest.raises(CannotBuild, match="SITL_CACHE_DIR"):
        build.preload_library()


def test_another_system_is_told_what_to_do(monkeypatch):
    monkeypatch.setattr(build.sys, "platform", "darwin")
    with pytest.raises(CannotBuild, match="Linux"):
        build.preload_library()


def test_exec_says_so_before_it_starts_a_vehicle(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(build.sys, "platform", "darwin")
    monkeypatch.setattr(execute, "preload_library", build.preload_library)  # not what this process has found before
    monkeypatch.chdir(tmp_path)
    assert main(["exec", "--", sys.executable, "-c", "pass"]) == 2
    out, err = capsys.readouterr()
    assert err.startswith("sitl exec: a script's clock follows simulated time on Linux alone") and err.count("\n") == 1
    assert not out and not list(tmp_path.iterdir())


def test_second_build_is_the_first(monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    try:
        first = build.preload_library()
    except CannotBuild as error:
        pytest.skip(str(error))
    written = first.stat().st_mtime_ns
    assert build.preload_library() == first
    assert first.stat().st_mtime_ns == written
    assert [path.name for path in first.parent.iterdir()] == [first.name]
