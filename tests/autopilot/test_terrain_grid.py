# SPDX-License-Identifier: BSD-3-Clause
"""The grid of the terrain protocol."""

import math
import random

import pytest

from sitl.autopilot.terrain.grid import (
    NOTHING,
    PARTS,
    Block,
    around,
    between,
    block_of,
    height_of,
    measured,
    square_of,
)

LAT, LON = -353632620, 1491652370
SPACING = 100.0
PLACES = [(LAT, LON), (471234567, 85432109), (-1234, -5678), (10_000, -1_799_990_000), (700_000_001, 1_234_567_890)]


def slope(lat: float, lon: float) -> float:
    """A plane that rises to the north and falls to the east, about as steep everywhere."""
    return 5000.0 * (lat - round(lat)) - 3000.0 * (lon - round(lon)) * math.cos(math.radians(lat))


def whole(block: Block, height=slope):
    return tuple(measured(block, k, SPACING, height) for k in range(PARTS))


def test_blocks_lie_where_arducopter_asks_for_them():
    """Requests of ArduCopter 4.7 at this home, to a hundredth of a metre."""
    asked = [
        (-353747690, 1491548424), (-353963287, 1491238906), (-353963287, 1491548633), (-353963287, 1491858360),
        (-353747690, 1491238739), (-353747690, 1491858108), (-353532093, 1491238571), (-353532093, 1491548214),
        (-353532093, 1491857857),
    ]  # fmt: skip
    blocks = list(around(LAT, LON, SPACING))
    assert len(blocks) == 9
    for block, theirs in zip(blocks, asked, strict=True):
        assert block == pytest.approx(theirs, abs=1.5)


@pytest.mark.parametrize("lat, lon", PLACES)
def test_heights_are_those_that_were_told(lat, lon):
    rng = random.Random(lat)
    for _ in range(20):
        place = lat + rng.uniform(-1e4, 1e4), lon + rng.uniform(-1e4, 1e4)
        block = block_of(*place, SPACING)
        found = height_of({block: whole(block)}, *place, SPACING)
        assert found == pytest.approx(slope(place[0] * 1e-7, place[1] * 1e-7), abs=1.5)


def test_what_is_not_told_is_not_known():
    block = block_of(LAT, LON, SPACING)
    assert height_of({}, LAT, LON, SPACING) is None
    parts = list(whole(block))
    square = square_of({block: tuple(parts)}, LAT, LON, SPACING)
    assert square.corners is not None
    assert -SPACING <= square.north <= 0.0 and -SPACING <= square.east <= 0.0
    for k in range(PARTS):
        fewer = (*parts[:k], (), *parts[k + 1 :])
        known = height_of({block: fewer}, LAT, LON, SPACING) is not None
        assert known == (k != 26)  # row 12 // 4 of 7, column 9 // 4 of 8
    assert height_of({block: NOTHING}, LAT, LON, SPACING) is None


def test_a_part_is_known_whole_or_not_at_all():
    assert measured(Block(LAT, LON), 0, SPACING, lambda lat, lon: None if lon * 1e7 > LON + 1 else 7.4) is None
    assert measured(Block(LAT, LON), 0, SPACING, lambda lat, lon: 1e9) == (32767,) * 16


def test_a_way_has_the_blocks_that_it_crosses():
    end = LAT + 900_000, LON
    blocks = set(between(LAT, LON, *end, SPACING))
    assert block_of(*end, SPACING) in blocks
    assert {block_of(LAT + k * 50_000, LON, SPACING) for k in range(2, 19)} <= blocks
