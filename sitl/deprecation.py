# SPDX-License-Identifier: BSD-3-Clause
"""Names that will go: they still work, and warn. docs/reference/versioning.md says for how long."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

__all__ = ["SitlDeprecationWarning", "deprecated", "renamed", "warn"]

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


class SitlDeprecationWarning(DeprecationWarning):
    """Something of gym-sitl that a program uses will go; the message says when, and what to use."""


def warn(name: str, *, since: str, removed_in: str, instead: str, depth: int = 1) -> None:
    """Warn the caller of the function that calls this.

    Args:
        name: what will go, as a user writes it.
        since: version that warns first.
        removed_in: version that does not have it any more.
        instead: what to use.
        depth: how many calls further up the user's line is.
    """
    text = f"{name} is deprecated since gym-sitl {since} and goes with {removed_in}; use {instead}"
    warnings.warn(text, SitlDeprecationWarning, stacklevel=depth + 2)


def deprecated(*, since: str, removed_in: str, instead: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorator of a public function or method that will go: a call warns, and does what it did."""

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        name = f"{function.__module__}.{function.__qualname__}"

        @functools.wraps(function)
        def warned(*args: P.args, **kwargs: P.kwargs) -> R:
            warn(name, since=since, removed_in=removed_in, instead=instead)
            return function(*args, **kwargs)

        return warned

    return decorate


def renamed(old: str, new: str, *, since: str, removed_in: str) -> Callable[[type[T]], type[T]]:
    """Decorator of a public class: an argument, and the attribute of that name, have got a new name.

    The old one warns, and does what it did. Where both arguments are given the old one counts, because a copy by
    ``dataclasses.replace`` gives both. A derived dataclass needs the decorator, too.
    """

    def decorate(cls: type[T]) -> type[T]:
        made: Callable[..., None] = cls.__init__

        @functools.wraps(made)
        def initialise(self: T, *args: Any, **kwargs: Any) -> None:
            if old in kwargs:
                warn(f"{cls.__name__}({old}=)", since=since, removed_in=removed_in, instead=f"{new}=")
                kwargs[new] = kwargs.pop(old)
            made(self, *args, **kwargs)

        def read(self: T) -> Any:
            warn(f"{cls.__name__}.{old}", since=since, removed_in=removed_in, instead=new)
            return getattr(self, new)

        cls.__init__ = initialise  # type: ignore[method-assign, assignment]
        setattr(cls, old, property(read, doc=f"Old name of ``{new}``."))
        return cls

    return decorate
