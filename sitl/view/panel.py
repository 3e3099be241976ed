# SPDX-License-Identifier: BSD-3-Clause
"""The instruments beside the scene: state, horizon, texts."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from html import escape
from typing import Any

from . import horizon
from .colours import css, of_mode, of_severity
from .frame import Frame, Text

_KEPT_TEXTS = 40
_FIXES = ("no GPS", "no fix", "2D", "3D", "3D DGPS", "RTK float", "RTK fixed")


class Panel:
    """The instruments."""

    def __init__(self, gui: Any) -> None:
        self._state = gui.add_html("")
        self._horizon = gui.add_html("")
        with gui.add_folder("Texts"):
            self._texts = gui.add_html("")
        self._kept: deque[Text] = deque(maxlen=_KEPT_TEXTS)

    @property
    def state_html(self) -> str:
        """What the state shows now."""
        return str(self._state.content)

    @property
    def texts(self) -> list[str]:
        """Texts that are shown, oldest first."""
        return [each.text for each in self._kept]

    def show(self, frame: Frame, speed: str) -> None:
        """Show a moment; ``speed``: how fast simulated time goes."""
        self._state.content = state(frame, speed)
        self._horizon.content = f'<div style="padding:0 0.6em">{horizon.draw(frame)}</div>'

    def show_texts(self, texts: tuple[Text, ...]) -> None:
        """Add texts."""
        if texts:
            self._kept.extend(texts)
            rows = "".join(map(_row, reversed(self._kept)))
            self._texts.content = f'<div style="{_LIST}">{rows}</div>'


_LIST = "font-size:0.78em;line-height:1.5;max-height:13em;overflow-y:auto;padding:0 0.6em"


def _row(text: Text) -> str:
    colour = of_severity(text.severity)
    return (
        f'<div><span style="color:#888">{text.time_us * 1e-6:8.1f}</span> '
        f'<span style="color:{colour}">{escape(text.text)}</span></div>'
    )


def state(frame: Frame, speed: str) -> str:
    """The state as HTML: what the vehicle is doing, and what is wrong."""
    armed = _badge("ARMED", "#c0392b") if frame.armed else _badge("disarmed", "#27ae60" if frame.ready else "#7f8c8d")
    if frame.facts:
        return f'<div style="padding:0.4em 0.6em 0.2em">{_badge(frame.mode, "#2e86de")}{_grid(frame.facts)}</div>'
    mode = _badge(frame.mode or "-", css(of_mode(frame.mode)))
    ready = "" if frame.armed or frame.ready else '<span style="color:#888">not ready to arm</span>'
    fix = _FIXES[min(frame.fix, len(_FIXES) - 1)]
    error = "-"
    if frame.estimate_pos is not None:
        error = f"{math.dist(frame.estimate_pos, frame.pos):.2f} m"
    north, east, _ = frame.pos - frame.stands
    wind = math.hypot(frame.wind.x, frame.wind.y)
    calls = math.degrees(math.atan2(-frame.wind.y, -frame.wind.x)) % 360.0
    cells = [
        ("time", f"{frame.time_us * 1e-6:.1f} s"), ("speed of time", speed),
        ("battery", f"{frame.voltage:.1f} V, {frame.charge_left:.0f} %"), ("current", f"{frame.current:.1f} A"),
        ("GPS", f"{fix}, {frame.satellites} sat"), ("estimate's error", error),
        ("place", f"{north:.1f} N, {east:.1f} E"), ("climb", f"{-frame.vel.z:.1f} m/s"),
        ("wind", f"{wind:.1f} m/s from {calls:.0f}°" if wind > 0.05 else "none"), ("item", str(frame.mission_current)),
        ("impacts", f"{frame.hits}, last {frame.hit_speed:.1f} m/s" if frame.hits else "none"),
    ]  # fmt: skip
    touching = ("touches a solid",) if frame.touching else ()
    alarms = "".join(_badge(name, "#c0392b") for name in (*frame.failsafes, *touching))
    return f'<div style="padding:0.4em 0.6em 0.2em">{mode}{armed}{ready}{alarms}{_grid(cells)}</div>'


def _grid(cells: Sequence[tuple[str, str]]) -> str:
    rows = "".join(f'<div style="color:#888">{escape(name)}</div><div>{escape(value)}</div>' for name, value in cells)
    return (
        '<div style="display:grid;grid-template-columns:auto 1fr auto 1fr;gap:0.1em 0.7em;font-size:0.78em;'
        f'margin-top:0.5em">{rows}</div>'
    )


def _badge(text: str, colour: str) -> str:
    return (
        f'<span style="background:{colour};color:#fff;border-radius:4px;padding:0.1em 0.5em;margin-right:0.4em;'
        f'font-weight:600;font-size:0.85em">{escape(text)}</span>'
    )
