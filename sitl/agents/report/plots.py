# SPDX-License-Identifier: BSD-3-Clause
"""Matplotlib, when a picture is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle, product
from pathlib import Path
from typing import Any

from sitl.core.extras import MissingExtra

from ..errors import AgentError

COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b", "#17becf", "#7f7f7f")
_LINES = ("-", "--", ":", "-.")


def styles() -> Iterator[tuple[str, str]]:
    """Distinct pairs of colour and line style, without end."""
    return cycle((colour, line) for line, colour in product(_LINES, COLOURS))


def figure(width: float = 9.0, height: float = 5.0, rows: int = 1, columns: int = 1, **options: Any) -> Any:
    """A figure that needs no screen, and its axes, an array of shape (rows, columns); width, height [inch].

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("pictures need matplotlib: pip install 'gym-sitl[report]'") from None
    made = Figure((width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, squeeze=False, **options)


def fit_to_lines(axes: Any) -> None:
    """Limits of y by the lines on axes, with a quarter of their extent around; wide bands do not squeeze them."""
    drawn = [float(y) for line in axes.get_lines() for y in line.get_ydata()]
    lowest, highest = min(drawn), max(drawn)
    around = 0.25 * (highest - lowest) or 0.05 * abs(highest) or 1.0
    axes.set_ylim(lowest - around, highest + around)


def save(made: Any, path: Path) -> Path:
    """Write it as PNG, whole or not at all; returns the path.

    Raises:
        AgentError: it cannot be written.
    """
    temporary = path.with_name(f".{path.name}")
    try:
        made.savefig(temporary, format="png", dpi=110, metadata={"Software": None})
        temporary.replace(path)
    except OSError as error:
        raise AgentError(f"{path} cannot be written: {error.strerror}") from None
    return path
