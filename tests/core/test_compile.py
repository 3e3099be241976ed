# SPDX-License-Identifier: BSD-3-Clause
"""The build of the core and of kernels, on toys in processes of their own: compiled once, never stale."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from sitl.core import compile as compiler

LAWS = """
from sitl.core.kernels import law

GAIN = 2.0

@law
def inner(x):
    "One law."
    return GAIN * x  # a comment

@law
def outer(x):
    return x + 1.0
"""

ENTRY = """
from sitl.core.kernels import unit
from sitl.core.records import Record
from toy_laws import inner, outer

class Pair(Record):
    x: float
    y: float

@unit
def first(fleet, i):
    v = fleet[i]
    v.x = inner(v.x)

@unit
def entry(fleet, i, n):
    v = fleet[i]
    for _ in range(n):
        first(fleet, i)
        v.y = outer(v.y)
"""

RUN = """
import json, sys
import numpy as np
import toy
from sitl.core import compile, fingerprint, kernels
units = {u.function.__name__: u for u in kernels.UNITS.values()}
prints = {n: fingerprint.fingerprint(u, (toy.Pair,), "toolchain") for n, u in units.items()}
fleet = toy.Pair.fleet(2)
fleet["x"] = 1.0
built = []
if len(sys.argv) > 1:
    call = compile.load(toy.entry, "toy.Pair", lambda name, done, total: built.append(name))
    call(fleet.ctypes.data, 2, 1, 5)
else:
    toy.entry(fleet.view(np.recarray), 1, 5)
print(json.dumps({"prints": prints, "fleet": fleet[["x", "y"]].tolist(), "built": sorted(set(built))}))
"""


class Toy:
    """A folder with the toy core, and runs of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.write_entry(ENTRY)
        (folder / "run.py").write_text(RUN)
        self.write(LAWS)

    def write_entry(self, entry: str) -> None:
        (self.folder / "toy.py").write_text(entry)

    def write(self, laws: str) -> None:
        (self.folder / "toy_laws.py").write_text(laws)

    def run(self, *arguments: str) -> dict:
        root = str(Path(__file__).parents[2])
        env = {**os.environ, "SITL_CACHE_DIR": str(self.folder / "cache")}
        env["PYTHONPATH"] = os.pathsep.join([str(self.folder), root])
        env.pop("NUMBA_DISABLE_JIT", None)
        env["PYTHONDONTWRITEBYTECODE"] = "1"  # Python takes an edit of equal length in the same second for no edit
        result = subprocess.run(
            [sys.executable, "run.py", *arguments], cwd=self.folder, env=env, capture_output=True, text=True
        )
        assert result.returncode == 0, result.stderr
        self.stderr = result.stderr
        return json.loads(result.stdout)

    def said(self, *arguments: str) -> str:
        """What a run prints on standard error."""
        self.run(*arguments)
        return self.stderr


@pytest.fixture
def toy(tmp_path: Path) -> Toy:
    return Toy(tmp_path)


def test_compiled_equals_python_and_second_start_builds_nothing(toy: Toy) -> None:
    plain = toy.run()
    cold = toy.run("compiled")
    warm = toy.run("compiled")
    assert plain["fleet"] == cold["fleet"] == warm["fleet"] == [[1.0, 0.0], [32.0, 5.0]]
    assert cold["built"] == ["toy.entry", "toy.first"]
    assert warm["built"] == []


def test_an_edited_law_rebuilds_only_the_units_that_reach_it(toy: Toy) -> None:
    toy.run("compiled")
    toy.write(LAWS.replace("x + 1.0", "x + 2.0"))
    after = toy.run("compiled")
    assert after["built"] == ["toy.entry"]
    assert after["fleet"][1] == [32.0, 10.0]


X, Y, ROOM = "    x: float\n", "    y: float\n", "    others: Floats = array(3)\n"
WIDE = ENTRY.replace("import Record\n", "import Floats, Record, array\n").replace(Y, Y + ROOM)
"""With 40 bytes of fields: the record has room for more. Unit ``first`` uses x alone, unit ``entry`` y alone."""
NEW, BOTH = "    new: float\n", ["toy.entry", "toy.first"]


