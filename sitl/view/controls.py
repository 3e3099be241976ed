# SPDX-License-Identifier: BSD-3-Clause
"""The page's controls: what a pilot's ground station has, time, wind and faults, and parameters by name."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from typing import Any, TypeVar

from ..autopilot.params.parameter import Parameter
from ..run.pacing import MAX, StoppablePacing, parse_speedup
from ..simulation import Simulation
from ..vehicle.faults import FORM
from .frame import Stage
from .incoming import check_value
from .pilot_link import Pilot
from .sticks import Sticks

SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "5", "10", "50", "200", MAX)
_STEP_S = 0.1
_WIND = (
    ("SIM_WIND_SPD", "Wind [m/s]", 25.0), ("SIM_WIND_DIR", "From [deg]", 360.0), ("SIM_WIND_TURB", "Gusts [m/s]", 10.0),
)  # fmt: skip
_OFFERED = 60
"""Parameters in the list that a search gives."""

T = TypeVar("T")
Shift = Callable[[], Sequence[float]]
Chosen = Callable[[], T]
"""Gives what belongs to the vehicle that is chosen."""
Ask = Callable[[Callable[[], None], Any], None]
"""Lets something be done where the vehicle is, for the event of a click."""


class Controls:
    """The widgets, and what they ask for.

    Args:
        gui: of the page.
        scene: of viser, in which clicks mean positions.
        ask: lets something be done where the vehicle is.
        pilot: gives who does it: the one of the vehicle that is chosen.
        stage: what is shown.
        pace: of the run; None: its time cannot be stopped here.
        shift: how far the stage is moved (``cameras``) [m].
    """

    def __init__(
        self, gui: Any, scene: Any, ask: Ask, pilot: Chosen[Pilot], stage: Stage, pace: StoppablePacing | None,
        shift: Shift,
    ) -> None:  # fmt: skip
        self._ask, self._pilot, self._shift = ask, pilot, shift
        with gui.add_folder("Pilot"):
            self._add_pilot(gui, stage)
        with gui.add_folder("Sticks", expand_by_default=False):
            self.sticks = Sticks(gui, lambda axes: ask(lambda: pilot().hold(axes()), None), stage.flies)
        if pace is not None:
            with gui.add_folder("Time"):
                self._add_time(gui, pace, not stage.company)
        scene.on_click()(self._clicked)

    def _button(self, gui: Any, label: str, act: Callable[[], None], hint: str = "") -> Any:
        button = gui.add_button(label, hint=hint or None)
        button.on_click(lambda event: self._ask(act, event))
        return button

    def _add_pilot(self, gui: Any, stage: Stage) -> None:
        pilot = self._pilot
        self.arm = self._button(gui, "Arm", lambda: pilot().arm())
        self.disarm = self._button(gui, "Disarm", lambda: pilot().disarm())
        if stage.flies:
            self.height = gui.add_number("Height", 10.0, min=0.5, max=500.0, step=0.5, hint="above home [m]")
            self.take_off = self._button(gui, "Take off", lambda: pilot().take_off(number(self.height)))
        self.mode = gui.add_dropdown("Mode", stage.modes, initial_value=stage.modes[0])
        self.set_mode = self._button(gui, "Set mode", lambda: pilot().set_mode(self.mode.value))
        self.clicks = gui.add_checkbox("Click on the ground to go there", True, hint="GUIDED, at the present height")

    def _add_time(self, gui: Any, pace: StoppablePacing, is_alone: bool) -> None:
        now = "1" if pace.speedup == 1.0 else MAX if pace.speedup is None else f"{pace.speedup:g}"
        speeds = SPEEDS if now in SPEEDS else (now, *SPEEDS)
        self.speed = gui.add_dropdown("Speed", speeds, initial_value=now, hint="simulated seconds a second")

        def set_speed() -> None:
            pace.set_speedup(parse_speedup(self.speed.value))

        self.speed.on_update(lambda event: self._ask(set_speed, event))
        self.pause = self._button(gui, "Stop time", pace.stop)
        self.go_on = self._button(gui, "Go on", pace.go_on)
        self.step_s = gui.add_number("Step", _STEP_S, min=0.0025, max=60.0, step=0.0025, hint="[s]")
        self.step = self._button(gui, "One step", lambda: pace.step(round(number(self.step_s) * 1e6)))
        if is_alone:  # a snapshot is of one vehicle: those that share its world would be at another time
            self._add_snapshot(gui)

    def _add_snapshot(self, gui: Any) -> None:
        self.keep = self._button(gui, "Keep this moment", lambda: self._pilot().keep())
        self.go_back = self._button(gui, "Back to it", lambda: self._pilot().go_back())

    def _clicked(self, event: Any) -> None:
        shift = tuple(self._shift())

        def go() -> None:
            origin = [at - moved for at, moved in zip(event.ray_origin, shift, strict=True)]
            position = on_ground(origin, event.ray_direction)
            if position is not None:
                self._pilot().go_to(*position)

        if self.clicks.value:
            self._ask(go, event)


class ParameterControls:
    """Parameters, searched by part of their name or meaning; wind and faults, which are some of them.

    Args:
        gui: of the page.
        simulation: gives whose table it is; values are read where the vehicle is.
        ask, pilot: as of ``Controls``.
        may_set: False: they are only shown.
    """

    def __init__(self, gui: Any, simulation: Chosen[Simulation], ask: Ask, pilot: Chosen[Pilot], may_set: bool) -> None:
        self._simulation, self._ask, self._pilot = simulation, ask, pilot
        self.search = gui.add_text("Search", "", hint="part of a name or of a meaning")
        self.choice = gui.add_dropdown("Parameter", ("-",))
        self.about = gui.add_html("")
        self.value = gui.add_number("Value", 0.0, step=0.0001, disabled=not may_set)
        self.search.on_update(lambda event: self._offer())
        self.choice.on_update(lambda event: self._ask(self._read, event))
        if may_set:
            self.set = gui.add_button("Set it")
            self.set.on_click(lambda event: self._ask(self._set, event))

    def _offer(self) -> None:
        table = tuple(self._simulation().firmware.table)
        self.choice.options = tuple(p.name for p in found(table, self.search.value)) or ("-",)

    def _read(self) -> None:
        name, simulation = self.choice.value, self._simulation()
        if name in simulation.firmware.table:
            parameter, value = simulation.firmware.table[name], float(simulation.parameters[name])
            self.value.value = value
            self.about.content = describe(parameter, value)

    def _set(self) -> None:
        self._pilot().set_parameter(self.choice.value, number(self.value))


class Weather:
    """Wind, and what fails."""

    def __init__(self, gui: Any, simulation: Simulation, ask: Ask, pilot: Chosen[Pilot]) -> None:
        self.sliders = {}
        for name, label, high in _WIND:
            now = min(float(simulation.parameters[name]), high)
            slider = gui.add_slider(label, min=0.0, max=high, step=0.1, initial_value=now, hint=name)
            slider.on_update(_setter(ask, pilot, name))
            self.sliders[name] = slider
        self.fault = gui.add_text("Fault", "gps", hint=f"{FORM}, sitl help faults")
        self.fail = gui.add_button("Let it fail")
        self.fail.on_click(lambda event: ask(lambda: pilot().fail(self.fault.value), event))
        self.repair = gui.add_button("Repair all")
        self.repair.on_click(lambda event: ask(lambda: pilot().repair(), event))


def _setter(ask: Ask, pilot: Chosen[Pilot], name: str) -> Callable[[Any], None]:
    return lambda event: ask(lambda: pilot().set_parameter(name, number(event.target)), event)


def number(widget: Any) -> float:
    """The value of a widget for numbers.

    Raises:
        OptionError: it is not one that the widget takes.
    """
    check_value(widget, widget.value)
    return float(widget.value)


def on_ground(origin: Sequence[float], direction: Sequence[float]) -> tuple[float, float] | None:
    """North, east [m] where a ray of the scene meets the ground; None: it goes to the sky."""
    if not all(map(math.isfinite, (*origin, *direction))):
        return None
    if direction[2] >= -1e-6 or origin[2] <= 0.0:
        return None
    share = -origin[2] / direction[2]
    return (float(origin[0] + share * direction[0]), -float(origin[1] + share * direction[1]))


def found(parameters: Sequence[Parameter], text: str) -> list[Parameter]:
    """Parameters that have all words of a search in name or meaning; those whose name begins with it come first."""
    words = text.strip().lower().split()
    if not words:
        return []
    hits = [p for p in parameters if all(word in f"{p.name} {p.doc}".lower() for word in words)]
    first = words[0]
    hits.sort(key=lambda p: (not p.name.lower().startswith(first), first not in p.name.lower(), not p.has_effect))
    return hits[:_OFFERED]


def describe(p: Parameter, value: float) -> str:
    """A parameter's meaning, range, default and value as HTML."""
    unit = f" {p.unit}" if p.unit else ""
    limits = f"{p.low:g} .. {p.high:g}{unit}" if p.low > -1e9 or p.high < 1e9 else "any number"
    effect = "" if p.has_effect or p.doc else "<div>It has no effect here.</div>"
    return (
        f'<div style="font-size:0.8em;padding:0 0.6em"><b>{escape(p.name)}</b> = {value:g}{escape(unit)}'
        f"<div>{escape(p.doc)}</div>"
        f'<div style="color:#888">range {escape(limits)}, default {p.default:g}</div>{effect}</div>'
    )
