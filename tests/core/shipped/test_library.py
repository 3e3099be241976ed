# SPDX-License-Identifier: BSD-3-Clause
"""A library of machine code, on a toy core: made once, used without a compiler, and only for the sources it is of."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from sitl.core.shipped import linker, target_machines
from sitl.errors import MissingExtra

LAWS = """
from sitl.core.kernels import law

GAIN = 2.0

@law
def inner(x):
    return GAIN * x

@law
def outer(x):
    return x + 1.0
"""

UNITS = """
from typing import NamedTuple
from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law, unit
from sitl.core.records import Record
from sitl.core.vectors import Vec2
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

class Rows(NamedTuple):
    values: Table
    shift: Vec2

class Sum(NamedTuple):
    total: float
    last: Vec2
    count: int

@law
def add_up(rows: Rows, line: Line, wanted: int, twice: bool) -> Sum:
    total = 0.0
    for k in range(wanted):
        total += outer(rows.values[k, 0]) + line[k]
    line[0] = total
    if twice:
        total *= 2.0
    return Sum(total, Vec2(rows.shift.y, rows.shift.x), wanted)

summed = Kernel(add_up)
"""

BUILD = """
import sys
from pathlib import Path
import toy
from sitl.core.shipped import build, target_machines
chosen = [t for t in target_machines.TARGETS if t.name in sys.argv[2].split(",")]
build.build(build.pieces({"toy.Pair": [toy.entry]}, ["toy"]), Path(sys.argv[1]), chosen)
"""

RUN = """
import json, sys
import numpy as np
import toy
from sitl.core import compile
from sitl.core.vectors import Vec2
fleet = toy.Pair.fleet(2)
fleet["x"] = 1.0
built = []
call = compile.load(toy.entry, "toy.Pair", lambda name, done, total: built.append(name))
call(fleet.ctypes.data, 2, 1, 5)
table, line = np.arange(6.0).reshape(3, 2), np.ones(3)
rows = toy.Rows(table, Vec2(3.0, 4.0))
found = toy.summed(rows, line, np.int64(2), True)
said = []
for wrong in (table.astype("f4"), table.T, table[0], table[:, ::-1], 3.0):
    try:
        toy.summed(toy.Rows(wrong, Vec2(3.0, 4.0)), line, 2, True)
    except TypeError as error:
        said.append(str(error))
