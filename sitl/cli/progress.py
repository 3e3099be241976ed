# SPDX-License-Identifier: BSD-3-Clause
"""The progress bar of compiling the core."""

from __future__ import annotations

import sys
from types import TracebackType

from tqdm import tqdm


class CompileProgress:
    """A progress bar that appears only when something is compiled; call it as ``core.compile.Progress``."""

    def __init__(self) -> None:
        self._bar: tqdm[None] | None = None

    def __call__(self, unit: str, done: int, total: int) -> None:
        if self._bar is None:
            print("Compiling the core (once; later starts load it from the cache)", file=sys.stderr)
            self._bar = tqdm(total=total, unit="unit", leave=False, file=sys.stderr, disable=None, ascii=True)
        self._bar.set_description(unit)
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> CompileProgress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        if self._bar is not None:
            self._bar.close()
