# SPDX-License-Identifier: BSD-3-Clause
"""Flights by another system's position, without GPS; values of a real ArduPilot with its own simulator are named."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl import Simulation
from sitl.autopilot.copter.modes.land import LAND
from sitl.autopilot.estimation.status import CONST_POS_MODE, POS_HORIZ_ABS, POS_HORIZ_REL
from sitl.client import Client
from sitl.client.odometry import PARAMETERS, Odometry
from sitl.core.vectors import Vec3


class Flight:
    """A copter that is told where it is.

    Args:
        boot: time before it is given an origin [s].
        origin: whether it is given one.
        params: besides those of the helper.
    """

    def __init__(self, boot: float = 26.0, origin: bool = True, **params: float) -> None:
        self.simulation = Simulation("erle_copter", params={**PARAMETERS, **params})
        self.client = Client(self.simulation)
        self.v: Any = self.simulation.v
        self.odometry = Odometry(self.client, position_noise=0.02, velocity_noise=0.02).start()
        self.client.delay(boot)
        place = self.v.physics.origin
        if origin:
            self.client.send(
                "SET_GPS_GLOBAL_ORIGIN", target_system=1, latitude=place.lat, longitude=place.lon, altitude=584_000
            )
        self.client.delay(1.0)

    def hover(self) -> Flight:
        """Take off to 10 m in GUIDED."""
        self.client.set_mode("GUIDED")
        self.client.arm()
        self.client.take_off(10.0)
        return self

    @property
    def true(self) -> np.ndarray:
        """True position, NED [m]."""
        return np.array(self.v.physics.body.pos)

    @property
    def believed(self) -> np.ndarray:
        """The estimate of it."""
        return np.array(self.v.autopilot.estimate.pos)

    @property
    def flags(self) -> int:
        """EKF_STATUS_FLAGS"""
        return int(self.v.autopilot.estimate.status_flags)

    def said(self, text: str) -> bool:
        """Whether a status text had this in it."""
        return any(text in said.text for said in self.client.texts)


def test_a_square_by_odometry() -> None:
    """Flags and texts as the real one's; each corner within 0.3 m (real: 0.05 m, at 50 messages a second)."""
    flight = Flight()
    assert flight.flags == 831, "absolute, as with GPS"
    assert flight.said("EKF3 IMU0 is using external nav data") and flight.said("EKF3 IMU0 initial pos NED = ")
    flight.hover()
    for north, east in ((10, 0), (10, 10), (0, 10), (0, 0)):
        flight.client.goto(north, east, 10)
        flight.client.delay(5.0)
        assert math.dist(flight.true, (north, east, -10)) < 0.3
        assert math.dist(flight.true, flight.believed) < 0.15


def test_odometry_is_lost() -> None:
    """As the real one: no position after 7 s, LAND 1 s later, no aiding after 15 s; it is back at the first message."""
    flight = Flight().hover()
    client = flight.client
    flight.odometry.stop()
    began = client.now
    client.wait(lambda _: not flight.flags & POS_HORIZ_ABS, 10.0)
    assert client.now - began == pytest.approx(7.1, abs=0.3)
    client.wait(lambda _: flight.v.autopilot.modes.number == LAND, 5.0)
    assert client.now - began == pytest.approx(8.1, abs=0.4)
    client.wait(lambda _: flight.flags & CONST_POS_MODE, 10.0)
    assert client.now - began == pytest.approx(15.1, abs=0.3) and flight.said("EKF3 IMU0 stopped aiding")
    flight.odometry.start()
    client.delay(0.5)
    assert flight.flags & POS_HORIZ_ABS and math.dist(flight.true, flight.believed) < 0.3


def test_a_reset_of_the_other_system() -> None:
    """With another reset counter the estimate jumps along, and the vehicle stays where it is."""
    flight = Flight().hover()
    before = flight.true
    flight.odometry.offset = Vec3(8.0, -6.0, 0.0)
    flight.odometry.resets += 1
    flight.client.delay(3.0)
    assert math.dist(flight.believed[:2] - flight.true[:2], (8.0, -6.0)) < 0.15
    assert math.dist(flight.true[:2], before[:2]) < 0.3
    assert flight.v.autopilot.estimate.reset_ne_count >= 2


