# SPDX-License-Identifier: BSD-3-Clause
"""Patches of Numba: only where all is there that they use, and without effect on what a unit does."""

from __future__ import annotations

import builtins
import importlib
import sys
import tomllib
from functools import cache
from itertools import count
from pathlib import Path
from types import ModuleType

import numba
import pytest
from llvmlite import ir
from numba.core import event
from numba.core.callconv import CPUCallConv
from numba.core.codegen import CPUCodeLibrary
from numba.core.cpu import CPUContext
from numba.extending import register_jitable

from sitl.core import numba_internals, numba_tuning
from sitl.core.code_cache import ENTRY, load_entry
from sitl.core.compile import ENTRY_OPTIONS

PATCHED = (
    (CPUCallConv, "call_function"),
    (CPUCodeLibrary, "finalize"),
    (CPUContext, "get_executable"),
    (event, "start_event"),
    (event, "end_event"),
)
REPLACED, USED = numba_internals.REPLACED, numba_internals.USED
NAMES = [(patch, name) for patch in REPLACED for name in (*REPLACED[patch], *USED[patch])]
FUNCTIONS = [(patch, name) for patch in REPLACED for name, number in (REPLACED[patch] | USED[patch]).items() if number]

LAWS = """
def inner(x, y):
    return x * y - 0.1 if x > y else x / (y + 3.0)
def outer(x, y):
    total = 0.0
    for k in range(7):
        total += inner(x + k, y) * inner(y, total)
    return total
"""
SOURCE = f"def {ENTRY}(x, y):\n    return outer(x, y) + inner(y, x)\n"
POINTS = [(0.37 * k - 31.0, 0.91 * (k % 17) - 7.0) for k in range(60)]
_numbers = count()


@pytest.fixture(autouse=True)
def any_version(monkeypatch):
    """Whether a Numba that is newer than the tried ones has what patches need is what these tests tell."""
    monkeypatch.setattr(numba_internals, "is_tried", lambda version: True)


def compiled(folder):
    """A unit made of laws that Numba has not seen before, compiled as units are."""
    laws: dict = {}
    exec(LAWS, laws)
    for name in ("inner", "outer"):
        register_jitable(**numba_tuning.law_options())(laws[name])
    name = f"probe_{next(_numbers)}"
    decorate = numba.cfunc("float64(float64, float64)", cache=True, **ENTRY_OPTIONS)
    with numba_tuning.trust_laws():
        return load_entry(folder / name, name, SOURCE, {name: laws[name] for name in ("inner", "outer")}, decorate)


def results(unit):
    return [unit.ctypes(x, y).hex() for x, y in POINTS]


@cache
def in_python():
    space: dict = {}
    exec(LAWS + SOURCE, space)
    return [float(space[ENTRY](x, y)).hex() for x, y in POINTS]


def made_patches():
    """Which methods are replaced while both patches last."""
    before = [vars(owner).get(name) for owner, name in PATCHED]
    with numba_tuning.quick(ENTRY), numba_tuning.trust_laws():
        found = [vars(owner).get(name) is not old for (owner, name), old in zip(PATCHED, before)]
    assert [vars(owner).get(name) for owner, name in PATCHED] == before
    return found


def owner_of(name):
    module, _, path = name.partition(":")
    *parents, attribute = path.split(".")
    owner = importlib.import_module(module)
    for part in parents:
        owner = getattr(owner, part)
    return owner, attribute


