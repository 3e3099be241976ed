# SPDX-License-Identifier: BSD-3-Clause
"""FOLLOW's lead: whose reports are taken, how it goes on between them, and the place beside it."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot import followed_vehicle
from sitl.autopilot.copter.parameters import TABLE, Parameters
from sitl.autopilot.followed_vehicle import Report
from sitl.autopilot.state import FollowState
from sitl.core.algebra import ZERO
from sitl.core.vectors import Vec3

DT = 0.0025
HERE = Vec3(0.0, 0.0, -10.0)


@pytest.fixture
def p():
    params = Parameters()
    TABLE.set_defaults(params)
    params.FOLL.ENABLE = 1.0
    return params.FOLL


def report(x=0.0, y=0.0, z=-10.0, vel=ZERO, heading=0.0, has_heading=True, rate=0.0):
    return Report(Vec3(x, y, z), vel, ZERO, has_heading, heading, rate)


def fly(lead, p, start_us, seconds):
    """Periods of ``follow``; returns the time after them [us]."""
    now = start_us
    for _ in range(round(seconds / DT)):
        now += round(DT * 1e6)
        followed_vehicle.follow(lead, p, HERE, now, DT)
    return now


def test_only_the_lead_is_heard(p):
    lead = FollowState()
    assert followed_vehicle.is_lead(lead, p, 7, 1)
    followed_vehicle.take(lead, p, 7, report(), 1)
    assert followed_vehicle.is_lead(lead, p, 7, 2) and not followed_vehicle.is_lead(lead, p, 8, 2)
    assert followed_vehicle.is_lead(lead, p, 8, 1 + followed_vehicle.FORGET_US + 1)
    p.SYSID = 9.0
    assert followed_vehicle.is_lead(lead, p, 9, 2) and not followed_vehicle.is_lead(lead, p, 7, 2)
    p.ENABLE = 0.0
    assert not followed_vehicle.is_lead(lead, p, 9, 2)


def test_how_long_a_lead_may_be_silent(p):
    lead = FollowState()
    followed_vehicle.take(lead, p, 7, report(50.0), 1_000_000)
    p.TIMEOUT = 1.5
    assert followed_vehicle.follow(lead, p, HERE, 2_500_000, DT) and not followed_vehicle.follow(
        lead, p, HERE, 2_502_500, DT
    )
    p.TIMEOUT = 0.1
    lead.pos, lead.vel = lead.received_pos + Vec3(1.0, 0.0, 0.0), lead.received_vel
    assert followed_vehicle.is_far(lead, p)
    p.TIMEOUT = 3.0
    assert not followed_vehicle.is_far(lead, p)


def test_a_silent_or_far_lead_is_not_followed(p):
    lead = FollowState()
    assert not followed_vehicle.follow(lead, p, HERE, 1_000_000, DT)
    followed_vehicle.take(lead, p, 7, report(50.0), 1_000_000)
    assert followed_vehicle.follow(lead, p, HERE, 1_002_500, DT)
    assert not followed_vehicle.follow(lead, p, HERE, 1_000_000 + 4_000_000, DT)
    followed_vehicle.take(lead, p, 7, report(150.0), 5_000_000)
    assert not followed_vehicle.follow(lead, p, HERE, 5_002_500, DT)
    p.DIST_MAX = 0.0
    assert followed_vehicle.follow(lead, p, HERE, 5_005_000, DT)


def test_it_goes_on_as_it_said(p):
    lead = FollowState()
    followed_vehicle.take(lead, p, 7, report(vel=Vec3(3.0, -2.0, 0.5), heading=1.0, rate=0.2), 1_000_000)
    fly(lead, p, 1_000_000, 2.0)
    assert tuple(lead.pos) == pytest.approx((6.0, -4.0, -9.0), abs=1e-6)
    assert tuple(lead.vel) == pytest.approx((3.0, -2.0, 0.5), abs=1e-6)
    assert lead.heading == pytest.approx(1.4, abs=1e-6)


def test_it_comes_smoothly_to_a_report_that_is_not_far(p):
    lead = FollowState()
    followed_vehicle.take(lead, p, 7, report(), 1_000_000)
    now = fly(lead, p, 1_000_000, 0.5)
    followed_vehicle.take(lead, p, 7, report(2.0, 1.0, -11.0, heading=0.5), now)
    before = lead.pos
    assert lead.is_known
    fly(lead, p, now, DT)
    assert tuple(lead.pos) == pytest.approx(tuple(before), abs=1e-3)
    for _ in range(5):
        now = fly(lead, p, now, 2.0)
        followed_vehicle.take(lead, p, 7, report(2.0, 1.0, -11.0, heading=0.5), now)
    assert tuple(lead.pos) == pytest.approx((2.0, 1.0, -11.0), abs=0.02) and lead.heading == pytest.approx(
        0.5, abs=0.01
    )


def test_a_far_report_starts_it_anew(p):
    lead = FollowState()
    followed_vehicle.take(lead, p, 7, report(), 1_000_000)
    fly(lead, p, 1_000_000, 0.5)
    followed_vehicle.take(lead, p, 7, report(30.0), 1_500_000)
    assert not lead.is_known
    followed_vehicle.follow(lead, p, HERE, 1_502_500, DT)
    assert lead.pos.x == 30.0


def test_offsets_turn_with_the_lead(p):
    lead = FollowState()
    p.OFS_X, p.OFS_Z = -30.0, -5.0
    lead.heading = math.radians(90.0)
    assert tuple(followed_vehicle.offset(lead, p)) == (-30.0, 0.0, -5.0)
    p.OFS_TYPE = 1.0
    assert tuple(followed_vehicle.offset(lead, p)) == pytest.approx((0.0, -30.0, -5.0), abs=1e-9)


@pytest.mark.parametrize("kind", [0.0, 1.0])
def test_without_offsets_the_distance_is_kept(p, kind):
    lead = FollowState()
    p.OFS_TYPE = kind
    followed_vehicle.take(lead, p, 7, report(10.0, 20.0, -12.0, heading=1.0), 1_000_000)
    followed_vehicle.follow(lead, p, HERE, 1_002_500, DT)
    assert followed_vehicle.keep_distance(lead, p, HERE) and not followed_vehicle.keep_distance(lead, p, ZERO)
    assert tuple(lead.pos + followed_vehicle.offset(lead, p)) == pytest.approx(tuple(HERE), abs=1e-9)


def test_a_lead_without_heading_is_of_no_use_where_offsets_turn(p):
    lead = FollowState()
    p.OFS_TYPE = 1.0
    followed_vehicle.take(lead, p, 7, report(has_heading=False), 1_000_000)
    assert lead.update_us == 0
    p.OFS_TYPE = 0.0
    followed_vehicle.take(lead, p, 7, report(has_heading=False), 1_000_000)
    assert lead.update_us == 1_000_000
