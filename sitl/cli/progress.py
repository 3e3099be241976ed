# SPDX-License-Identifier: BSD-3-Clause
"""The progress bar of compiling the core."""

from __future__ import annotations

import sys
from types import TracebackType

from tqdm import tqdm

from ..core.build_work import FIRST_LINE, ProgressLines


class CompileProgress:
    """A progress bar that appears only when something is compiled; call it as ``core.compile.Progress``.

    It moves by the work that is done, and tells the time that is left at the speed so far. Where standard error is no
    terminal, lines appear instead.

    Args:
        first: the line that says what is compiled.
    """

    def __init__(self, first: str = FIRST_LINE) -> None:
        self._first = first
        self._bar: tqdm[None] | None = None
        self._lines = None if sys.stderr.isatty() else ProgressLines(first=first)

    def __call__(self, unit: str, done: float, total: float) -> None:
        """Work ``done`` of ``total``; ``unit`` is the one that was begun or completed last."""
        if self._lines is not None:
            self._lines(unit, done, total)
            return
        if self._bar is None or total != self._bar.total:  # another part of the core
            self.__exit__(None, None, None)
            if self._bar is None:
                print(self._first, file=sys.stderr)
            self._bar = tqdm(
                total=total, leave=False, file=sys.stderr, ascii=True, smoothing=0.0,
                bar_format="{percentage:3.0f}% |{bar:30}| {elapsed}, {remaining} left  {desc}",
            )  # fmt: skip
        self._bar.set_description_str(unit, refresh=False)
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> CompileProgress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        if self._bar is not None:
            self._bar.close()
