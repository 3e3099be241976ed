# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink services on the real rover firmware: set-points, missions, commands, snapshots, as a client sees them."""

from __future__ import annotations

import math
from typing import Any

import pytest

from benchmarks.recorded.pilot import Pilot, items
from sitl.client.endpoint import Endpoint
from sitl.simulation import Simulation

DO_SET_MODE = 176

HOLD, AUTO, RTL, GUIDED = 4, 10, 11, 15
POSITION, VELOCITY, VELOCITY_AND_RATE, VELOCITY_AND_YAW = 0xDF8, 0xDC7, 0x5C7, 0x9C7
TARGET = {"target_system": 1, "target_component": 1}
HOME = (-353632621, 1491652371)
MISSION = [
    (0, 16, *HOME, 584.0), (3, 16, HOME[0] + 900, HOME[1], 0.0), (3, 16, HOME[0] + 900, HOME[1] + 1100, 0.0)
]  # fmt: skip


class Driver:
    """A rover with one client."""

    def __init__(self, frame: str) -> None:
        self.simulation = Simulation(frame, home=(HOME[0] * 1e-7, HOME[1] * 1e-7, 584.0, 0.0))
        self.client = Endpoint()
        self.simulation.bridge.add_link(self.client.link)
        self.received: list[Any] = []

    @property
    def ap(self) -> Any:
        return self.simulation.v.autopilot

    @property
    def speed(self) -> float:
        return math.hypot(float(self.ap.estimate.vel[0]), float(self.ap.estimate.vel[1]))

    def wait(self, seconds: float) -> list[Any]:
        """What came meanwhile."""
        self.simulation.advance(seconds)
        received = self.client.receive()
        self.received += received
        return received

    def texts(self) -> list[str]:
        return [m.fields.text.decode() for m in self.received if m.name == "STATUSTEXT"]

    def command(self, number: int, *p: float) -> int:
        self.client.command(number, *p)
        (result,) = [m.fields.result for m in self.wait(0.05) if m.name == "COMMAND_ACK"]
        return int(result)

    def ready(self) -> None:
        """With a position, in GUIDED, armed."""
        self.wait(45.0)
        assert self.command(DO_SET_MODE, 1, GUIDED) == 0
        assert self.command(400, 1) == 0, self.texts()

    def local(self, mask: int, frame: int = 1, seconds: float = 0.0, **fields: float) -> None:
        """Send a set-point, again every 0.5 s for a while."""
        for _ in range(max(1, round(seconds / 0.5))):
            self.client.send(
                "SET_POSITION_TARGET_LOCAL_NED", **TARGET, coordinate_frame=frame, type_mask=mask, **fields
            )
            self.wait(0.5)


@pytest.fixture
def driver() -> Driver:
    found = Driver("ardupilot_rover")
    found.ready()
    return found


def test_velocity_and_its_time_out(driver: Driver) -> None:
    driver.local(VELOCITY, seconds=8.0, vx=0.0, vy=2.0)
    assert driver.speed == pytest.approx(2.0, abs=0.2)
    assert float(driver.ap.estimate.euler[2]) == pytest.approx(math.pi / 2, abs=0.1)
    driver.wait(3.2)
    assert driver.texts()[-1] == "target not received last 3secs, stopping"
    driver.wait(4.0)
    assert driver.speed < 0.1


def test_backwards_and_in_circles(driver: Driver) -> None:
    driver.local(VELOCITY_AND_YAW, seconds=6.0, vx=-1.0, yaw=0.0)
    assert float(driver.ap.estimate.vel[0]) == pytest.approx(-1.0, abs=0.2)
    driver.local(VELOCITY_AND_RATE, frame=8, seconds=6.0, vx=1.0, yaw_rate=0.5)
    assert float(driver.ap.estimate.rates[2]) == pytest.approx(0.5, abs=0.1) and driver.speed > 0.8
    assert driver.command(DO_SET_MODE, 1, HOLD) == 0
    driver.wait(5.0)
    assert driver.speed < 0.1


def test_share_of_the_speed(driver: Driver) -> None:
    for _ in range(12):
        driver.client.send("SET_ATTITUDE_TARGET", **TARGET, type_mask=7, q=(1.0, 0.0, 0.0, 0.0), thrust=0.4)
        driver.wait(0.5)
    assert driver.speed == pytest.approx(0.4 * float(driver.ap.params.WP_SPEED), abs=0.2)


