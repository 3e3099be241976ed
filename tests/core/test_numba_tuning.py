# SPDX-License-Identifier: BSD-3-Clause
"""Patches of Numba: only where all is there that they use, and without effect on what a unit does."""

from __future__ import annotations

import importlib
import tomllib
from pathlib import Path

import numba
import pytest
from numba.core.callconv import CPUCallConv
from numba.core.codegen import CPUCodeLibrary
from numba.core.cpu import CPUContext

from sitl.core import numba_tuning
from sitl.core.code_cache import ENTRY, load_entry
from sitl.core.compile import ENTRY_OPTIONS, make_jitable
from sitl.core.elementary import atan2, hypot
from sitl.core.scalars import wrap_pi

PATCHED = ((CPUCallConv, "call_function"), (CPUCodeLibrary, "_finalize_final_module"), (CPUContext, "get_executable"))
NAMES = [(patch, name) for patch, names in numba_tuning.NAMES.items() for name in names]


def enter_both():
    """What is replaced while both patches last."""
    before = [getattr(owner, name) for owner, name in PATCHED]
    with numba_tuning.quick(ENTRY), numba_tuning.trust_laws():
        found = [getattr(owner, name) is not old for (owner, name), old in zip(PATCHED, before)]
    assert [getattr(owner, name) for owner, name in PATCHED] == before
    return found


def test_both_are_made_with_this_numba():
    assert enter_both() == [True, True, True]


@pytest.mark.parametrize(("patch", "name"), NAMES)
def test_a_renamed_internal_switches_its_patch_off(patch, name, monkeypatch):
    module, _, path = name.partition(":")
    *parents, attribute = path.split(".")
    owner = importlib.import_module(module)
    for part in parents:
        owner = getattr(owner, part)
    assert numba_tuning.fits(patch)
    with monkeypatch.context() as renamed:
        renamed.setattr(owner, attribute + "_renamed", getattr(owner, attribute), raising=False)
        renamed.delattr(owner, attribute)
        assert not numba_tuning.fits(patch)
        enter = numba_tuning.quick(ENTRY) if patch == "quick" else numba_tuning.trust_laws()
        before = [vars(owner).get(name) for owner, name in PATCHED]
        with enter:
            assert [vars(owner).get(name) for owner, name in PATCHED] == before
    assert numba_tuning.fits(patch)


@pytest.mark.parametrize(
    ("version", "tried"),
    [("0.59.1", False), ("0.60.0", True), ("0.68.1", True), ("0.69.0", False), ("1.0.0", False), ("0.69.0rc1", False),
     ("dev", False)],
)  # fmt: skip
def test_an_untried_numba_gets_no_patch(version, tried, monkeypatch):
    monkeypatch.setattr(numba, "__version__", version)
    assert enter_both() == [tried] * 3


def test_what_is_installed_is_what_was_tried():
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    oldest, following = (".".join(map(str, version)) for version in (numba_tuning.OLDEST, numba_tuning.NEXT))
    assert f"numba>={oldest},<{following}" in project["dependencies"]


SOURCE = f"def {ENTRY}(x, y):\n    return wrap_pi(3.0 * atan2(y, x)) + hypot(x, y)\n"


def test_with_and_without_them_a_unit_gives_the_same_bits(tmp_path, monkeypatch):
    make_jitable()
    names = {"wrap_pi": wrap_pi, "atan2": atan2, "hypot": hypot}
    decorate = numba.cfunc("float64(float64, float64)", cache=True, **ENTRY_OPTIONS)

    def made(name):
        with numba_tuning.trust_laws():
            return load_entry(tmp_path / name, f"probe_{name}", SOURCE, names, decorate)

    tuned = made("tuned")
    monkeypatch.setattr(numba_tuning, "fits", lambda patch: False)
    plain = made("plain")
    assert tuned.inspect_llvm() != plain.inspect_llvm()
    for k in range(200):
        x, y = 0.37 * k - 31.0, 0.91 * (k % 17) - 7.0
        assert tuned.ctypes(x, y) == plain.ctypes(x, y)
