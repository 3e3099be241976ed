# SPDX-License-Identifier: BSD-3-Clause
"""Waits end when it is so, and say what they saw when it is not."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sitl.client.waits import turn
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.logs import fly_again


def test_a_vehicle_begins_ready_to_arm(make: VehicleFactory) -> None:
    copter = make("copter")
    assert not copter.armed and copter.telemetry.has_position and copter.telemetry.checked
    copter.arm()
    assert copter.armed


def test_waits_of_a_flight(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    assert 9.5 <= copter.height <= 12
    copter.set_position(30, 0, 15, yaw=90)
    start = copter.position
    copter.wait_climb_rate(0.3)
    copter.wait_groundspeed(2, 20)
    copter.wait_distance(10)
    assert 10 <= copter.position.north - start.north < 12
    copter.wait_heading(90, accuracy=2)
    copter.wait_altitude(14.5, 15.5, hold=2)
    copter.wait_location(30, 0, 15, accuracy=0.7)
    copter.change_mode("LAND")
    copter.wait_mode("LAND")
    copter.wait_disarmed()
    assert copter.height < 0.5


def test_a_wait_in_vain_says_what_was_seen(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(5)
    began = copter.now
    with pytest.raises(AssertionError) as failure:
        copter.wait_altitude(50, 60, timeout=7)
    assert copter.now == pytest.approx(began + 7)
    text = str(failure.value)
    assert re.search(r"waited 7 s for an altitude of 50 to 60 m\n  last seen: [45]\.\d\d m", text)
    assert f"at {copter.now:.1f} s simulated: GUIDED, armed" in text
    assert "Arming motors" in text


def test_a_height_must_hold(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(5)
    copter.set_velocity(0, 0, -1)
    with pytest.raises(AssertionError, match="8 to 9 m, for 5 s"):
        copter.wait_altitude(8, 9, timeout=15, hold=5)


def test_each_text_is_found_once(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.arm()
    assert copter.wait_statustext("Arming motors").text == "Arming motors"
    with pytest.raises(AssertionError, match="status text 'Arming motors'"):
        copter.wait_statustext("Arming motors", timeout=1)
    copter.disarm()
    copter.arm()
    copter.wait_statustext(re.compile("^Arming m"))


def test_texts_before_a_time_do_not_count(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.arm()
    with pytest.raises(AssertionError, match=r"no text|other texts"):
        copter.wait_statustext("Arming motors", timeout=1, since=copter.now)


def test_what_must_hold_always_is_looked_at_all_the_time(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(5)
    low = copter.always(lambda: copter.height < 8, "stays below 8 m")
    with pytest.raises(AssertionError, match="stays below 8 m; it is not so now"), low:
        copter.fly_to(0, 0, 12)
    assert copter.height < 8.5
    copter.fly_to(0, 0, 12)


def test_a_mode_that_is_none_names_those_there_are(make: VehicleFactory) -> None:
    with pytest.raises(ValueError, match=r"no mode 'FLIP'; it has STABILIZE, .*LAND"):
        make("copter").change_mode("FLIP")


def test_a_refusal_says_why(make: VehicleFactory) -> None:
    copter = make("copter", ready=False)
    copter.delay(3)
    with pytest.raises(AssertionError, match=r"(?s)arming was refused: failed.*last texts:.*Arm:"):
        copter.arm()


def test_time_passes_as_told(make: VehicleFactory) -> None:
    copter = make("copter")
    began = copter.now
    copter.delay(0.25)
    assert copter.now == pytest.approx(began + 0.25)


def test_messages_are_collected(make: VehicleFactory) -> None:
    copter = make("copter")
    with copter.messages("ATTITUDE", rate_hz=50) as seen:
        copter.delay(1)
    assert 49 <= len(seen) <= 56
    assert copter.message("AUTOPILOT_VERSION").flight_sw_version > 0
    with pytest.raises(AssertionError, match="the request for TERRAIN_REQUEST was refused"):
        copter.message("TERRAIN_REQUEST")


def test_a_reboot_is_survived(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter")
    copter.reboot()
    copter.wait_ready()
    copter.takeoff(3)
    assert fly_again(copter, tmp_path, "flight", log=True).same


@pytest.mark.parametrize(("angle", "turned"), [(190, -170), (-190, 170), (360, 0), (720 + 5, 5)])
def test_turns_are_the_short_way(angle: float, turned: float) -> None:
    assert turn(angle) == pytest.approx(turned)
