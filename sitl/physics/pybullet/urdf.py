# SPDX-License-Identifier: BSD-3-Clause
"""URDF text: links with shapes, and how Bullet reads it.

Format: https://wiki.ros.org/urdf/XML; ``contact`` is Bullet's addition (friction, spring and damper of a link's
contacts). Metres, kilograms, radians; forward, left, up.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace

from .client import Client, silence

Vector = tuple[float, float, float]
Colour = tuple[float, float, float, float]


@dataclass(frozen=True)
class Shape:
    """A shape at its position in a link."""

    geometry: str
    """The element."""
    centre: Vector
    yaw: float = 0.0
    colour: Colour | None = None

    def coloured(self, colour: Colour) -> Shape:
        """The same to be seen in a colour: red, green, blue, opacity, 0 .. 1."""
        return replace(self, colour=colour)

    def element(self, kind: str) -> str:
        """As a "collision" or a "visual"."""
        material = ""
        if kind == "visual" and self.colour is not None:
            rgba = _numbers(self.colour)
            material = f'<material name="{rgba.replace(" ", "_")}"><color rgba="{rgba}"/></material>'
        origin = f'<origin xyz="{_numbers(self.centre)}" rpy="0 0 {self.yaw!r}"/>'
        return f"    <{kind}>{origin}<geometry>{self.geometry}</geometry>{material}</{kind}>"


def box(size: Vector, centre: Vector, yaw: float = 0.0) -> Shape:
    """A box of full lengths ``size`` [m]."""
    return Shape(f'<box size="{_numbers(size)}"/>', centre, yaw)


def cylinder(radius: float, length: float, centre: Vector) -> Shape:
    """An upright cylinder [m]."""
    return Shape(f'<cylinder radius="{radius!r}" length="{length!r}"/>', centre)


def sphere(radius: float, centre: Vector) -> Shape:
    """A sphere [m]."""
    return Shape(f'<sphere radius="{radius!r}"/>', centre)


@dataclass(frozen=True)
class Contact:
    """How a link touches others."""

    friction: float = 0.0
    """Coulomb coefficient."""
    stiffness: float = 0.0
    """Of each contact point [N/m]; 0: hard."""
    damping: float = 0.0
    """Of each contact point [N s/m]."""

    def elements(self) -> str:
        """As URDF."""
        text = f'<lateral_friction value="{self.friction!r}"/>'
        if self.stiffness > 0.0:
            text += f'<stiffness value="{self.stiffness!r}"/><damping value="{self.damping!r}"/>'
        return text


def link(
    name: str,
    mass: float,
    inertia: Vector,
    collisions: Sequence[Shape],
    visuals: Sequence[Shape],
    contact: Contact = Contact(),
) -> str:
    """A link whose centre of mass is its origin.

    Args:
        name: of the link.
        mass: [kg].
        inertia: about its axes [kg m^2].
        collisions, visuals: shapes.
        contact: how it touches others.
    """
    xx, yy, zz = inertia
    rows = [
        f'  <link name="{name}">',
        f'    <inertial><mass value="{mass!r}"/>'
        f'<inertia ixx="{xx!r}" ixy="0" ixz="0" iyy="{yy!r}" iyz="0" izz="{zz!r}"/></inertial>',
        f"    <contact>{contact.elements()}</contact>",
        *(shape.element("visual") for shape in visuals),
        *(shape.element("collision") for shape in collisions),
        "  </link>",
    ]
    return "\n".join(rows)


def document(name: str, links: Sequence[str], fixed: Sequence[tuple[str, str]]) -> str:
    """A model: links, and pairs (parent, child) of them that are one piece."""
    joints = [
        f'  <joint name="{parent}_{child}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'
        for parent, child in fixed
    ]
    return "\n".join([f'<robot name="{name}">', *links, *joints, "</robot>", ""])


def load(client: Client, text: str, flags: int = 0) -> int:
    """Bullet's number of a model in a world.

    Args:
        client: the world.
        text: URDF.
        flags: pybullet's ``URDF_*``, added to "inertia from the text".
    """
    number, path = tempfile.mkstemp(suffix=".urdf")
    try:
        with os.fdopen(number, "w") as file:
            file.write(text)
        with silence():  # Bullet prints what it thinks of a model
            body: int = client.p.loadURDF(
                path, flags=client.p.URDF_USE_INERTIA_FROM_FILE | flags, physicsClientId=client.id
            )
    finally:
        os.unlink(path)
    return body


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