bound = toy.summed.bind(rows, line)(2, False)
print(json.dumps({
    "fleet": fleet.tolist(), "built": sorted(set(built)), "numba": "numba" in sys.modules, "llvmlite": "llvmlite" in sys.modules,
    "found": repr(found), "types": [type(part).__name__ for part in found], "line": line.tolist(), "bound": repr(bound), "said": said,
}))
"""  # noqa: E501
OUTLIVE = """
import sys
import toy
from sitl.core.shipped.library import kernel_symbol, library
sys.kept = library().method(kernel_symbol("toy.add_up"))  # goes when all modules have gone
"""


def _linker_of(target: target_machines.Target) -> bool:
    try:
        return bool(linker.command(target))
    except MissingExtra:
        return False


HERE = target_machines.usable()[-1:]
pytestmark = pytest.mark.skipif(not HERE or not _linker_of(HERE[0]), reason="no linker, or no target like this machine")


class Toy:
    """A folder with a toy core and the library of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "toy.py").write_text(UNITS)
        self.write(LAWS)

    def write(self, laws: str) -> None:
        (self.folder / "toy_laws.py").write_text(laws)

    def _start(self, source: str, *arguments: str, **variables: str) -> str:
        env = {**os.environ, "SITL_CACHE_DIR": str(self.folder / "cache"), **variables}
        env["PYTHONPATH"] = os.pathsep.join([str(self.folder), str(Path(__file__).parents[3]), *sys.path])
        env.pop("NUMBA_DISABLE_JIT", None)
        env["PYTHONDONTWRITEBYTECODE"] = "1"
        command = [sys.executable, "-c", source, *arguments]
        done = subprocess.run(command, cwd=self.folder, env=env, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def ship(self, folder: str = "shipped", names: str = "") -> Path:
        """Build libraries; returns their folder."""
        self._start(BUILD, folder, names or HERE[0].name)
        return self.folder / folder

    def run(self, folder: str = "shipped", **variables: str) -> dict:
        found = json.loads(self._start(RUN, SITL_SHIPPED_DIR=folder and str(self.folder / folder), **variables))
        assert isinstance(found, dict)
        return found


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Toy:
    toy = Toy(tmp_path_factory.mktemp("toy"))
    toy.ship()
    return toy


@pytest.fixture
def toy(made: Toy) -> Toy:
    """The toy as its library was made of it, and nothing compiled."""
    made.write(LAWS)
    (made.folder / "toy.py").write_text(UNITS)
    subprocess.run(["rm", "-rf", str(made.folder / "cache")], check=True)
    return made


SUM = "Sum(total=12.0, last=Vec2(x=4.0, y=3.0), count=2)"
AGAIN = "Sum(total=11.0, last=Vec2(x=4.0, y=3.0), count=2)"
"""Of the sources as they are."""


def test_shipped_code_does_what_is_compiled_and_needs_no_compiler(toy: Toy) -> None:
    shipped, compiled = toy.run(), toy.run("")
    assert shipped["fleet"] == compiled["fleet"] == [[1.0, 0.0], [32.0, 5.0]]
    assert (shipped["built"], shipped["numba"], shipped["llvmlite"]) == ([], False, False)
    assert compiled["built"] == ["toy.entry", "toy.first"] and compiled["numba"]
    for name in ("found", "types", "line", "bound"):
        assert shipped[name] == compiled[name]
    assert shipped["found"] == SUM
    assert shipped["bound"] == AGAIN
    assert len(shipped["said"]) == len(compiled["said"]) == 5, "what does not fit is refused"
    assert "array_kernels" not in shipped["said"][0] and "add_up takes (Rows, float64, 1 axes" in shipped["said"][0]


def test_a_function_that_outlives_its_module_ends_with_python(toy: Toy) -> None:
    """Python reads the definition of a function when that goes; glibc overwrites here what is given back."""
    environment = {"PYTHONMALLOC": "malloc", "MALLOC_PERTURB_": "255"}
    toy._start(OUTLIVE, SITL_SHIPPED_DIR=str(toy.folder / "shipped"), **environment)


def test_shipped_code_calls_a_unit_that_has_been_changed(toy: Toy) -> None:
    toy.write(LAWS.replace("GAIN = 2.0", "GAIN = 3.0"))
    found = toy.run()
    assert found["built"] == ["toy.first"], "only what has been changed is compiled"
    assert found["fleet"] == [[1.0, 0.0], [243.0, 5.0]], "and the shipped entry calls it"


def test_a_changed_unit_calls_shipped_code(toy: Toy) -> None:
    toy.write(LAWS.replace("x + 1.0", "x + 2.0"))
    found = toy.run()
    assert found["built"] == ["toy.entry"]
    assert found["fleet"] == [[1.0, 0.0], [32.0, 10.0]]
    assert found["found"] == SUM.replace("12.0", "16.0")


@pytest.mark.parametrize(
    ("old", "new"),
    [("@law\ndef inner", "# a comment\n\n@law\ndef inner"), ("GAIN * x", "GAIN * x\n    # another\n")],
)
def test_comments_and_empty_lines_change_nothing(toy: Toy, old: str, new: str) -> None:
    toy.write(LAWS.replace(old, new))
    assert toy.run()["built"] == []


def test_a_record_with_another_field_is_compiled(toy: Toy) -> None:
    (toy.folder / "toy.py").write_text(UNITS.replace("    y: float\n\n@unit", "    y: float\n    z: float\n\n@unit"))
    assert toy.run()["built"] == ["toy.entry", "toy.first"]


def test_a_library_that_cannot_be_loaded_is_as_none(toy: Toy) -> None:
    broken = toy.folder / "broken"
    broken.mkdir(exist_ok=True)
    whole = (toy.folder / "shipped" / HERE[0].file).read_bytes()
    (broken / HERE[0].file).write_bytes(whole[: len(whole) // 2])
    assert toy.run("broken")["built"] == ["toy.entry", "toy.first"]


MACHINES = {"x86_64": 62, "x86_64_v3": 62, "aarch64": 183}
"""ELF's numbers of architectures."""


def test_the_same_sources_give_the_same_bytes_and_code_for_other_machines(toy: Toy) -> None:
    chosen = [target for target in target_machines.TARGETS if _linker_of(target)]
    folder = toy.ship("elsewhere", ",".join(target.name for target in chosen))
    for target in chosen:
        head = (folder / target.file).read_bytes()[:20]
        assert head[:4] == b"\x7fELF" and int.from_bytes(head[18:20], "little") == MACHINES[target.name]
    first = (toy.folder / "shipped" / HERE[0].file).read_bytes()
    assert (folder / HERE[0].file).read_bytes() == first
    assert str(toy.folder).encode() not in first and b"site-packages" not in first
