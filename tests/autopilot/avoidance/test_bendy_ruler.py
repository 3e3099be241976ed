# SPDX-License-Identifier: BSD-3-Clause
"""BendyRuler beside a real ArduPilot's looks (its log's OABR), and what is its own; the database of objects."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.avoidance import bendy_ruler, objects
from sitl.autopilot.avoidance.bendy_ruler import BENDY_RULER_LOOKED
from sitl.autopilot.avoidance.state import OBJECTS
from sitl.autopilot.fence.state import AREAS, STAY_OUT
from sitl.autopilot.navigation.state import BENT, ENDED, STRAIGHT
from sitl.autopilot.rover.state import Autopilot
from sitl.core.algebra import ZERO, quat_from_euler
from sitl.core.vectors import Euler, Vec2, Vec3
from tests.autopilot.avoidance.test_shortest_path import Area, box, fence

BOX = box(STAY_OUT, 50.0, 2.0, 10.0, 10.0)
NORTH = Vec3(100.0, 0.0, 0.0)
SECOND = 1_000_000


def pilot(*areas: Area, **values: float) -> Autopilot:
    """An autopilot at its origin, looking north, with a fence."""
    ap = Autopilot()
    oa, params = ap.params.OA, ap.params.FENCE
    oa.TYPE, oa.MARGIN_MAX, params.TYPE, params.MARGIN = 1.0, 5.0, float(AREAS), 2.0
    oa.BR.LOOKAHEAD, oa.BR.CONT_RATIO, oa.BR.CONT_ANGLE = 15.0, 1.5, 75.0
    oa.DB.SIZE, oa.DB.EXPIRE, oa.DB.BEAM_WIDTH, oa.DB.RADIUS_MIN = 100.0, 10.0, 5.0, 0.01
    for name, value in values.items():
        group, _, field = name.partition("_")
        setattr({"BR": oa.BR, "DB": oa.DB}[group], field, value)
    ap.fence = fence(*areas)
    ap.fence.on = AREAS
    ap.estimate.position_ok = True
    ap.estimate.q = quat_from_euler(Euler(0.0, 0.0, 0.0))
    return ap


def look(
    ap: Autopilot, pos: tuple[float, float], vel: tuple[float, float], destination: Vec3, upright: bool = False
) -> tuple[float, int]:
    """One look; the margin and how it steers."""
    ap.estimate.pos, ap.estimate.vel = Vec3(*pos, 0.0), Vec3(*vel, 0.0)
    ap.modes.nav.target = destination
    count = ap.events.count
    bendy_ruler.plan(ap, ap.modes.nav.current.origin, destination, upright, SECOND)
    found = [k for k in range(count, ap.events.count) if ap.events.code[k] == BENDY_RULER_LOOKED]
    return float(ap.events.a[found[0]]), int(ap.events.b[found[0]])


REAL = (
    # position, velocity; it steers, margin, target, of the real one; the third is of how far it looks
    ((0.0, 0.0), (0.0, 0.0), False, 30.52, (7.5, 0.0), 7.5),
    ((6.2, 0.0), (3.77, -0.01), False, 20.84, (17.2, 0.0), 11.0),
    ((10.55, -0.1), (4.77, -0.02), True, 15.37, (22.6, -0.1), 12.08),
    ((15.45, -0.1), (4.88, -0.03), True, 11.08, (26.9, -6.7), 13.3),
    ((23.6, -1.2), (2.88, -1.29), True, 5.99, (33.4, -12.5), 15.0),
    ((31.0, -7.7), (2.01, -2.80), True, 5.06, (39.9, -19.8), 15.0),
    ((35.3, -13.5), (1.95, -2.72), True, 5.06, (48.5, -20.6), 15.0),
    ((52.1, -17.8), (3.35, 0.88), True, 5.37, (66.6, -13.8), 15.0),
    ((58.9, -16.0), (3.25, 0.88), False, 5.11, (72.9, -10.6), 15.0),
    ((92.2, -3.3), (4.36, 1.79), False, 30.16, (100.0, 0.0), 15.0),
)
"""A rover that the real one drove from home to 100 m north, past the box."""


@pytest.mark.parametrize(("pos", "vel", "steers", "margin", "target", "reach"), REAL)
def test_a_look_finds_what_the_real_one_finds(
    pos: tuple[float, float], vel: tuple[float, float], steers: bool, margin: float, target: tuple[float, float],
    reach: float,
) -> None:  # fmt: skip
    ap = pilot(BOX)
    ap.modes.nav.detour.lookahead = reach
    found, how = look(ap, pos, vel, NORTH)
    aim = ap.modes.nav.detour.bent_target
    assert (found, bool(how & 1)) == (pytest.approx(margin, abs=0.1), steers)
    assert math.dist((aim.x, aim.y), target) < 0.25
    assert ap.modes.nav.detour.bend == (BENT if steers else STRAIGHT)


def test_areas_may_have_a_margin_of_their_own() -> None:
    ap = pilot(BOX)
    before, _ = look(ap, (0.0, 0.0), (0.0, 0.0), NORTH)
    ap = pilot(BOX)
    ap.params.FENCE.MARGIN_XY = 6.0
    assert look(ap, (0.0, 0.0), (0.0, 0.0), NORTH)[0] == pytest.approx(before - 4.0)


def test_it_looks_further_while_the_way_is_free_and_less_far_while_none_is() -> None:
    ap = pilot(box(STAY_OUT, 0.0, 0.0, 30.0, 30.0))
    for _ in range(12):
        look(ap, (0.0, 0.0), (0.0, 0.0), NORTH)
    assert ap.modes.nav.detour.lookahead == 7.5
    ap.fence = fence()
    for n in range(1, 4):
        look(ap, (0.0, 0.0), (0.0, 0.0), NORTH)
        assert ap.modes.nav.detour.lookahead == pytest.approx(7.5 * 1.1**n)


def test_a_great_change_of_bearing_must_gain_enough() -> None:
    def bearing(**values: float) -> tuple[float, int]:
        ap = pilot(box(STAY_OUT, 20.0, -1.0, 3.0, 14.0), **values)
        detour = ap.modes.nav.detour
        detour.lookahead, detour.bearing, detour.bent_from = 15.0, math.radians(88.0), Vec2(100.0, 0.0)
        _, how = look(ap, (0.0, 0.0), (3.0, 0.0), NORTH)
        return math.degrees(math.atan2(detour.bent_target.y, detour.bent_target.x)), how

    freely, how = bearing(BR_CONT_RATIO=0.0, BR_CONT_ANGLE=10.0)
    assert freely < 75.0 and how == 1
    assert bearing(BR_CONT_ANGLE=10.0) == (pytest.approx(88.0), 3)


def test_the_end_of_a_bend_asks_for_a_leg() -> None:
    ap = pilot(BOX)
    ap.modes.nav.detour.bend = BENT
    look(ap, (80.0, 0.0), (3.0, 0.0), NORTH)
    assert ap.modes.nav.detour.bend == ENDED and ap.events.attention


def test_over_an_object_when_that_is_asked_for() -> None:
    ap = pilot()
    ap.params.FENCE.TYPE = 0.0
    ap.modes.nav.detour.lookahead = 15.0
    objects.note(ap.objects, Vec3(10.0, 0.0, 0.0), 10.0, ZERO, SECOND, ap.params.OA.DB)
    assert look(ap, (0.0, 0.0), (3.0, 0.0), NORTH, upright=True)[1] == 1
    assert ap.modes.nav.detour.bent_target.z == pytest.approx(-100.0)


def test_an_object_is_renewed_and_forgotten() -> None:
    ap = pilot()
    db, known = ap.params.OA.DB, ap.objects
    for time_us in (SECOND, 2 * SECOND):
        objects.note(known, Vec3(10.0, 0.1, 0.0), 10.0, ZERO, time_us, db)
    assert [objects.is_known(known, k, 2 * SECOND) for k in range(2)] == [True, False]
    assert known.radius[0] == pytest.approx(10.0 * math.tan(math.radians(2.5)))
    assert objects.is_known(known, 0, 11 * SECOND) and not objects.is_known(known, 0, 12 * SECOND)
    assert bendy_ruler.margin_of_objects(ap, ZERO, Vec3(20.0, 0.0, 0.0), 3 * SECOND) < 0.0
    objects.forget(known)
    assert bendy_ruler.margin_of_objects(ap, ZERO, Vec3(20.0, 0.0, 0.0), 3 * SECOND) == bendy_ruler.FAR


def test_a_full_database_keeps_the_nearest() -> None:
    ap = pilot(DB_BEAM_WIDTH=1.0)
    db = ap.params.OA.DB
    for k in range(OBJECTS):
        objects.note(ap.objects, Vec3(20.0, 20.0 * k, 0.0), math.hypot(20.0, 20.0 * k), ZERO, SECOND, db)
    objects.note(ap.objects, Vec3(5.0, 0.0, 0.0), 5.0, ZERO, SECOND, db)
    assert ap.objects.north.min() == 5.0 and ap.objects.east.max() == 20.0 * (OBJECTS - 2)
    objects.note(ap.objects, Vec3(900.0, 0.0, 0.0), 900.0, ZERO, SECOND, db)
    assert ap.objects.north.max() == 20.0


def test_a_small_database_stays_small() -> None:
    ap = pilot(DB_SIZE=2.0)
    for k in range(5):
        objects.note(ap.objects, Vec3(20.0, 3.0 * k, 0.0), 20.0, ZERO, SECOND, ap.params.OA.DB)
    assert [objects.is_known(ap.objects, k, SECOND) for k in range(3)] == [True, True, False]
