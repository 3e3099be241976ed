# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the compiled core that other packages bring: modes, what they remember, groups of parameters.

Each is named by where it is, "package.module:NAME", and kept in an environment variable, so that the processes that
compile the core and those of a pool have it, too; a shell can set the variable as well.
"""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Iterator
from typing import TypeVar

from ..errors import SitlError
from .records import Record

R = TypeVar("R", bound=Record)
SPARE = 256
"""Bytes that a record has for parts of other packages: while they suffice, a part moves nothing, and only units that
mention it are compiled again."""


class ExtensionError(SitlError, ValueError):
    """A part of another package that cannot be taken; the message says which, and why."""


class Extensions:
    """The parts of one kind.

    Args:
        variable: name of the environment variable: "OWNER=package.module:NAME ...".
        noun: what one is called in messages.
    """

    def __init__(self, variable: str, noun: str) -> None:
        self.variable, self.noun = variable, noun
        self._read: set[str] = set()

    def add(self, owner: str, reference: str) -> None:
        """Keep a part for ``owner``, which must not have asked for its parts yet.

        Raises:
            ExtensionError: too late, or ``reference`` does not say where it is.
        """
        name = owner.split(".")[0]
        if name in self._read:
            raise ExtensionError(
                f"{self.noun} {reference}: too late, the {name} firmware is loaded; register it before anything "
                f'imports that, or set {self.variable}="{owner}={reference}" in the environment'
            )
        if not re.fullmatch(r"[\w.]+:\w+", reference):
            raise ExtensionError(f'{self.noun} {reference!r}: where it is must be written as "package.module:NAME"')
        known = os.environ.get(self.variable, "").split()
        if f"{owner}={reference}" not in known:
            os.environ[self.variable] = " ".join((*known, f"{owner}={reference}"))

    def of(self, owner: str) -> Iterator[tuple[str, str, object]]:
        """(key, reference, part) of each part of ``owner``; the key is what stands behind a dot: "copter.TOY" -> "TOY".

        Raises:
            ExtensionError: one cannot be imported.
        """
        self._read.add(owner)
        for entry in os.environ.get(self.variable, "").split():
            whose, _, reference = entry.partition("=")
            name, _, key = whose.partition(".")
            if name == owner:
                yield key, reference, self._load(reference)

    def join(self, owner: str, record: type[R], base: type) -> type[R]:
        """``record`` of ``owner`` with its parts of other packages as fields behind its own, by their keys, and with
        memory for such parts (``SPARE``) where there are none.

        Args:
            owner: whose parts.
            record: what they join.
            base: class that each of them inherits.

        Raises:
            ExtensionError: one cannot be imported, is no such class, or has a name that is taken.
        """
        found: dict[str, type] = {}
        for key, reference, part in self.of(owner):
            if not (isinstance(part, type) and issubclass(part, base)):
                raise ExtensionError(f"{self.noun} {reference}: {part!r} is no {base.__name__}")
            if key in record.fields or key in found:
                raise ExtensionError(f"{self.noun} {reference}: the {owner} has a {self.noun} {key} already")
            found[key] = part
        members = {
            "__annotations__": found, "__module__": record.__module__, "__doc__": record.__doc__,
            "_least": record.dtype.itemsize + SPARE,
        }  # fmt: skip
        return type(record.__name__, (record,), members)

    def _load(self, reference: str) -> object:
        module, _, name = reference.partition(":")
        try:
            return getattr(importlib.import_module(module), name)
        except (ImportError, AttributeError, ValueError) as error:
            raise ExtensionError(f"{self.noun} {reference}: {error}") from error
