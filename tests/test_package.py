# SPDX-License-Identifier: BSD-3-Clause
"""One installed package: its files, the names that it offers, and that a user's own folders do no harm."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import sitl
from sitl import vehicles, worlds
from sitl.cli import help
from sitl.fleet import Fleet
from sitl.simulation import Simulation

ROOT = Path(__file__).parents[1]
ROOMS = ("envs", "missions", "agents", "examples")
OURS = ("sitl", "tests", "benchmarks", "docs")

USER = """
import sys
import agents, envs, examples, missions  # the user's own
assert [m.OWNER for m in (agents, envs, examples, missions)] == ["user"] * 4
import gymnasium
import sitl
assert sitl.__file__.startswith(sys.argv[1]), sitl.__file__
shape = gymnasium.make("sitl.envs:GazeboCircuit2TurtlebotLIDAR-v0").reset(seed=1)[0].shape
again = gymnasium.make("sitl/Navigate-v0").reset(seed=1)[0].shape
from importlib.metadata import distribution, entry_points
here = distribution("gym-sitl").entry_points
for entry in here:
    if entry.group in ("sitl.commands", "pytest11"):
        entry.load()
from sitl.agents import recipes
from sitl.missions import library
print(shape, again, len(library.entries()), len(recipes.names()) > 3)
"""


def imported(file: Path) -> set[str]:
    """Top-level packages that a file imports."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found.add(str(node.module).split(".")[0])
    return found


def test_readers_find_the_rooms_at_the_top_and_code_does_not() -> None:
    for room in ROOMS:
        assert (ROOT / room).is_symlink() and (ROOT / room).resolve() == (ROOT / "sitl" / room).resolve()
    for folder in OURS:
        for file in (ROOT / folder).rglob("*.py"):
            assert not imported(file) & set(ROOMS), file


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of this tree, built in a copy of it."""
    source = tmp_path_factory.mktemp("source") / "tree"
    without = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "build", "dist", "tests")
    shutil.copytree(ROOT, source, symlinks=True, ignore=without)
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", "out", "."]
    done = subprocess.run(command, cwd=source, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (found,) = (source / "out").glob("*.whl")
    return found


@pytest.mark.slow
def test_a_wheel_holds_one_package_with_all_its_files(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    top = {name.split("/")[0] for name in names}
    assert len(top) == 2 and "sitl" in top and all(name == "sitl" or name.endswith(".dist-info") for name in top)
    there = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "sitl").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    pages = {f"sitl/docs/{page.relative_to(ROOT / 'docs').as_posix()}" for page in help.pages().values()}
    assert {name for name in names if name.startswith("sitl/") and not name.endswith("/index.md")} == there | pages


@pytest.mark.slow
def test_a_users_own_folders_do_no_harm(wheel: Path, tmp_path: Path) -> None:
    site, project = tmp_path / "site", tmp_path / "project"
    install = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", str(site), str(wheel)]
    assert subprocess.run(install, capture_output=True).returncode == 0
    for room in ROOMS:
        (project / room).mkdir(parents=True)
        (project / room / "__init__.py").write_text("OWNER = 'user'\n")
    (project / "user.py").write_text(USER)
    environment = {**os.environ, "PYTHONPATH": str(site)}
    command = [sys.executable, "user.py", str(site)]
    done = subprocess.run(command, cwd=project, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "(5,) (20,) 39 True\n"


@pytest.mark.slow
def test_the_commands_for_newcomers_work_without_the_repository(wheel: Path, tmp_path: Path) -> None:
    site, desk = tmp_path / "site", tmp_path / "desk"
    desk.mkdir()
    install = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", str(site), str(wheel)]
    assert subprocess.run(install, capture_output=True).returncode == 0
    environment = {**os.environ, "PYTHONPATH": str(site)}

    def typed(*words: str) -> str:
        done = subprocess.run([sys.executable, *words], cwd=desk, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert typed("-c", "import sitl; print(sitl.__file__)").startswith(str(site))
    assert typed("-m", "sitl", "help", "faults") == (ROOT / "docs/faults.md").read_text(encoding="utf-8")
    typed("-m", "sitl", "world", "show", "maze")
    assert (desk / "maze.png").read_bytes().startswith(b"\x89PNG")
    typed("-m", "sitl", "examples", "--copy")
    script = ("examples/pymavlink_guided.py", "tcp:127.0.0.1:{tcp}")
    if sys.platform == "linux":  # elsewhere scripts run in real time
        words = ("exec", "--speedup", "max", "--tcp", "0", "--out", "none", "--", sys.executable, *script)
        assert typed("-m", "sitl", *words).rstrip().endswith("landed and disarmed")
    pytest.importorskip("mavsdk")
    for kind in ("copter", "rover"):
        assert "picture: logs/demo-" in typed("-m", "sitl", "demo", kind)


def test_every_name_is_there() -> None:
    assert sitl.Simulation is Simulation and sitl.Fleet is Fleet
    assert sitl.vehicle_names is vehicles.names and "erle_copter" in sitl.vehicle_names()
    assert sitl.world_names is worlds.names and "maze" in sitl.world_names()
    assert set(sitl.__all__) <= set(dir(sitl)) and all(hasattr(sitl, name) for name in sitl.__all__)


def test_another_name_is_refused() -> None:
    with pytest.raises(
        AttributeError, match=r"no attribute 'simulation_of'; it has Fleet, LinkFaults, Move, Simulation, "
    ):
        sitl.simulation_of  # noqa: B018


def test_importing_it_loads_nothing_else() -> None:
    code = "import sys, importlib, typing, __future__; before = set(sys.modules); import sitl; dir(sitl); "
    code += "print(sorted(set(sys.modules) - before))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.stdout == "['sitl', 'sitl.version']\n", done.stderr