@pytest.mark.parametrize(
    ("old", "new", "built"),
    [
        (ROOM, ROOM + NEW, []),  # where there was nothing
        (ROOM, NEW + ROOM, []),  # what it moves is used by nobody
        (X, X + NEW, ["toy.entry"]),  # it moves y
        (X, NEW + X, BOTH),
        (ROOM, ROOM + "    new: Floats = array(4)\n", BOTH),  # more than there is room for: it moves the next record
        (Y, "    y: int\n", ["toy.entry"]),
        ("v.y = outer(v.y)", "v.others[0] = outer(v.y)\n        v.y = v.others[0]", ["toy.entry"]),
    ],
)  # fmt: skip
def test_a_changed_record_rebuilds_only_the_units_that_use_what_moved(
    toy: Toy, old: str, new: str, built: list[str]
) -> None:
    toy.write_entry(WIDE)
    assert toy.run("compiled")["built"] == BOTH
    assert old in WIDE
    toy.write_entry(WIDE.replace(old, new))
    after = toy.run("compiled")
    assert after["built"] == built
    assert after["fleet"] == toy.run()["fleet"] == [[1.0, 0.0], [32.0, 5.0]]
    assert toy.run("compiled")["built"] == [], "what was kept is found again"


@pytest.mark.parametrize(
    ("old", "new", "changed"),
    [
        ("GAIN = 2.0", "GAIN = 3.0", {"first"}),
        ("return GAIN * x", "return GAIN + x", {"first"}),
        ("# a comment", "# another", set()),
        ("One law.", "A law.", set()),
        ("x + 1.0", "x + 2.0", {"entry"}),
    ],
)
def test_fingerprint_follows_code_and_constants_but_not_comments(
    toy: Toy, old: str, new: str, changed: set[str]
) -> None:
    before = toy.run()["prints"]
    toy.write(LAWS.replace(old, new))
    after = toy.run()["prints"]
    assert {name for name in before if before[name] != after[name]} == changed


def test_machine_code_belongs_to_a_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    here = compiler.toolchain()
    monkeypatch.setattr(numba.config, "CPU_NAME", "generic")
    monkeypatch.setattr(numba.config, "CPU_FEATURES", "")
    assert compiler.toolchain() != here


def test_a_first_start_without_progress_says_what_takes_so_long(toy: Toy) -> None:
    (toy.folder / "run.py").write_text(RUN.replace(", lambda name, done, total: built.append(name))", ")"))
    cold, warm = toy.said("compiled"), toy.said("compiled")
    assert cold == "gym-sitl compiles its core (once; later starts load it from the cache)\n" and warm == ""


def failed(toy: Toy) -> str:
    """What a run says that cannot be compiled."""
    root = str(Path(__file__).parents[2])
    env = {**os.environ, "SITL_CACHE_DIR": str(toy.folder / "cache")}
    env["PYTHONPATH"] = os.pathsep.join([str(toy.folder), root])
    result = subprocess.run(
        [sys.executable, "run.py", "compiled"], cwd=toy.folder, env=env, capture_output=True, text=True
    )
    assert result.returncode != 0
    return result.stderr


def test_a_unit_that_cannot_be_compiled_says_which_and_why(toy: Toy) -> None:
    toy.write(LAWS.replace("GAIN * x", "GAIN * x.nothing"))
    said = failed(toy)
    assert "BuildError: compiling unit toy.first failed" in said
    assert "nothing" in said


def test_the_reason_is_shown_however_deep_the_law_is(toy: Toy) -> None:
    calls = "".join(f"\n@law\ndef law{k}(x):\n    return law{k - 1}(x)\n" for k in range(1, 12))
    deep = LAWS.replace("GAIN * x", "law11(x)") + "\n@law\ndef law0(x):\n    return x.nothing\n" + calls
    toy.write(deep)
    said = failed(toy)
    reason = said.partition("compiling unit toy.first failed:\n")[2].splitlines()
    assert reason[0].startswith("TypingError") and "nothing" in "".join(reason[:4]), reason[:4]


