# SPDX-License-Identifier: BSD-3-Clause
"""Builds the libraries of machine code that wheels contain (``sitl cache ship``).

Every unit and kernel becomes an object file for each target, side by side in worker processes; what has been made
before of the same sources, by the same compiler, is used again. Then each target's are linked. The same sources and
compilers give the same bytes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..array_kernels import KERNELS, kernel_identity, kernels_of, unit_of
from ..compile import Progress, compile_tasks, symbol, unit_identity
from ..fingerprint import reached
from ..kernels import Unit
from ..order import KERNELS_PATH, Order
from .library import CONTENTS, SLOT, TABLE, call_symbol, kernel_symbol, unit_key
from .objects import Objects
from .target_machines import TARGETS, Target


class Piece(NamedTuple):
    """A unit or kernel to compile."""

    key: str
    """Its name in the library's contents."""
    identity: str
    symbol: str
    task: str
    """``MODULE:NAME``, as workers know it."""
    path: str
    """Of its record type; that of kernels is ``worker.KERNELS_PATH``."""
    unit: Unit


def pieces(entries: Mapping[str, Iterable[Callable[..., Any]]], modules: Iterable[str]) -> list[Piece]:
    """What a library is made of.

    Args:
        entries: path of a record type -> units that are called from outside the core.
        modules: those that make kernels.
    """
    found: dict[str, Piece] = {}
    for path, functions in entries.items():
        for function in functions:
            for unit in reached(function):
                key, task = unit_key(unit.name, path), f"{function.__module__}:{unit.name}"
                found.setdefault(key, Piece(key, unit_identity(unit, path), symbol(unit, path), task, path, unit))
    for task, kernel in kernels_of(modules).items():
        name, own = kernel.name, unit_of(kernel)
        found[name] = Piece(name, kernel_identity(kernel), kernel_symbol(name), task, KERNELS_PATH, own)
    return [found[key] for key in sorted(found)]


def build(
    made_of: Sequence[Piece], folder: Path, targets: Sequence[Target] = TARGETS, progress: Progress | None = None
) -> list[Path]:
    """Make the library of each target in ``folder``; returns the files.

    Raises:
        BuildError: something cannot be compiled or linked.
        MissingExtra: there is no linker.
    """
    from . import linker, object_code

    for target in targets:
        linker.command(target)
    compilers = hashlib.sha256(object_code.made_with().encode()).hexdigest()[:10]
    objects = Objects(folder / "objects" / compilers, tuple(targets))
    objects.folder.mkdir(parents=True, exist_ok=True)
    for path in dict.fromkeys(piece.path for piece in made_of):
        tasks = {
            piece.task: piece.unit
            for piece in made_of
            if piece.path == path and not objects.complete(piece.symbol, piece.identity)
        }
        compile_tasks(tasks, Order(path, objects), progress)
    return [_link(made_of, objects, target, folder / target.file) for target in targets]


def _link(made_of: Sequence[Piece], objects: Objects, target: Target, file: Path) -> Path:
    from . import linker, object_code

    contents = {piece.key: piece.identity for piece in made_of}
    said = json.dumps({"made with": object_code.made_with(), "contents": contents}, indent=0).encode()
    more = {CONTENTS: object_code.constant(CONTENTS, said, target), **object_code.rounding(target)}
    more[TABLE] = object_code.table_for_python(target)
    exported = [CONTENTS, TABLE]
    for piece in made_of:
        exported.append(piece.symbol)
        if piece.path == KERNELS_PATH:
            name = call_symbol(piece.symbol)
            exported.append(name)
            more[name] = object_code.call_from_python(KERNELS[piece.key], target)
        else:
            exported.append(piece.symbol + SLOT)
            more[piece.symbol] = object_code.switch(piece.symbol, piece.unit.integers, target)
    files = [objects.file(piece.symbol, piece.identity, target) for piece in made_of]
    for name, code in more.items():
        files.append(objects.folder / f"{name}-{target.name}.o")
        files[-1].write_bytes(code)
    linker.link(files, exported, target, file)
    return file
