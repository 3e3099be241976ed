# SPDX-License-Identifier: BSD-3-Clause
"""The instruments beside the scene: state, horizon, texts."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from html import escape
from typing import Any

from ..core.algebra import euler_of
from . import horizon
from .colours import css, of_mode, of_severity, of_vehicle
from .frame import Company, Frame, Reported, Text
from .horizon import degrees, number, true_height

_KEPT_TEXTS = 40
_FIXES = ("no GPS", "no fix", "2D", "3D", "3D DGPS", "RTK float", "RTK fixed")


class Panel:
    """The instruments."""

    def __init__(self, gui: Any) -> None:
        self._company = gui.add_html("")
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
    def company_html(self) -> str:
        """What is shown of all vehicles, where there are several."""
        return str(self._company.content)

    @property
    def texts(self) -> list[str]:
        """Texts that are shown, oldest first."""
        return [each.text for each in self._kept]

    def show(self, frame: Frame, speed: str) -> None:
        """Show a moment; ``speed``: how fast simulated time goes."""
        if frame.company is not None:
            self._company.content = company(frame.company)
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


_LISTED = 32
"""Vehicles that are listed, at most."""


def company(vehicles: Company) -> str:
    """Each of several vehicles in its colour, the chosen one in bold type."""
    rows = []
    for k in range(len(vehicles.pos)) if vehicles.notes and len(vehicles.pos) <= _LISTED else (vehicles.chosen,):
        north, east, down = vehicles.pos[k].tolist()
        weight = "bold" if k == vehicles.chosen else "normal"
        note = (
            f"{vehicles.notes[k]}; truth: {number(-down, 1, 'm')} high, {_position((north, east))}"
            if vehicles.notes
            else ""
        )
        rows.append(
            f'<div style="font-weight:{weight}"><span style="color:{css(of_vehicle(k))}">&#9632;</span> '
            f"<b>{k + 1}</b> {escape(note)}</div>"
        )
    return f'<div style="{_LIST}">{"".join(rows)}</div>'


def state(frame: Frame, speed: str) -> str:
    """The state as HTML: what the vehicle is doing, and what is wrong."""
    armed = _badge("ARMED", "#c0392b") if frame.armed else _badge("disarmed", "#27ae60" if frame.ready else "#7f8c8d")
    if frame.facts:
        return f'<div style="padding:0.4em 0.6em 0.2em">{_badge(frame.mode, "#2e86de")}{_grid(frame.facts)}</div>'
    mode = _badge(frame.mode or "-", css(of_mode(frame.mode)))
    ready = "" if frame.armed or frame.ready or frame.reported is None else _unready(frame)
    fix = _FIXES[min(frame.fix, len(_FIXES) - 1)]
    error = "-"
    if frame.estimate_pos is not None:
        error = f"{math.dist(frame.estimate_pos, frame.pos):.2f} m"
    wind = math.hypot(frame.wind.x, frame.wind.y)
    calls = math.degrees(math.atan2(-frame.wind.y, -frame.wind.x)) % 360.0
    cells = [
        ("time", f"{frame.time_us * 1e-6:.1f} s"), ("speed of time", speed),
        ("battery (vehicle)", f"{frame.voltage:.1f} V, {frame.charge_left:.0f} %"),
        ("current (vehicle)", f"{frame.current:.1f} A"),
        ("GPS (vehicle)", f"{fix}, {frame.satellites} sat"), ("item (vehicle)", str(frame.mission_current)),
        ("wind (truth)", f"{wind:.1f} m/s from {calls:.0f}°" if wind > 0.05 else "none"),
        ("impacts (truth)", f"{frame.hits}, last {frame.hit_speed:.1f} m/s" if frame.hits else "none"),
        ("estimate's error", error),
    ]  # fmt: skip
    touching = ("touches a solid",) if frame.touching else ()
    alarms = "".join(_badge(name, "#c0392b") for name in (*frame.failsafes, *touching))
    return f'<div style="padding:0.4em 0.6em 0.2em">{mode}{armed}{alarms}{ready}{motion(frame)}{_grid(cells)}</div>'


def _unready(frame: Frame) -> str:
    """Why it cannot be armed."""
    reasons = "; ".join(frame.unready)
    text = f"not ready to arm: {reasons}" if reasons else "not ready to arm"
    return f'<div style="color:#b9770e;font-size:0.85em;margin-top:0.3em">{escape(text)}</div>'


def motion(frame: Frame) -> str:
    """Height, position, speeds and heading as HTML: what the vehicle says, and the truth beside it."""
    reported = frame.reported or Reported()
    north, east, _ = frame.pos - frame.stands
    rows = [
        ("height", number(reported.height, 2, "m"), number(true_height(frame), 2, "m")),
        ("position", _position(reported.position), _position((north, east))),
        ("ground speed", number(reported.speed, 1, "m/s"), number(math.hypot(frame.vel.x, frame.vel.y), 1, "m/s")),
        ("climb", number(reported.climb, 1, "m/s"), number(-frame.vel.z, 1, "m/s")),
        ("heading", degrees(reported.heading), degrees(math.degrees(euler_of(frame.q).yaw) % 360.0)),
    ]  # fmt: skip
    cells = "".join(
        f'<div style="color:#888">{name}</div><div>{escape(vehicle)}</div><div>{escape(true)}</div>'
        for name, vehicle, true in rows
    )
    heads = "".join(f'<div style="color:#888" title="{hint}">{name}</div>' for name, hint in _COLUMNS)
    return (
        '<div style="display:grid;grid-template-columns:auto 1fr 1fr;gap:0.1em 0.7em;font-size:0.78em;'
        f'margin-top:0.5em">{heads}{cells}</div>'
    )


_COLUMNS = (
    ("", ""), ("vehicle says", "as a ground station shows it: above home, from its origin"),
    ("truth", "of the simulation: above and from the position where its world begins"),
)  # fmt: skip


def _position(position: tuple[float, float] | None) -> str:
    return "-" if position is None else f"{number(position[0], 1, 'N')}, {number(position[1], 1, 'E')}"


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