def test_what_is_far_off_is_left_out() -> None:
    """A glitch of 30 m without a reset is not believed for five seconds."""
    flight = Flight().hover()
    before = flight.believed
    flight.odometry.offset = Vec3(30.0, 0.0, 0.0)
    flight.client.delay(2.0)
    assert math.dist(flight.believed, before) < 0.5 and flight.v.autopilot.estimate.variance_pos > 1.0
    flight.odometry.offset = Vec3(0.0, 0.0, 0.0)
    flight.client.delay(1.0)
    assert flight.v.autopilot.estimate.variance_pos < 0.3


@pytest.mark.parametrize("resets", [0, 1])
def test_a_place_beyond_all_sense_is_passed_over(resets: int) -> None:
    flight = Flight().hover()
    flight.client.delay(5.0)
    before = flight.true
    flight.odometry.offset = Vec3(1e30, 0.0, 0.0)
    flight.odometry.resets += resets
    flight.client.delay(0.3)
    flight.odometry.offset = Vec3(0.0, 0.0, 0.0)
    flight.client.delay(2.0)
    assert flight.v.autopilot.ekf.resets == 0 and flight.flags & POS_HORIZ_ABS
    assert math.dist(flight.true, before) < 0.3 and math.dist(flight.true, flight.believed) < 0.3


@pytest.mark.parametrize("gps_first", [True, False])
def test_from_odometry_to_gps_without_an_origin(gps_first: bool) -> None:
    """GPS sets the origin, and its place is taken from there; until then the last place holds."""
    gps = {"EK3_SRC2_POSXY": 3, "EK3_SRC2_VELXY": 3, "EK3_SRC2_POSZ": 1, "EK3_SRC2_VELZ": 3, "EK3_SRC2_YAW": 1}
    flight = Flight(50.0, False, **gps, EK3_SRC1_POSZ=1, GPS1_TYPE=1, SIM_GPS1_ENABLE=0)
    client, enable = flight.client, "SIM_GPS1_ENABLE"
    assert flight.flags & POS_HORIZ_ABS and not flight.v.autopilot.estimate.origin_set
    if gps_first:
        client.params[enable] = 1
    client.command(42007, 2)
    if not gps_first:
        client.delay(4.0)
        client.params[enable] = 1
    for _ in range(40):
        client.delay(0.5)
        assert math.dist(flight.believed, flight.true) < 2.0
    assert flight.v.autopilot.estimate.origin_set and flight.flags & POS_HORIZ_ABS
    assert flight.said("EKF3 IMU0 is using GPS")


def test_heading_without_a_compass() -> None:
    """EK3_SRC1_YAW 6: aligned by the first message, and right within a degree in flight."""
    flight = Flight(EK3_SRC1_YAW=6, ARMING_CHECK=786390, COMPASS_USE=0).hover()
    assert flight.said("EKF3 IMU0 yaw aligned") and not flight.said("MAG0 initial yaw")
    flight.client.goto(10, 5, 10)
    flight.client.delay(3.0)
    q = flight.v.physics.body.q
    true = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    assert math.degrees(abs(math.remainder(flight.v.autopilot.estimate.yaw - true, math.tau))) < 1.0


def test_velocity_alone_is_relative() -> None:
    """EK3_SRC1_POSXY 0: positions count from the start, and the place drifts."""
    flight = Flight(EK3_SRC1_POSXY=0, EK3_SRC1_POSZ=1)
    assert flight.flags & POS_HORIZ_REL and not flight.flags & POS_HORIZ_ABS
    assert flight.said("EKF3 IMU0 started relative aiding")
    flight.hover().client.delay(20.0)
    assert math.dist(flight.true[:2], (0.0, 0.0)) < 1.0


@pytest.mark.parametrize(("least", "used"), [(0, True), (60, True), (101, False)])
def test_quality_of_a_message(least: float, used: bool) -> None:
    """VISO_QUAL_MIN; the helper tells 100."""
    flight = Flight(8.0, VISO_QUAL_MIN=min(least, 100))
    if not used:
        flight.v.autopilot.params.VISO.QUAL_MIN = least
        count = flight.v.autopilot.odometry.pose.count
        flight.client.delay(2.0)
        assert flight.v.autopilot.odometry.pose.count == count
    else:
        assert flight.flags & POS_HORIZ_ABS
