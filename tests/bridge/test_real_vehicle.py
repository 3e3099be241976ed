# SPDX-License-Identifier: BSD-3-Clause
"""Services that change the real firmware's state: motor test, servos, origin, missions, pre-arm texts."""

from __future__ import annotations

from itertools import pairwise

import pytest

from benchmarks.recorded.pilot import Pilot, items
from sitl.client.endpoint import Endpoint
from sitl.simulation import Core, Simulation

DO_SET_MODE = 176

MOTOR_TEST, SET_SERVO, SET_RELAY = 209, 183, 181
ACCEPTED, DENIED, FAILED = 0, 2, 4
MISSION = [
    (0, 16, -353632621, 1491652371, 584.0), (3, 22, 0, 0, 5.0),
    (3, 16, -353632000, 1491652371, 5.0), (3, 21, 0, 0, 0.0),
]  # fmt: skip


class Bench:
    """A vehicle with one client; ``command`` gives the result."""

    def __init__(self, core: Core, **options: object) -> None:
        self.simulation = Simulation("ardupilot_quad", core=core, **options)  # type: ignore[arg-type]
        self.client = Endpoint()
        self.simulation.bridge.add_link(self.client.link)
        self.texts: list[str] = []

    @property
    def pwm(self) -> list[int]:
        return [int(p) for p in self.simulation.v.actuators.pwm]

    @property
    def armed(self) -> bool:
        return bool(self.simulation.v.autopilot.arming.armed)

    def wait(self, seconds: float) -> list[int]:
        """Results of the acknowledgements that came meanwhile."""
        self.simulation.advance(seconds)
        received = self.client.receive()
        self.texts += [m.fields.text.decode() for m in received if m.name == "STATUSTEXT"]
        return [m.fields.result for m in received if m.name == "COMMAND_ACK"]

    def command(self, number: int, *p: float) -> int:
        self.client.command(number, *p)
        (result,) = self.wait(0.05)
        return result


@pytest.fixture
def bench(core: Core) -> Bench:
    found = Bench(core)
    found.wait(5.0)
    return found


@pytest.mark.parametrize(("order", "motor"), [(0, 2), (1, 2), (2, 0)])
def test_motor_test_turns_one_motor_for_a_while(bench: Bench, order: int, motor: int) -> None:
    """The first of a plus frame in the pilot's order is the front one, motor 3."""
    assert bench.command(MOTOR_TEST, 1, 0, 20, 2, 0, order) == ACCEPTED
    for _ in range(2):
        assert bench.armed and bench.pwm[:4] == [1200 if k == motor else 1000 for k in range(4)]
        bench.wait(0.9)
    bench.wait(0.3)
    assert not bench.armed and bench.pwm[:4] == [1000] * 4
    assert [t for t in bench.texts if "test" in t] == ["starting motor test", "finished motor test"]
    assert abs(float(bench.simulation.v.physics.body.pos[2])) < 0.01, "it stayed on the ground"


def test_motor_test_by_pulse_ends_with_a_disarming(bench: Bench) -> None:
    assert bench.command(MOTOR_TEST, 2, 1, 1500, 60, 1, 2) == ACCEPTED
    bench.wait(15.0)
    assert bench.armed and bench.pwm[1] == 1500, "longer than DISARM_DELAY"
    assert bench.command(400, 0) == ACCEPTED
    assert not bench.armed and bench.pwm[1] == 1000


@pytest.mark.parametrize(
    "p", [(0, 0, 10, 1), (5, 0, 10, 1), (1, 0, 101, 1), (1, 0, -1, 1), (1, 1, 900, 1), (1, 3, 10, 1)],
)  # fmt: skip
def test_a_motor_test_that_cannot_be_ends_as_it_begins(bench: Bench, p: tuple[float, ...]) -> None:
    """ArduCopter takes it, and gives it up at its first look."""
    assert bench.command(MOTOR_TEST, *p) == ACCEPTED
    bench.wait(0.1)
    assert not bench.armed and bench.pwm[:4] == [1000] * 4
    said = [t for t in bench.texts if "otor" in t]
    assert (said[0], said[-1]) == ("starting motor test", "finished motor test")
    assert ("Motor Test: cancelled" in said) == (p[0] in (0, 5))


def test_a_percentage_in_single_precision_is_a_whole_pulse(bench: Bench) -> None:
    assert bench.command(MOTOR_TEST, 1, 0, 90.1, 1, 1, 2) == ACCEPTED
    bench.wait(0.1)
    assert bench.pwm[0] == 1901


def test_a_motor_is_tested_by_the_throttle_stick(bench: Bench) -> None:
    bench.simulation.v.autopilot.rc.channels[2] = 1400
    assert bench.command(MOTOR_TEST, 1, 2, 0, 1, 1, 2) == ACCEPTED
    bench.wait(0.1)
    assert bench.pwm[0] == 1400


