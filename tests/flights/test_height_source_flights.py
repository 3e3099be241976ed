# SPDX-License-Identifier: BSD-3-Clause
"""What the height comes from (EK3_SRC1_POSZ): a sensor that lies moves a copter only where it is the source."""

from __future__ import annotations

import pytest

from sitl.autopilot.estimation.fusion import NIS_HEIGHT
from tests.flights.aviator import Aviator

BAROMETER, RECEIVER = 1, 3


def hovering(core, source: int, **params: float) -> Aviator:
    return Aviator(core, "ardupilot_quad", EK3_SRC1_POSZ=source, **params).hover(10.0)


@pytest.mark.parametrize(("source", "moved"), [(BAROMETER, -4.0), (RECEIVER, 0.0)])
def test_a_barometer_that_drifts(core, source: int, moved: float) -> None:
    p = hovering(core, source)
    before = p.height
    p.set_parameter("SIM_BARO_DRIFT", 0.5)
    p.fly(10.0)
    assert p.height - before == pytest.approx(moved, abs=1.2 if moved else 0.2)


@pytest.mark.parametrize(("source", "moved"), [(BAROMETER, 0.0), (RECEIVER, -2.0)])
def test_a_receiver_whose_heights_are_wrong(core, source: int, moved: float) -> None:
    p = hovering(core, source)
    before = p.height
    p.set_parameter("SIM_GPS1_GLTCH_Z", 2.0)
    p.fly(15.0)
    assert p.height - before == pytest.approx(moved, abs=0.5 if moved else 0.2)


def test_without_fixes_the_barometer_takes_over_without_a_jump(core) -> None:
    """It is 5 m off, and the filter has learnt that."""
    p = hovering(core, RECEIVER)
    p.set_parameter("SIM_BARO_GLITCH", 5.0)
    p.fly(10.0)
    before, count = p.height, int(p.ap.estimate.reset_d_count)
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    p.fly(2.5)
    fused = int(p.ap.ekf.nis_count[NIS_HEIGHT])
    p.fly(3.0)
    assert int(p.ap.ekf.nis_count[NIS_HEIGHT]) - fused >= 25, "ten heights a second"
    assert abs(p.height - before) < 0.5 and int(p.ap.estimate.reset_d_count) == count


def test_a_receiver_that_becomes_the_source_far_off_is_taken_over(core) -> None:
    p = hovering(core, BAROMETER)
    p.set_parameter("SIM_BARO_GLITCH", 6.0)
    p.fly(15.0)
    assert p.height < 5.5 and -p.ap.estimate.pos.z - p.height > 5.0
    count = int(p.ap.estimate.reset_d_count)
    p.set_parameter("EK3_SRC1_POSZ", RECEIVER)
    p.fly(1.0)
    assert int(p.ap.estimate.reset_d_count) == count + 1
    assert abs(-p.ap.estimate.pos.z - p.height) < 0.5


def test_innovations_agree_with_the_noise_that_is_assumed(core) -> None:
    """With the Erle-Copter's receiver, whose white noise is 0.2 m."""
    p = Aviator(core, "erle_copter", EK3_SRC1_POSZ=RECEIVER).hover(5.0)
    square, count = float(p.ap.ekf.nis_sum[NIS_HEIGHT]), int(p.ap.ekf.nis_count[NIS_HEIGHT])
    p.fly(60.0)
    count = int(p.ap.ekf.nis_count[NIS_HEIGHT]) - count
    assert count == pytest.approx(300, abs=3), "five fixes a second, and nothing of the barometer"
    assert (float(p.ap.ekf.nis_sum[NIS_HEIGHT]) - square) / count == pytest.approx(1.0, abs=0.35)
