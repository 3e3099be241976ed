# SPDX-License-Identifier: BSD-3-Clause
"""Flights as tests: nothing is set up but what stands here."""

import pytest


def test_square(copter):
    """The mission is flown as it was when golden/square.rec was made."""
    copter.fly_mission("copter/square")
    copter.assert_flies_like("golden/square.rec")


def test_comes_home_when_the_transmitter_fails(copter):
    copter.takeoff(15)
    copter.fly_to(north=40, east=10)
    copter.change_mode("LOITER")
    copter.set_rc(throttle=1500)
    copter.release_rc()
    with copter.fail("rc"):
        copter.wait_mode("RTL", timeout=5)
        copter.wait_statustext("Radio Failsafe")
        copter.wait_disarmed()
    assert abs(copter.position.north) < 1 and abs(copter.position.east) < 1


@pytest.mark.sitl(wind=(8, 270, 1))
def test_leans_less_with_a_lower_limit(copter):
    copter.takeoff(20)

    def tilt_on_the_way_to(north):
        copter.set_position(north, 0)
        with copter.messages("ATTITUDE") as attitudes:
            copter.wait_location(north, 0, accuracy=2)
        return max(max(abs(m.roll), abs(m.pitch)) for m in attitudes)

    with copter.fork():
        free = tilt_on_the_way_to(60)
    with copter.parameters(ANGLE_MAX=1500):
        assert tilt_on_the_way_to(60) < 0.8 * free


@pytest.mark.sitl(world="maze_erlerover")
def test_rover_stops_before_it_hits_a_wall(rover):
    rover.start()
    with rover.always(lambda: not any("Hit obstacle" in text.text for text in rover.texts), "it hits nothing"):
        rover.set_velocity(0.5, 0, body=True)
        rover.wait_distance(0.5)
        rover.stop()