@pytest.mark.parametrize(("old", "new"), [("inner(v.x)", "inner(v.z)"), ("v.x = inner", "v.z = inner")])
def test_a_field_that_a_record_does_not_have_is_named_with_its_line(toy: Toy, old: str, new: str) -> None:
    (toy.folder / "toy.py").write_text(ENTRY.replace(old, new))
    said = failed(toy)
    assert "record toy.Pair has no field 'z'" in said
    line = ENTRY.replace(old, new).splitlines().index(f"    {'v.x = inner(v.x)'.replace(old, new)}") + 1
    assert f'toy.py", line {line}:' in said
    assert "Traceback" not in said.split("BuildError")[-1], "no way through Numba's compiler"


def test_progress_is_told_in_work_and_ends_complete(toy: Toy) -> None:
    told = "lambda *step: built.append(step)"
    (toy.folder / "run.py").write_text(
        RUN.replace("lambda name, done, total: built.append(name)", told).replace("sorted(set(built))", "built")
    )
    steps = toy.run("compiled")["built"]
    done = [step[1] for step in steps]
    assert done == sorted(done) and done[0] < 0.1 * steps[0][2]
    assert done[-1] == pytest.approx(steps[-1][2]) and len({step[2] for step in steps}) == 1


def test_nothing_is_left_of_a_build_that_is_interrupted(toy: Toy) -> None:
    (toy.folder / "run.py").write_text(
        RUN.replace("lambda name, done, total: built.append(name)", "stop").replace(
            "built = []", "built = []\ndef stop(*step):\n    raise KeyboardInterrupt"
        )
    )
    root = str(Path(__file__).parents[2])
    env = {**os.environ, "SITL_CACHE_DIR": str(toy.folder / "cache")}
    env["PYTHONPATH"] = os.pathsep.join([str(toy.folder), root])
    result = subprocess.run([sys.executable, "run.py", "x"], cwd=toy.folder, env=env, capture_output=True, text=True)
    assert "KeyboardInterrupt" in result.stderr  # and communicate() has seen both pipes closed: nobody holds them


KERNEL_LAWS = """
from sitl.core.kernels import law
@law
def grow(x):
    return 2.0 * x
"""
KERNEL = """
import numpy as np
from sitl.core.kernels import law
from sitl.core.array_kernels import Kernel, Line
from toy_room import grow

@law
def grow_all(values: Line) -> None:
    for k in range(values.shape[0]):
        values[k] = grow(values[k])

grown = Kernel(grow_all)
values = np.ones(3)
grown(values)
print(values.tolist())
"""


def run(folder: Path) -> str:
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join((str(Path(__file__).parents[2]), str(folder))),
        "SITL_CACHE_DIR": str(folder / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    command = [sys.executable, "-c", "import toy_kernel"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_an_edit_of_a_law_elsewhere_is_noticed(tmp_path: Path) -> None:
    (tmp_path / "toy_room.py").write_text(KERNEL_LAWS)
    (tmp_path / "toy_kernel.py").write_text(KERNEL)
    assert run(tmp_path) == "[2.0, 2.0, 2.0]"
    machine_code = {p: p.stat().st_mtime_ns for p in (tmp_path / "cache").rglob("*.nbc")}
    assert len(machine_code) == 1
    assert run(tmp_path) == "[2.0, 2.0, 2.0]"
    assert {p: p.stat().st_mtime_ns for p in (tmp_path / "cache").rglob("*.nbc")} == machine_code, (
        "loaded, not compiled"
    )
    (tmp_path / "toy_room.py").write_text(KERNEL_LAWS.replace("2.0", "3.0"))
    assert run(tmp_path) == "[3.0, 3.0, 3.0]"
    assert len(list((tmp_path / "cache").glob("*/built"))) == 2