def test_a_place_is_reached_and_told(driver: Driver) -> None:
    driver.local(POSITION, x=10.0, y=10.0)
    output = {m.name: m.fields for m in driver.wait(2.0)}
    assert 3 <= output["NAV_CONTROLLER_OUTPUT"].wp_dist <= 15
    assert output["POSITION_TARGET_GLOBAL_INT"].lat_int == pytest.approx(HOME[0] + 898, abs=20)
    driver.wait(20.0)
    assert [m.fields.seq for m in driver.received if m.name == "MISSION_ITEM_REACHED"] == [0]
    assert math.dist(driver.ap.estimate.pos[:2], (10.0, 10.0)) < float(driver.ap.params.WP_RADIUS)
    assert driver.speed < 0.1


def test_a_mission_from_upload_to_its_end() -> None:
    pilot = Pilot(Simulation("ardupilot_rover", home=(HOME[0] * 1e-7, HOME[1] * 1e-7, 584.0, 0.0)))
    pilot.fly(45.0)
    pilot.transfer(items(MISSION))
    pilot.send_command("DO_SET_MODE", 1, GUIDED)
    pilot.send_command("COMPONENT_ARM_DISARM", 1)
    pilot.fly(1.0)
    pilot.send_command("MISSION_START")
    pilot.fly(30.0)
    assert pilot.reached == [1, 2]
    said = [text for _, _, text in pilot.texts]
    assert said[-1] == "Mission Complete" and "Reached waypoint #1" in said and "Flight plan received" in said
    place = pilot.simulation.v.autopilot.estimate.pos
    assert math.dist(place[:2], (10.0, 10.0)) < float(pilot.simulation.v.autopilot.params.WP_RADIUS)


@pytest.mark.parametrize(
    ("item", "result"), [((3, 22, 0, 0, 10.0), 0), ((3, 21, 0, 0, 0.0), 0), ((9, 16, 0, 0, 0.0), 2)]
)
def test_items_of_copters_are_stored_and_unknown_frames_refused(
    driver: Driver, item: tuple[Any, ...], result: int
) -> None:
    driver.client.send("MISSION_COUNT", **TARGET, count=2)
    for seq, (frame, command, x, y, z) in enumerate((MISSION[0], item)):
        driver.wait(0.05)
        driver.client.send("MISSION_ITEM_INT", **TARGET, seq=seq, frame=frame, command=command, x=x, y=y, z=z)
    acks = [m.fields.type for m in driver.wait(0.05) if m.name == "MISSION_ACK"]
    assert acks == [result]


def test_reverse(driver: Driver) -> None:
    driver.local(POSITION, x=-10.0, y=0.0)
    assert driver.command(194, 1) == 0
    driver.wait(5.0)
    assert abs(float(driver.ap.estimate.euler[2])) < 0.3 and float(driver.ap.estimate.vel[0]) < -0.5


def test_motor_test_turns_the_wheels_for_a_while(driver: Driver) -> None:
    assert driver.command(400, 0) == 0
    assert driver.command(209, 1, 0, 20, 2) == 0
    driver.wait(1.0)
    low, high = (int(driver.ap.params[f"SERVO3_{end}"]) for end in ("TRIM", "MAX"))
    assert int(driver.simulation.v.actuators.pwm[2]) == pytest.approx(low + 0.2 * (high - low), abs=2)
    driver.wait(2.0)
    assert not driver.ap.arming.armed and int(driver.simulation.v.actuators.pwm[2]) in (0, low)


def test_sticks_drive_in_manual(driver: Driver) -> None:
    assert driver.command(DO_SET_MODE, 1, 0) == 0
    for _ in range(6):
        driver.client.send("MANUAL_CONTROL", target=1, x=32767, y=500, z=300, r=32767)
        driver.wait(0.5)
    assert float(driver.ap.estimate.rates[2]) > 0.1 and driver.speed > 0.5
    driver.wait(6.0)
    assert driver.ap.rc.channels[2] == 1500, "the ground station's sticks are forgotten"


def test_the_same_bytes_after_a_restore(driver: Driver) -> None:
    def record() -> bytes:
        received = b""
        for _ in range(30):
            driver.client.send(
                "SET_POSITION_TARGET_LOCAL_NED", **TARGET, coordinate_frame=1, type_mask=VELOCITY, vx=1.0, vy=0.5
            )
            driver.simulation.advance(0.1)
            received += driver.client.link.receive()
        return received

    driver.client.send("REQUEST_DATA_STREAM", **TARGET, req_stream_id=0, req_message_rate=10, start_stop=1)
    driver.client.send("PARAM_REQUEST_LIST", **TARGET)
    driver.wait(0.1)
    snapshot = driver.simulation.snapshot()
    first = record()
    assert driver.command(DO_SET_MODE, 1, RTL) == 0
    driver.wait(1.0)
    driver.simulation.restore(snapshot)
    assert record() == first and len(first) > 20_000
