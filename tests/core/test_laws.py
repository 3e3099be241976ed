# SPDX-License-Identifier: BSD-3-Clause
"""Every law says what it takes and what it gives."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re

import sitl
from sitl.core.kernels import LAWS, UNITS
from sitl.errors import MissingExtra


def _import_all() -> None:
    for module in pkgutil.walk_packages(sitl.__path__, "sitl."):
        if not re.search(r"\.(__main__|preload|static)", module.name):
            try:
                importlib.import_module(module.name)
            except (MissingExtra, ImportError):  # of an extra that is not installed: it has no laws
                assert not module.name.startswith(("sitl.autopilot", "sitl.core", "sitl.physics.native", "sitl.worlds"))


def test_laws_are_annotated_without_any() -> None:
    _import_all()
    ours = [f for f in (*LAWS, *(u.function for u in UNITS.values())) if f.__module__.startswith("sitl.")]
    written = [
        f for f in ours if not f.__code__.co_filename.startswith("<")
    ]  # made by ``by_number``: it checks its own
    assert len(written) > 800
    loose = []
    for function in written:
        signature = inspect.signature(function)
        kinds = [signature.return_annotation, *(p.annotation for p in signature.parameters.values())]
        if any(kind is inspect.Signature.empty or re.search(r"\bAny\b", str(kind)) for kind in kinds):
            loose.append(f"{function.__module__}.{function.__qualname__}{signature}")
    assert not loose


def test_laws_have_few_arguments() -> None:
    _import_all()
    wide = [f"{f.__module__}.{f.__qualname__}" for f in LAWS if f.__code__.co_argcount >= 8]
    assert not wide
