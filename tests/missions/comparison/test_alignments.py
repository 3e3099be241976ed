# SPDX-License-Identifier: BSD-3-Clause
"""Bringing two flights together, on tracks whose differences are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sitl.logs.track import Track
from sitl.missions.comparison.alignment import AlignmentError, match, pair
from sitl.missions.comparison.flight import measure
from tests.missions.comparison.compared_flights import straight


def moved(track: Track, columns: slice, by: tuple[float, ...], since: float = 0.0) -> Track:
    """Shifted by constants from some time on."""
    data = track.data.copy()
    data[data[:, 0] >= since, columns] += by
    return replace(track, data=data)


def later(track: Track, by: float) -> Track:
    """All of it later by the vehicle's own clock."""
    data = track.data.copy()
    data[:, 0] += by
    shifted = {
        name: [(event[0] + by, *event[1:]) for event in getattr(track, name)]
        for name in ("modes", "items", "texts", "armed")
    }
    return replace(track, data=data, **shifted)


def test_the_same_flight_begun_later_is_the_same() -> None:
    both = pair(straight(), later(straight(), 7.0))
    assert both.align == "AUTO"
    assert both.starts == pytest.approx((0.0, 7.0))
    found = measure(both)
    assert max(series.max for series in found.series) < 1e-6
    assert found.missed.max() < 1e-6


def test_a_wait_on_the_way_is_a_delay_and_no_cross_track() -> None:
    found = measure(pair(straight(20.0), straight(20.0, wait=1.5)))
    assert found["cross_track"].max < 0.02
    assert found["delay"].max == pytest.approx(1.5, abs=0.1)
    assert found["position"].max == pytest.approx(3.0, abs=0.1)


def test_a_shifted_way_is_cross_track_and_hardly_delay() -> None:
    new = moved(straight(), slice(1, 3), (0.3, 0.4))
    found = measure(pair(straight(), new))
    assert found["position"].max == pytest.approx(0.5, abs=0.02)
    assert found["position"].rms == pytest.approx(0.5, abs=0.02)
    assert 0.28 <= found["cross_track"].max <= 0.52
    assert np.nanmedian(np.abs(found["delay"].values)) < 0.25  # 0.4 m further along at 2 m/s


def test_height_and_heading_have_signs() -> None:
    new = moved(straight(), slice(3, 4), (-0.5,), since=5.0)
    new = moved(new, slice(9, 10), (-3.1,))
    golden = moved(straight(), slice(9, 10), (3.1,))
    found = measure(pair(golden, new))
    assert found["altitude"].max == pytest.approx(0.5)
    assert found["altitude"].values[-1] == pytest.approx(0.5)
    assert found["heading"].max == pytest.approx(np.degrees(2.0 * np.pi - 6.2), abs=0.2)
    assert found["altitude"].first_over(0.1) == pytest.approx(50, abs=1)


def test_a_part_left_out_is_missed() -> None:
    golden = straight(20.0)
    short = golden.between(0.0, 10.0)
    found = measure(pair(golden, short))
    assert found["cross_track"].max < 0.02
    assert found.missed.max() == pytest.approx(20.0, abs=0.5)


def test_a_heartbeat_late_is_no_delay_where_the_log_is_coarse() -> None:
    track = straight(20.0, wait=5.0)
    late = replace(track, modes=[(0.0, "GUIDED"), (0.7, "AUTO")], armed=[(0.0, True)])
    coarse = pair(track, late, coarse=True)
    assert measure(coarse)["delay"].max < 0.01
    assert "clocks brought together by -0.70 s" in coarse.notes[0]
    assert measure(pair(track, late))["delay"].max == pytest.approx(0.7, abs=0.01)


def test_what_happened_before_the_start_stays_there_when_clocks_are_brought_together() -> None:
    """The new flight's log tells of AUTO at 0.7 s as golden's at 1 s: its clock begins 0.3 s before its AUTO."""
    track = later(straight(20.0, wait=5.0), 1.0)
    golden = replace(track, modes=[(0.5, "GUIDED"), (1.7, "AUTO")], armed=[(0.5, True)])
    new = replace(track, modes=[(0.5, "GUIDED"), (1.9, "AUTO")], armed=[(0.5, True)], texts=[(1.8, 6, "Arming motors")])
    both = pair(golden, new, coarse=True)
    assert "brought together by -0.20 s" in both.notes[0]
    assert both.new.modes == [(0.0, "AUTO")]
    assert not both.new.texts


def climb_and_leg(north: float) -> Track:
    """Up by 10 m at 1 m/s, then north at 2 m/s, from a place so far north."""
    track = straight(20.0)
    climb = np.minimum(track.t, 10.0)
    data = track.data.copy()
    data[:, 1], data[:, 2], data[:, 3] = north + 2.0 * (track.t - climb), 0.0, -climb
    data[:, 4], data[:, 5], data[:, 6] = 2.0 * (track.t > 10.0), 0.0, -1.0 * (track.t <= 10.0)
    return replace(track, data=data)


def test_a_vehicle_that_stands_or_climbs_beside_a_leg_is_not_early() -> None:
    """Where it stands in GPS noise, it is nearer to a part of golden's way that golden came to later."""
    found = measure(pair(climb_and_leg(0.0), climb_and_leg(1.0)))
    assert found["delay"].max < 0.6  # 1 m at 2 m/s


def test_matching_never_goes_back() -> None:
    golden, new = straight(20.0), moved(straight(20.0, wait=0.8), slice(1, 3), (0.05, -0.04))
    index = match(new, golden).index
    assert (np.diff(np.round(index)) >= -1.0).all()


def test_another_kind_or_nothing_flown_is_said() -> None:
    with pytest.raises(AlignmentError, match="golden is a copter's flight, the new one a rover's"):
        pair(straight(), replace(straight(), kind="rover"))
    with pytest.raises(AlignmentError, match="the new flight has no samples"):
        pair(straight(), replace(straight(), data=np.zeros((0, 11))))
    with pytest.raises(AlignmentError, match="'armed': the new flight has no such moment"):
        pair(straight(), replace(straight(), armed=[(0.0, False)]), "armed")


def test_flights_far_apart_are_each_seen_from_home() -> None:
    away = replace(straight(), home=(-36.0, 150.0, 10.0))
    both = pair(straight(), away)
    assert measure(both)["position"].max == 0.0
    assert "km from golden's home" in both.notes[0]
