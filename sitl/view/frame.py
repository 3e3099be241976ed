# SPDX-License-Identifier: BSD-3-Clause
"""What a page shows of one vehicle: a stage that stays, and a frame for each moment.

Positions are NED metres from the scene's origin, which is the physics': the home ground point, or the origin of the
world. Quaternions turn the body (FRD) to NED. The page turns both into its own axes (``axes``).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ..core.vectors import Quat, Vec3
from ..worlds import World
from .shape import Shape

CALM = Vec3(0.0, 0.0, 0.0)
Points = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stage:
    """What does not change while a vehicle is shown."""

    title: str
    """Name of the airframe, or of the flight."""
    shape: Shape
    world: World | None = None
    """Solids around it; None: a plain."""
    modes: tuple[str, ...] = ()
    """Names of all modes, those that a client can ask for."""
    flies: bool = True
    """It can leave the ground."""
    company: tuple[Shape, ...] = ()
    """Shape of each vehicle, where there are several; the first frame's chosen one is ``shape``."""
    copies: Points | None = None
    """Positions at which the world stands, in the scene's axes [m], shape (n, 3); None: once, at the origin."""


@dataclass(frozen=True, eq=False)
class Mark:
    """A position with a name."""

    name: str
    position: Vec3
    """NED [m]."""
    number: int = 0
    """Of the mission's item."""


@dataclass(frozen=True, eq=False)
class Plan:
    """Where the vehicle is to go, and where it must not."""

    items: tuple[Mark, ...] = ()
    """The mission's items that have a position, in their order."""
    fences: tuple[Points, ...] = ()
    """Closed outlines, each of shape (n, 2): north, east [m]."""
    fence_top: float = 0.0
    """Height to which outlines are drawn, above the scene's origin [m]."""
    rally: tuple[Mark, ...] = ()


@dataclass(frozen=True, eq=False)
class Text:
    """A text of the vehicle for its pilot."""

    time_us: int
    severity: int
    """MAV_SEVERITY: 0 emergency .. 7 debug."""
    text: str


@dataclass(frozen=True, eq=False)
class Company:
    """All vehicles of a page that shows several, at one moment."""

    pos: Points
    """NED [m], shape (n, 3)."""
    q: Points
    """Body to NED, shape (n, 4)."""
    chosen: int = 0
    """The vehicle that the frame is of."""
    notes: tuple[str, ...] = ()
    """System, mode and arming of each; empty: only the chosen one's are known."""


VEHICLE, LOG = "vehicle", "log"
"""Whose numbers ``Reported`` has: what the vehicle says now, or what a log kept of it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Reported:
    """A vehicle's own numbers, as a ground station shows them. Fields that it does not report (yet) are None."""

    by: str = VEHICLE
    """VEHICLE or LOG."""
    height: float | None = None
    """Above home (GLOBAL_POSITION_INT.relative_alt) [m]."""
    position: tuple[float, float] | None = None
    """North, east of its origin (LOCAL_POSITION_NED), in a log of home [m]."""
    speed: float | None = None
    """Over the ground (VFR_HUD.groundspeed) [m/s]."""
    climb: float | None = None
    """VFR_HUD.climb [m/s]"""
    heading: float | None = None
    """VFR_HUD.heading [deg]"""
    roll: float = 0.0
    """ATTITUDE [rad]"""
    pitch: float = 0.0
    """ATTITUDE [rad]"""


@dataclass(frozen=True, eq=False, kw_only=True)
class Frame:
    """A vehicle at one moment. Position, attitude and motion are the truth, but for flights of logs."""

    time_us: int
    """Simulated time since the start of the simulation [us]."""
    pos: Vec3
    q: Quat
    vel: Vec3
    """NED [m/s]"""
    world: World | None = None
    """What is around it now; None: the stage's."""
    stands: Vec3 = CALM
    """Where the origin of its own world is in the scene [m]."""
    estimate_pos: Vec3 | None = None
    """Where its estimator believes it to be; None: nowhere yet."""
    estimate_q: Quat | None = None
    set_point: Vec3 | None = None
    """Position that the controllers follow now."""
    leg: tuple[Vec3, Vec3] | None = None
    """Both ends of the leg under way."""
    home: Vec3 | None = None
    mode: str = ""
    armed: bool = False
    ready: bool = False
    """The arming checks find nothing."""
    unready: tuple[str, ...] = ()
    """What they find, as the texts after "PreArm: " say it."""
    reported: Reported | None = None
    """What the vehicle says of itself; None: there is no autopilot that says anything."""
    voltage: float = 0.0
    """[V]"""
    current: float = 0.0
    """[A]"""
    charge_left: float = 0.0
    """[%]"""
    satellites: int = 0
    fix: int = 0
    """GPS_FIX_TYPE: 3 and more is a position."""
    failsafes: tuple[str, ...] = ()
    """Those that are on, and fences that are breached."""
    mission_current: int = 0
    rotors: tuple[float, ...] = ()
    """Speeds, those that turn counter-clockwise seen from above positive [rad/s]."""
    steering: float = 0.0
    """Of the front wheels, to the right [rad]."""
    rolled: tuple[float, float] = (0.0, 0.0)
    """By the left and right wheels [m]."""
    touching: bool = False
    """A solid."""
    hits: int = 0
    """Impacts so far, on solids and on the ground."""
    hit_speed: float = 0.0
    """Of the last one [m/s]."""
    scan: Points | None = None
    """What the lidar has met, on the body, forward, right, down [m], shape (n, 3); the same object until the next."""
    wind: Vec3 = CALM
    """Where the air goes, NED [m/s]."""
    plan: Plan = field(default_factory=Plan)
    """The same object until it changes."""
    texts: tuple[Text, ...] = ()
    """Since the frame before."""
    signals: dict[str, float] = field(default_factory=dict)
    """Values of the signals that are plotted."""
    company: Company | None = None
    """All vehicles, this one too; None: it is alone."""
    facts: tuple[tuple[str, str], ...] = ()
    """Names and texts that the state shows instead of an autopilot's."""


class Source(Protocol):
    """Where frames come from. ``capture`` is called where the vehicle is, ``frame`` where the page is drawn."""

    stage: Stage

    def capture(self) -> Any:
        """All that the next frame needs, as it is now: a copy, quickly made."""

    def frame(self, captured: Any) -> Frame:
        """The frame of what was captured."""

    def signal_names(self) -> list[str]:
        """What can be plotted, by name."""

    def choose_signals(self, names: tuple[str, ...]) -> None:
        """Frames have these signals from now on."""


class CompanyOfSources(Source, Protocol):
    """Frames of several vehicles."""

    def choose(self, number: int) -> None:
        """Show another one in full from the next frame on."""
