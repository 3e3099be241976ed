# SPDX-License-Identifier: BSD-3-Clause
"""A JSBSim aircraft: what all vehicles have, and the parts of a kind put together.

JSBSim's structural frame points aft, right and up; here it has its origin at the centre of mass.

The planet is a sphere of the earth's size that does not turn. The vehicle's world lies at latitude and longitude 0,
where numbers are finest, and its floor is at sea level. Gravity there is 9.80665 m/s^2, which is what the autopilot
takes for granted; it decreases by 3e-4 m/s^2 in 100 m. A turning earth would add up to 1.5e-4 m/s^2 for each m/s of
speed, which neither the autopilot nor the other engines know of.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ...core.constants import GRAVITY
from .model import FOOT, POUND, POUNDS_BY_SLUG, SLUG, SLUG_FOOT2

RADIUS = 6_371_000.0
"""Of the planet [m]."""


@dataclass(frozen=True)
class Contact:
    """A point that touches the ground: a spring with damping, and friction."""

    name: str
    at: tuple[float, float, float]
    """Body frame, from the centre of mass [m]."""
    stiffness: float
    """[N/m]"""
    damping: float
    """[N s/m]"""
    friction: float
    """Coulomb coefficient."""
    is_wheel: bool = False
    """Rolls freely along the body; across it, friction holds."""
    scrubs: bool = False
    """A wheel that every turn makes slide sideways: what it holds goes with its slip angle, by JSBSim's formula
    (Pacejka's), so that a small difference of the sides' speeds turns the vehicle. Others hold at any angle."""
    steers: bool = False
    """By its property ``fcs/steer-pos-deg[k]``."""

    def written(self) -> str:
        """As XML."""
        x, y, z = self.at
        full = 80.0 if self.steers else 0.0
        grip = ""
        if self.is_wheel and not self.scrubs:
            # By the formula there is no grip at slip angle 0: a stiff tyre would hold in every other frame only.
            data = f"<tableData>-90 {self.friction!r}\n90 {self.friction!r}</tableData>"
            grip = f'<table name="CORNERING_COEFF" type="internal">{data}</table>'
        return (
            f'<contact type="{"BOGEY" if self.is_wheel else "STRUCTURE"}" name="{self.name}">'
            f"{location(x, y, z)}<static_friction>{self.friction!r}</static_friction>"
            f"<dynamic_friction>{self.friction!r}</dynamic_friction><rolling_friction>0</rolling_friction>"
            f'<spring_coeff unit="LBS/FT">{self.stiffness * FOOT / POUND!r}</spring_coeff>'
            f'<damping_coeff unit="LBS/FT/SEC">{self.damping * FOOT / POUND!r}</damping_coeff>'
            f'<max_steer unit="DEG">{full}</max_steer><brake_group>NONE</brake_group><retractable>0</retractable>'
            f"{grip}</contact>"
        )


def location(x: float, y: float, z: float) -> str:
    """A position given in the body frame [m] in the structural one."""
    return f'<location unit="FT"><x>{-x / FOOT!r}</x><y>{y / FOOT!r}</y><z>{-z / FOOT!r}</z></location>'


def planet() -> str:
    """The planet."""
    radius = RADIUS / FOOT
    return (
        f'<planet name="still"><semimajor_axis unit="FT">{radius!r}</semimajor_axis>'
        f'<semiminor_axis unit="FT">{radius!r}</semiminor_axis><rotation_rate unit="RAD/SEC">0</rotation_rate>'
        f'<GM unit="FT3/SEC2">{GRAVITY / FOOT * radius * radius!r}</GM><J2>0</J2></planet>'
    )


def mass_balance(a: Any) -> str:
    """Mass and inertia of a vehicle's properties."""
    named = zip(("ixx", "iyy", "izz"), a.inertia, strict=True)
    moments = "".join(f'<{name} unit="SLUG*FT2">{value / SLUG_FOOT2!r}</{name}>' for name, value in named)
    weight = float(a.mass) / SLUG * POUNDS_BY_SLUG
    origin = location(0.0, 0.0, 0.0).replace("<location", '<location name="CG"')
    return f'<mass_balance>{moments}<emptywt unit="LBS">{weight!r}</emptywt>{origin}</mass_balance>'


def written(a: Any, name: str, span: float, contacts: Iterable[Contact], parts: str) -> str:
    """The whole document.

    Args:
        a: the vehicle's properties (``physics.airframe`` of a record).
        name: of the aircraft.
        span: the size that turbulence takes it for [m].
        contacts: what touches the ground.
        parts: systems, external reactions and aerodynamics.
    """
    reference = location(0.0, 0.0, 0.0).replace("<location", '<location name="AERORP"')
    feet = "".join(contact.written() for contact in contacts)
    return (
        f'<?xml version="1.0"?>\n<fdm_config name="{name}" version="2.0" release="BETA">'
        f"<fileheader><author>gym-sitl</author><description>{name}</description></fileheader>{planet()}"
        f'<metrics><wingarea unit="FT2">1</wingarea><wingspan unit="FT">{span / FOOT!r}</wingspan>'
        f'<chord unit="FT">1</chord>{reference}</metrics>{mass_balance(a)}'
        f"<ground_reactions>{feet}</ground_reactions>{parts}</fdm_config>\n"
    )