def rename(owner, attribute, monkeypatch):
    """As if a release of Numba had another name for it: Numba and llvmlite find it, and nobody else."""
    hidden = vars(owner).get(attribute)

    def lookup(of, name):
        if name != attribute or not sys._getframe(2).f_globals.get("__name__", "").startswith(("numba", "llvmlite")):
            raise AttributeError(name)
        bound = of is not None and hasattr(hidden, "__get__") and not isinstance(hidden, type)
        return hidden.__get__(of) if bound else hidden

    if isinstance(owner, ModuleType):
        monkeypatch.setattr(owner, "__getattr__", lambda name: lookup(None, name), raising=False)
        monkeypatch.setattr(builtins, attribute, hidden, raising=False)  # for functions of the module itself
    elif above := [base for base in owner.__mro__[1:] if attribute in vars(base)]:  # what it overrides is found first
        monkeypatch.setattr(above[0], attribute, hidden)
    else:
        assert not hasattr(owner, "__getattr__")
        monkeypatch.setattr(owner, "__getattr__", lambda self, name: lookup(self, name), raising=False)
    if hidden is None:  # an attribute that each object gets when it is made: it gets another one
        code = owner.__init__.__code__
        names = tuple(f"{attribute}_renamed" if name == attribute else name for name in code.co_names)
        monkeypatch.setattr(owner.__init__, "__code__", code.replace(co_names=names))
        hidden = property(lambda self: getattr(self, f"{attribute}_renamed"))
    else:
        monkeypatch.delattr(owner, attribute)


def test_both_are_made_with_this_numba():
    assert [numba_internals.why_not(patch) for patch in REPLACED] == ["", ""]
    assert made_patches() == [True] * 5
    assert numba_tuning.summary() == f"Numba {numba.__version__}: all that speeds up compiling is on"


def test_with_and_without_them_a_unit_gives_the_same_bits(tmp_path, monkeypatch):
    tuned = compiled(tmp_path)
    texts = {tuned.inspect_llvm()}
    for left_out in ({"quick"}, {"trust_laws"}, {"quick", "trust_laws"}):
        monkeypatch.setattr(numba_tuning, "fits", lambda patch, left_out=left_out: patch not in left_out)
        plain = compiled(tmp_path)
        texts.add(plain.inspect_llvm())
        assert results(plain) == in_python()
    assert results(tuned) == in_python()
    assert len({text.count("alloca") for text in texts}) > 1  # calls are checked, or they are not


@pytest.mark.parametrize(("patch", "name"), NAMES)
def test_with_a_renamed_internal_a_unit_is_compiled_without_that_patch(patch, name, monkeypatch, tmp_path):
    assert numba_internals.fits(patch)
    with monkeypatch.context() as renamed:
        rename(*owner_of(name), renamed)
        assert name in numba_internals.why_not(patch)
        assert name in numba_tuning.summary()
        made = made_patches()
        assert made == [patch == "quick", *[patch != "quick"] * 4]
        assert results(compiled(tmp_path)) == in_python()
    assert numba_internals.fits(patch)


@pytest.mark.parametrize(("patch", "name"), FUNCTIONS)
def test_an_internal_with_one_more_argument_switches_its_patch_off(patch, name, monkeypatch):
    owner, attribute = owner_of(name)
    number = (REPLACED[patch] | USED[patch])[name]
    space: dict = {}
    exec(f"def changed({', '.join(f'a{k}' for k in range(number + 1))}): pass", space)
    monkeypatch.setattr(owner, attribute, space["changed"])
    assert numba_internals.why_not(patch) == f"Numba {numba.__version__} has no {name} of {number} arguments"


def test_opaque_pointers_switch_off_the_patch_that_reads_their_types(monkeypatch):
    monkeypatch.setattr(ir, "PointerType", lambda pointee: ir.IntType(64))  # a type that has no pointee
    assert "what they point to" in numba_internals.why_not("trust_laws")
    assert numba_internals.fits("quick")


@pytest.mark.parametrize(
    ("version", "tried"),
    [("0.59.1", False), ("0.60.0", True), ("0.68.1", True), ("0.69.0", False), ("1.0.0", False), ("0.69.0rc1", False),
     ("dev", False)],
)  # fmt: skip
def test_an_untried_numba_gets_no_patch(version, tried, monkeypatch):
    monkeypatch.undo()
    monkeypatch.setattr(numba, "__version__", version)
    assert made_patches() == [tried] * 5
    assert (f"Numba {version} is not one of the tried versions, 0.60 to 0.68" in numba_tuning.summary()) is not tried


def test_what_is_installed_is_what_was_tried():
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    oldest, following = (".".join(map(str, version)) for version in (numba_internals.OLDEST, numba_internals.NEXT))
    assert f"numba>={oldest},<{following}" in project["dependencies"]
