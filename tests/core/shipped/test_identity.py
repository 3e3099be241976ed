# SPDX-License-Identifier: BSD-3-Clause
"""The identity of sources: the same in every process, whatever else is loaded; and starting needs no compiler."""

from __future__ import annotations

import inspect
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import sitl
from sitl.cli.cache import KERNEL_MODULES
from sitl.core.dispatch import by_number
from sitl.core.kernels import LAWS
from sitl.core.shipped.identity import constant_text, source_of
from sitl.vehicle.kinds import KINDS

ASK = """
import importlib, sys
for module in sys.argv[2:]:
    importlib.import_module(module)
module, name = sys.argv[1].split(":")
importlib.import_module(module)
from sitl.core.array_kernels import KERNELS, kernel_identity
from sitl.core.compile import unit_identity
from sitl.core.kernels import UNITS
print(kernel_identity(KERNELS[name]) if name in KERNELS else unit_identity(UNITS[name], "sitl.vehicle.copter.Copter"))
"""
ALL = """
import importlib, json, sys
from sitl.core.compile import unit_folder, unit_identity
from sitl.core.fingerprint import reached
from sitl.vehicle.kinds import KINDS

kind = KINDS[sys.argv[1]]
path, units = kind.record_path, reached(kind.advance)
memory = kind.record.dtype.itemsize
print(json.dumps([memory, {unit.name: [unit_identity(unit, path), unit_folder(unit, path).name] for unit in units}]))
"""
PARTS = """
from sitl.autopilot.params.parameter import ParameterGroup, param
from sitl.core.records import Floats, Record

class Group(ParameterGroup):
    WANTED: float = param(2.0, 0.0, 10.0, "1/s", "Gain of nothing")
    RATES: Floats = param(1.0, 0.0, 10.0, "1/s", "Rate {{n}} of nothing", count={count})

class State(Record):
    since: int
    wanted: float
"""
IMPORT = """
import importlib, sys
import sitl
sitl.Simulation
for module in ("sitl.fleet", "sitl.swarm", "sitl.envs", "sitl.vehicle.copter", "sitl.bridge.copter", *sys.argv[1:]):
    importlib.import_module(module)
print(sorted({"numba", "llvmlite"} & set(sys.modules)))
"""


def said(program: str, *arguments: str, seed: str = "0", beside: Path | None = None, **variables: str) -> str:
    paths = [str(Path(sitl.__file__).parents[1]), *([str(beside)] if beside else ())]
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(paths), **variables}
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_nothing_imports_a_compiler_before_something_is_compiled() -> None:
    assert said(IMPORT, *KERNEL_MODULES) == "[]"


def test_what_else_is_loaded_does_not_matter() -> None:
    for name in (
        "sitl.autopilot.copter.modes.decisions:autopilot.copter.modes.decisions.update",
        "sitl.envs.robots.true_state:envs.robots.true_state.write_truth",
    ):
        alone = said(ASK, name)
        beside = said(ASK, name, "sitl.vehicle.rover", "sitl.bridge.rover.core", "sitl.vehicle.copter", seed="1")
        assert alone == beside, name


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_parameters_and_states_of_other_packages_compile_only_what_uses_them(tmp_path: Path, kind: str) -> None:
    """There is memory for them; without it all that lies behind them would move, and the whole core be compiled."""
    memory, plain = json.loads(said(ALL, kind))
    for count, is_moved in ((12, False), (60, True)):
        (tmp_path / f"parts_{count}.py").write_text(PARTS.format(count=count))
        parts = {
            "SITL_PARAMETERS": f"{kind}.TOY=parts_{count}:Group", "SITL_MODE_STATES": f"{kind}.toy=parts_{count}:State",
        }  # fmt: skip
        more, others = json.loads(said(ALL, kind, beside=tmp_path, **parts))
        assert others.keys() == plain.keys() and len(plain) > 10
        assert (more > memory) is is_moved
        assert [name for name in plain if plain[name] != others[name]] == (list(plain) if is_moved else [])


def test_the_text_of_a_law_is_that_of_its_function() -> None:
    assert all(kind.record for kind in KINDS.values())  # all laws are loaded
    for law in LAWS:
        if not law.__code__.co_filename.startswith("<"):
            lines = [line.rstrip() for line in inspect.getsource(law).splitlines()]
            assert source_of(law) == "\n".join(line for line in lines if line and not line.lstrip().startswith("#"))


def test_laws_chosen_by_number_have_texts_of_their_own() -> None:
    def law(x: float) -> float:
        return x

    def other(x: float) -> float:
        return -x

    first, second = by_number("chosen", {1: law}, other), by_number("chosen", {2: law}, other)
    assert "number == 1" in source_of(first) and "number == 2" in source_of(second)


def test_constants_are_written_alike_by_every_numpy() -> None:
    import numpy as np

    assert constant_text((np.float64(0.5), 1, ("a", True))) == constant_text((0.5, 1, ("a", True)))
    assert constant_text(0.1) != constant_text(np.nextafter(0.1, 1.0))
