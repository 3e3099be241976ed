# SPDX-License-Identifier: BSD-3-Clause
"""What vehicles look like follows from their airframes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sitl import vehicles
from sitl.vehicle.kinds import KINDS
from sitl.vehicles.airframe import apply
from sitl.view import kind
from sitl.view.shape import ROTOR, WHEEL, Mesh, Shape, box, cylinder, joined


def shape_of(name: str) -> tuple[Shape, Any]:
    airframe = vehicles.load(name)
    of = KINDS[airframe.kind]
    fleet = of.record.fleet(1)
    v = of.record.of(fleet, 0)
    apply(airframe, v)
    return kind.of(of).shape(v.physics.airframe), airframe


@pytest.mark.parametrize("mesh", [box((1, 2, 3), (4, 5, 6), 0.7), cylinder(0.5, 2.0), cylinder(0.5, 2.0, axis=1)])
def test_meshes_are_closed_and_face_outward(mesh: Mesh) -> None:
    edges = np.concatenate([mesh.faces[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    there = {(int(a), int(b)) for a, b in edges}
    assert len(there) == len(edges) and all((b, a) in there for a, b in there)
    a, b, c = (mesh.vertices[mesh.faces[:, k]].astype(float) for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0, "the volume is positive: no face looks inward"


def test_joined_meshes_keep_their_faces() -> None:
    one, two = box((1, 1, 1)), box((1, 1, 1), (5, 0, 0))
    both = joined(one, two)
    assert np.allclose(both.vertices[both.faces[len(one.faces) :]], two.vertices[two.faces])


@pytest.mark.parametrize("name", vehicles.names("copter"))
def test_a_copter_has_its_rotors_where_its_airframe_has_them(name: str) -> None:
    shape, airframe = shape_of(name)
    rotors = [piece for piece in shape.pieces if piece.turns == ROTOR]
    assert [piece.number for piece in rotors] == list(range(len(airframe.rotors)))
    for piece, rotor in zip(rotors, airframe.rotors, strict=True):
        assert piece.at[:2] == pytest.approx((rotor.x, -rotor.y)), "forward, left"
    lowest = min(float(piece.mesh.vertices[:, 2].min() + piece.at[2]) for piece in shape.pieces)
    assert lowest == pytest.approx(0.0, abs=0.03 * shape.size), "it stands on the ground"


@pytest.mark.parametrize("name", vehicles.names("rover"))
def test_a_rover_has_four_wheels_on_the_floor(name: str) -> None:
    shape, airframe = shape_of(name)
    wheels = [piece for piece in shape.pieces if piece.turns == WHEEL]
    assert len(wheels) == 4
    for wheel in wheels:
        assert wheel.at[2] - wheel.radius == pytest.approx(0.0)
        assert abs(wheel.at[1]) == pytest.approx(0.5 * airframe.value("track"))
    assert len({piece.name for piece in shape.pieces}) == len(shape.pieces)