def test_motors_are_tested_in_turn_with_pauses(bench: Bench) -> None:
    """Two of them clockwise from the front of a plus frame, with half the time between."""
    assert bench.command(MOTOR_TEST, 1, 0, 20, 1, 2) == ACCEPTED
    seen = []
    for _ in range(14):
        seen.append([k for k in range(4) if bench.pwm[k] > 1000] if bench.armed else None)
        bench.wait(0.2)
    turning = [seen[0], *[b for a, b in pairwise(seen) if a != b]]
    assert turning == [[2], [], [0], None]
    assert [t for t in bench.texts if "test" in t] == ["starting motor test", "finished motor test"]


def test_a_series_of_motor_tests_ends_where_there_is_no_further_motor(bench: Bench) -> None:
    assert bench.command(MOTOR_TEST, 4, 0, 20, 0.2, 3) == ACCEPTED
    bench.wait(1.0)
    assert not bench.armed
    said = [t for t in bench.texts if "motor test" in t.lower()]
    assert said == ["starting motor test", "Motor Test: cancelled", "finished motor test"]


def test_a_series_of_motor_tests_ends_with_a_disarming(bench: Bench) -> None:
    assert bench.command(MOTOR_TEST, 1, 0, 20, 1, 4) == ACCEPTED
    assert bench.command(400, 0) == ACCEPTED
    bench.wait(5.0)
    assert not bench.armed and bench.pwm[:4] == [1000] * 4


def test_a_motor_test_disarms_who_was_armed_and_waits_for_who_flies(bench: Bench) -> None:
    bench.wait(20.0)
    assert bench.command(400, 1) == ACCEPTED
    assert bench.command(MOTOR_TEST, 1, 0, 10, 1) == ACCEPTED
    bench.wait(1.2)
    assert not bench.armed
    bench.simulation.v.autopilot.arming.landed = 0
    assert bench.command(MOTOR_TEST, 1, 0, 10, 1) == FAILED
    assert "Motor Test: vehicle not landed" in bench.texts


def test_servos_behind_the_motors_are_free(bench: Bench) -> None:
    assert bench.command(SET_SERVO, 9, 1700) == ACCEPTED
    bench.wait(1.0)
    assert bench.pwm[8] == 1700
    assert float(bench.simulation.v.actuators.controls[8]) == pytest.approx(0.4)
    assert [bench.command(SET_SERVO, n, 1700) for n in (0, 1, 4, 17)] == [FAILED] * 4
    assert bench.command(SET_SERVO, 9, 1e9) == DENIED
    assert [bench.command(SET_RELAY, n, 1) for n in (0, 1)] == [ACCEPTED, FAILED]  # RELAY1 is there, RELAY2 is not


def test_an_origin_is_taken_once(core: Core) -> None:
    bench = Bench(core)
    bench.wait(10.0)
    place = {"target_system": 1, "latitude": -353632620, "longitude": 1491652370, "altitude": 500_000}
    bench.client.send("SET_GPS_GLOBAL_ORIGIN", **place)
    bench.simulation.advance(0.05)
    reported = [m.fields for m in bench.client.receive() if m.name == "GPS_GLOBAL_ORIGIN"]
    assert [(m.latitude, m.longitude, m.altitude) for m in reported] == [(-353632620, 1491652370, 500_000)]
    bench.client.send("SET_GPS_GLOBAL_ORIGIN", **{**place, "latitude": 10})
    bench.simulation.advance(0.05)
    assert not [m for m in bench.client.receive() if m.name == "GPS_GLOBAL_ORIGIN"]


def test_prearm_failures_are_said_every_30_s(bench: Bench) -> None:
    assert bench.command(DO_SET_MODE, 1, 4) == ACCEPTED
    bench.wait(24.8)
    assert not [t for t in bench.texts if t.startswith("PreArm: ")]
    bench.wait(1.0)
    said = [t for t in bench.texts if t.startswith("PreArm: ")]
    assert "PreArm: Need Position Estimate" in said
    bench.wait(29.5)
    assert [t for t in bench.texts if t.startswith("PreArm: ")] == said, "ready by then"


def test_parameters_that_the_firmware_owns_are_not_set(bench: Bench) -> None:
    bench.client.send("PARAM_SET", param_id=b"MIS_TOTAL", param_value=5, param_type=4)
    bench.simulation.advance(0.05)
    values = [m.fields for m in bench.client.receive() if m.name == "PARAM_VALUE"]
    assert [(m.param_id, m.param_value) for m in values] == [(b"MIS_TOTAL", 0.0)]


def test_mission_start_starts_again_when_auto_is_over(core: Core) -> None:
    """AUTO stays selected after the landing; MISSION_START must fly the mission once more."""
    pilot = Pilot(Simulation(core=core))
    pilot.boot()
    pilot.transfer(items(MISSION))
    for flight in (1, 2):
        pilot.simulation.v.autopilot.params.AUTO_OPTIONS = 3.0
        pilot.send_command("DO_SET_MODE", 1, 3)
        pilot.arm(1.0)
        pilot.send_command("MISSION_START")
        pilot.wait_disarmed(90.0)
        assert pilot.reached.count(2) == flight
