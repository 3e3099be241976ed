# SPDX-License-Identifier: BSD-3-Clause
"""What an environment hears of its vehicle: before it has said anything, in any pieces, of others, after a boot."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.envs.mavlink.last_messages import PART, SCAN, SECTORS, StepTelemetry


def frame(title: str, system: int = 1, component: int = 1, **fields: Any) -> bytes:
    kind = message(title)
    return encode_v2(kind, kind.payload(**fields), 0, system, component)


def beat(system: int = 1, **fields: Any) -> bytes:
    return frame("HEARTBEAT", system, **{"type": 2, "autopilot": 3, **fields})


def heard(readings: int = 0, *data: bytes, wanted: tuple[str, ...] = ()) -> StepTelemetry:
    made = StepTelemetry(readings, [message(name) for name in wanted])
    made.feed(beat())
    for piece in data:
        made.feed(piece)
    return made


def test_before_it_has_said_anything_nothing_is_known() -> None:
    made = StepTelemetry(5)
    assert (made.system, made.mode, made.armed, made.is_px4, made.origin, made.estimator) == (
        0,
        -1,
        False,
        False,
        None,
        0,
    )
    assert all(map(math.isnan, made.position[1:4])) and made.position[4:] == (0.0, 0.0, 0.0)
    assert math.isnan(made.height) and made.time_ms == 0 and (made.scans, made.hits) == (0, 0)
    assert np.isinf(made.scan).all() and len(made.scan) == PART and made.scans_used
    assert not StepTelemetry(0).scans_used and len(StepTelemetry(PART + 1).scan) == 2 * PART


@pytest.mark.parametrize(("base_mode", "armed"), [(0, False), (128, True), (127, False), (255, True)])
def test_heartbeats_tell_mode_arming_and_autopilot(base_mode: int, armed: bool) -> None:
    made = heard(0, beat(base_mode=base_mode, custom_mode=4))
    assert (made.mode, made.armed, made.is_px4, made.system) == (4, armed, False, 1)
    assert heard(0, beat(autopilot=12)).is_px4


def test_positions_and_attitudes_are_the_latest_in_any_pieces() -> None:
    data = frame("LOCAL_POSITION_NED", time_boot_ms=100, x=1, y=2, z=3, vx=4, vy=5, vz=6)
    data += frame("ATTITUDE", time_boot_ms=90, roll=0.5, pitch=0.25, yaw=2, rollspeed=1, pitchspeed=2, yawspeed=0)
    whole, pieces = heard(0, data), heard(0, *(data[k : k + 7] for k in range(0, len(data), 7)))
    for made in (whole, pieces):
        assert made.position == (100, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
        assert made.attitude == (90, 0.5, 0.25, 2.0, 1.0, 2.0, 0.0) and made.time_ms == 90, "both are so new"


def test_other_vehicles_and_components_are_not_heard() -> None:
    made = heard(
        0, frame("LOCAL_POSITION_NED", 2, x=9), frame("LOCAL_POSITION_NED", 1, 100, x=9), beat(2, custom_mode=9)
    )
    assert math.isnan(made.position[1]) and made.mode == 0


def test_what_it_is_asked_for_is_kept() -> None:
    made = heard(
        0, frame("GPS_GLOBAL_ORIGIN", latitude=1, longitude=2, altitude=3), frame("ESTIMATOR_STATUS", flags=55),
        frame("GLOBAL_POSITION_INT", relative_alt=12_345), frame("EXTENDED_SYS_STATE", landed_state=1),
        frame("STATUSTEXT", text=b"SIM Hit obstacle at 3 m/s"), frame("STATUSTEXT", text=b"Hit SIM obstacle"),
    )  # fmt: skip
    assert (made.origin, made.estimator, made.height, made.hits) == ((1, 2, 3), 55, pytest.approx(12.345), 1)
    assert made.landed and not heard(0, frame("EXTENDED_SYS_STATE", landed_state=2)).landed


def test_reports_that_are_wanted_are_noted() -> None:
    ranged = frame("RANGEFINDER", distance=2.5)
    made = heard(0, ranged, wanted=("RANGEFINDER",))
    assert made.reported == {message("RANGEFINDER")} and 2.5 in made.reports
    assert heard(0, ranged).reported == set()


# ---------------------------------------------------------------- scans


def part(number: int, first: float = 0.0, time_usec: int = 1000, name: bytes = b"LASER") -> bytes:
    data = [first + k for k in range(PART)]
    return frame("DEBUG_FLOAT_ARRAY", time_usec=time_usec, array_id=number, name=name, data=data)


def test_a_scan_is_shown_when_all_of_its_parts_have_come() -> None:
    made = heard(2 * PART, part(1, 100.0))
    assert made.scans == 0 and np.isinf(made.scan).all()
    made.feed(part(0))
    assert made.scans == 1 and made.scan[[0, PART - 1, PART]].tolist() == [0.0, PART - 1.0, 100.0]


def test_parts_of_two_scans_are_not_mixed() -> None:
    made = heard(2 * PART, part(0, 0.0, 1000), part(1, 100.0, 2000))
    assert made.scans == 0
    made.feed(part(0, 50.0, 2000))
    assert made.scans == 1 and made.scan[0] == 50.0
    made.feed(part(1, 7.0, 3000))
    assert made.scans == 1 and made.scan[0] == 50.0, "the last whole one"


@pytest.mark.parametrize("other", [part(2), part(0, name=b"OTHER")])
def test_what_is_no_part_of_the_scan_is_passed_over(other: bytes) -> None:
    made = heard(2 * PART, other, part(1))
    assert made.scans == 0


def sectors(angles: Any, **fields: Any) -> list[float]:
    made = StepTelemetry(len(angles))
    made.angles, made.scan_kind = np.radians(np.array(angles, float)), SECTORS
    made.feed(beat())
    distances = fields.pop("distances", list(range(100, 172)))
    made.feed(frame("OBSTACLE_DISTANCE", **{"increment": 5, "max_distance": 9000, "distances": distances, **fields}))
    return [round(float(x), 2) for x in made.scan[: len(angles)]]


def test_sectors_go_clockwise_from_the_nose() -> None:
    """72 of 5 degrees [cm]: a reading to the left, 90 degrees counter-clockwise, is of sector 54."""
    assert sectors([0.0, -5.0, -90.0, 90.0, 5.0, 180.0]) == [1.0, 1.01, 1.18, 1.54, 1.71, 1.36]
    assert sectors([0.0, -5.0], angle_offset=-5.0) == [1.01, 1.02]
    assert sectors([2.4, -2.4, 359.0]) == [1.0, 1.0, 1.0], "the nearest sector, round the circle"


def test_sectors_of_another_width_or_direction() -> None:
    assert sectors([0.0, -10.0], increment=10) == [1.0, 1.01]
    assert sectors([-7.5, -15.0], increment=10, increment_f=7.5) == [1.01, 1.02], (
        "the float counts before the whole one"
    )
    assert sectors([5.0, -5.0], increment_f=-5.0) == [1.01, 1.71], "counter-clockwise"
    assert sectors([0.0, -5.0], increment=0) == [math.inf, math.inf], "no width: no reading"


def test_sectors_beyond_the_range_or_the_list_are_empty() -> None:
    assert sectors([0.0, -5.0], distances=[9000, 9001, *[65535] * 70]) == [90.0, math.inf]
    assert sectors([-100.0], increment=1) == [math.inf], "72 sectors of a degree"


def test_sectors_count_only_where_they_were_asked_for() -> None:
    made = heard(3)
    assert made.scan_kind is SCAN
    made.feed(frame("OBSTACLE_DISTANCE", increment=5, max_distance=9000, distances=[100] * 72))
    assert made.scans == 0


# ---------------------------------------------------------------- boots, snapshots


def test_after_a_boot_what_was_said_before_does_not_count() -> None:
    made = heard(
        PART, part(0), frame("LOCAL_POSITION_NED", time_boot_ms=5, x=1), frame("GPS_GLOBAL_ORIGIN", latitude=1),
        frame("ESTIMATOR_STATUS", flags=9), beat(base_mode=128, custom_mode=4), frame("STATUSTEXT", text=b"hello"),
    )  # fmt: skip
    made.forget()
    assert math.isnan(made.position[1]) and (made.origin, made.armed, made.estimator) == (None, False, 0)
    assert repr(made.position) == repr(StepTelemetry(PART).position)
    assert list(made.last_texts) == [] and made.scans == 1
    made.feed(part(0, 9.0))
    assert made.scans == 2 and made.scan[0] == 9.0, "a clock that begins anew may show the same time again"


def test_a_memory_goes_on() -> None:
    made = heard(PART, part(0, 5.0), frame("LOCAL_POSITION_NED", x=1), beat(base_mode=128, custom_mode=4))
    made.origin, made.attitude, made.reports[2] = (1, 2, 3), (7, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0), 9.5
    other = StepTelemetry(PART)
    other.recall(made.memory())
    assert (other.position, other.attitude, other.mode, other.armed, other.origin) == (
        made.position, made.attitude, 4, True, (1, 2, 3),
    )  # fmt: skip
    assert other.scan[0] == 5.0 and other.reports[2] == 9.5 and other.scan_kind is SCAN
    made.scan_kind = SECTORS
    other.recall(made.memory())
    assert other.scan_kind is SECTORS
