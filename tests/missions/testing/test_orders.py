# SPDX-License-Identifier: BSD-3-Clause
"""What a test tells its vehicle, and what it waits for: places, sticks, faults, missions, texts, heights."""

from __future__ import annotations

import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.links import LinkFaults
from sitl.bridge.services.failure_injection import FaultService
from sitl.client.waits import turn
from sitl.errors import OptionError
from sitl.missions.library import entries
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.logs import fly_again
from sitl.missions.testing.vehicle import Copter
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import load


def test_a_velocity_stays_until_another_order(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_velocity(0, 3)
    copter.delay(10)  # longer than GUID_TIMEOUT
    assert copter.telemetry.velocity[1] == pytest.approx(3, abs=0.3)
    copter.set_position(*copter.position[:2])
    copter.delay(10)
    assert copter.groundspeed < 0.5


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_no_finite_number_is_no_order(make: VehicleFactory, value: float) -> None:
    copter = make("copter")
    for order, name in (
        (lambda: copter.fly_to(north=value, east=0), "north"),
        (lambda: copter.fly_to(0, value), "east"),
        (lambda: copter.fly_to(0, 0, height=value), "height"),
        (lambda: copter.set_position(0, 0, yaw=value), "yaw"),
        (lambda: copter.set_velocity(0, 0, value), "down"),
        (lambda: copter.takeoff(value), "height"),
        (lambda: copter.take_off(value), "altitude"),
    ):
        with pytest.raises(OptionError, match=f"^{name} = {value}: a finite number is needed"):
            order()
    assert not copter.armed


def test_velocities_of_the_body(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_position(0, 0, yaw=90)
    copter.wait_heading(90, accuracy=1, hold=1)
    copter.set_velocity(2, 0, body=True)
    copter.wait_groundspeed(1.8)
    assert copter.telemetry.velocity[1] > 1.7


def test_sticks_are_held_and_given_back(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.set_rc(throttle=1500, pitch=1400)
    copter.change_mode("LOITER")
    copter.delay(6)  # longer than RC_OVERRIDE_TIME
    assert copter.groundspeed > 1
    copter.set_rc({2: 1500})
    copter.wait_groundspeed(0, 0.3)
    assert copter.message("RC_CHANNELS").chan3_raw == 1500
    copter.release_rc()
    copter.delay(0.5)
    assert copter.message("RC_CHANNELS").chan3_raw != 1500
    with pytest.raises(ValueError, match="no stick 'collective'"):
        copter.set_rc(collective=1500)
    with pytest.raises(ValueError, match="no channel 19"):
        copter.set_rc({19: 1500})


def test_parameters_undo_themselves(make: VehicleFactory) -> None:
    copter = make("copter")
    before = copter.parameter("ANGLE_MAX")
    with copter.parameters({"WPNAV_SPEED": 300}, ANGLE_MAX=2000):
        assert copter.parameter("ANGLE_MAX") == 2000
        assert copter.parameter("WPNAV_SPEED") == 300
    assert copter.parameter("ANGLE_MAX") == before
    with pytest.raises(ZeroDivisionError), copter.parameters(ANGLE_MAX=2000):
        raise ZeroDivisionError
    assert copter.parameter("ANGLE_MAX") == before


def test_parameters_that_cannot_be_set(make: VehicleFactory) -> None:
    copter = make("copter")
    with pytest.raises(ValueError, match="no parameter 'ANGLE_MAXX'; near to it: ANGLE_MAX"):
        copter.set_parameter("ANGLE_MAXX", 1)
    with pytest.raises(ValueError, match="no parameter"), copter.parameters(ANGLE_MAX=2000, NO_SUCH=1):
        raise ZeroDivisionError
    with pytest.raises(AssertionError, match="was not set to 99999"):
        copter.set_parameter("ANGLE_MAX", 99999)


def test_faults_come_and_go(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(10)
    with copter.fail("wind", speed=9, direction=270):
        assert copter.parameter("SIM_WIND_SPD") == 9
        with copter.fork():
            copter.fail("motor", motor=2)
            copter.wait_altitude(-math.inf, 2, timeout=20)
    assert copter.parameter("SIM_WIND_SPD") == 0
    assert copter.height == pytest.approx(10, abs=1)
    gps = copter.fail("gps")
    copter.wait_mode("LAND")
    gps.repair()
    with pytest.raises(ValueError, match="there is no fault 'engine'; there are gps"):
        copter.fail("engine")
    with pytest.raises(ValueError, match="there is no fault 'twist'"):
        make("rover").fail("twist")


def test_a_fault_ends_alone(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter", params={"SIM_WIND_DIR": 45})
    has = lambda *names: [copter.parameter(f"SIM_{name}") for name in names]  # noqa: E731
    with copter.fail("motor", motor=1, thrust=0.5):
        with copter.fail("motor", motor=1, thrust=0.2), copter.fail("motor", instance=3, amount=0.1):
            assert has("ENGINE_FAIL", "ENGINE_MUL") == [5, pytest.approx(0.1)]
        assert has("ENGINE_FAIL", "ENGINE_MUL") == [1, 0.5]
    assert has("ENGINE_FAIL", "ENGINE_MUL") == [0, 0]
    with copter.fail("motor"):
        assert has("ENGINE_FAIL") == [255]
    copter.fail("wind", speed=9, direction=270, turbulence=1)
    copter.restore("wind")
    assert has("WIND_SPD", "WIND_DIR", "WIND_TURB") == [0, 45, 0]
    with copter.fail("wind", amount=3):
        assert has("WIND_SPD", "WIND_DIR") == [3, 0]
    assert has("WIND_SPD", "WIND_DIR", "WIND_TURB") == [0, 45, 0]
    copter.fail("gps", "wrong")
    copter.fail("gps")
    copter.restore("gps/wrong")
    assert has("GPS1_ENABLE", "GPS1_GLTCH_X") == [0, 0]
    copter.fail("gyro")
    copter.restore("gyro:1")
    assert has("GYR1_BIAS_X", "GYR2_BIAS_X") == [0, 0.5]
    assert fly_again(copter, tmp_path, "again", log=False).same


def test_faults_of_another_autopilot_are_its_parameters() -> None:
    kind = KINDS["copter"]
    plant = SimpleNamespace(vehicle=SimpleNamespace(airframe=load("erle_copter")))

    class Other(Copter):
        params = {p.name: p.default for p in kind.firmware.table} | {"SIM_WIND_DIR": 45.0}  # type: ignore[assignment]
        connection: Any = SimpleNamespace(simulation=None, kind=kind, time_us=0, plant=plant)
        _faults = None

    copter: Any = object.__new__(Other)
    copter.failures, copter._of_client = [], {}
    has = lambda *names: [copter.params[f"SIM_{name}"] for name in names]  # noqa: E731
    with copter.fail("wind", speed=9, direction=270), copter.fail("motor", motor=1), copter.fail("gyro"):
        with copter.fail("motor", motor=3, thrust=0.5):
            assert has("ENGINE_FAIL", "ENGINE_MUL", "WIND_SPD", "WIND_DIR") == [5, 0.5, 9, 270]
        assert has("ENGINE_FAIL", "ENGINE_MUL") == [1, 0]
        copter.restore("gyro:1")
        assert has("GYR1_BIAS_X", "GYR2_BIAS_X") == [0, 0.5]
    assert has("ENGINE_FAIL", "WIND_SPD", "WIND_DIR", "GYR2_BIAS_X") == [0, 0, 45, 0]
    with pytest.raises(OptionError, match="of another autopilot it begins now"):
        copter.fail("gps", at=3.0)
    with pytest.raises(OptionError, match="there is no number 6; airframe erle_copter has 1, 2, 3, 4"):
        copter.fail("motor:6=0")


def test_an_argument_that_does_nothing_is_refused(make: VehicleFactory) -> None:
    copter = make("copter")
    refused: tuple[tuple[str, dict[str, Any], str], ...] = (
        ("gps", {"thrust": 0.5}, "fault 'gps' takes no thrust"),
        ("baro", {"speed": 3.0}, "fault 'baro' takes no speed"),
        ("motor", {"motor": 2, "instance": 3}, "motor=2 and instance=3 say the same"),
        ("motor", {"thrust": 0.2, "amount": 0.3}, "thrust=0.2 and amount=0.3 say the same"),
        ("motor", {"type": "stuck", "thrust": 0.2}, "fault motor/stuck takes no amount"),
        ("wind", {"type": "off"}, "fault wind has no type 'off'"),
        ("wind", {"instance": 2}, "fault wind: there is no number 2"),
        ("gps", {"faults": LinkFaults(loss=0.1)}, "fault 'gps' takes no faults"),
        ("station", {"amount": 1.0}, "it has no type, instance or amount"),
        ("link", {"type": "off"}, "it has no type, instance or amount"),
    )
    for what, arguments, why in refused:
        with pytest.raises(OptionError, match=why):
            copter.fail(what, **arguments)
    with pytest.raises(OptionError, match="fault motor: there is no number 9"):
        copter.restore("motor:9")
    assert copter.simulation.bridge.get(FaultService).texts == []


def test_faults_come_at_their_times(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter")
    copter.takeoff(10)
    copter.fail("gps", at=2.0, until=30.0)
    copter.fail("baro", "garbage", amount=1.5, at=1.0)
    gps = copter.simulation.v.physics.sensors
    copter.delay(1.95)
    assert not gps.gps[0].off and copter.simulation.parameters["SIM_BARO_RND"] == 1.5
    with copter.fork():
        copter.restore("")
        copter.delay(0.1)
        assert not gps.gps[0].off and copter.parameter("SIM_BARO_RND") == pytest.approx(0.2)
    copter.delay(0.1)
    assert gps.gps[0].off
    copter.wait_mode("LAND", timeout=20)
    copter.restore("gps")
    assert copter.parameter("SIM_GPS1_ENABLE") == 1
    assert fly_again(copter, tmp_path, "again", log=False).same
    for what in ("station", "link"):
        with pytest.raises(OptionError, match="this client's, and begins now"):
            copter.fail(what, at=1.0)


def test_a_silent_station_is_missed(make: VehicleFactory) -> None:
    copter = make("copter", params={"FS_GCS_ENABLE": 1})
    copter.takeoff(10)
    copter.delay(10)
    assert copter.mode == "GUIDED"
    copter.fail("station")
    copter.wait_mode("RTL", timeout=10)


def test_a_cut_link_is_missed_and_comes_back(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter", params={"FS_GCS_ENABLE": 1}, link_faults=LinkFaults(delay=0.1))
    copter.takeoff(10)
    with copter.fail("link"):
        copter.delay(10)
        assert copter.mode == "GUIDED"  # as far as the station can know
    copter.wait_mode("RTL", timeout=1)
    copter.fail("link", faults=LinkFaults(loss=0.3, delay=(0.1, 0.4)))
    copter.change_mode("GUIDED", timeout=10)
    again = fly_again(copter, tmp_path, "again", log=False)
    assert again.same


def test_a_mission_is_flown(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.upload("copter/square")
    copter.start_mission()
    copter.wait_waypoint(2)
    assert copter.telemetry.item == 3
    copter.wait_current_waypoint(5)
    copter.wait_disarmed()
    copter.fly_mission("copter/triangle")
    assert copter.reached


def test_a_rover_drives_a_mission(make: VehicleFactory) -> None:
    rover = make("rover")
    rover.fly_mission("rover/square")
    assert not rover.armed and rover.mode == "AUTO"


def test_a_mission_that_is_not_ended_says_so(make: VehicleFactory) -> None:
    copter = make("copter", params={"FS_THR_ENABLE": 1, "FS_OPTIONS": 0, "SIM_RC_FAIL": 0})
    copter.upload("copter/square")
    copter.start_mission()
    copter.wait_waypoint(2)
    with pytest.raises(
        AssertionError, match="mission item 5 to be reached\n  last seen: reached 1, 2; on the way to 3"
    ):
        copter.wait_waypoint(5, timeout=2)


def test_mission_files_are_found_beside_the_test(make: VehicleFactory, tmp_path: Path) -> None:
    (tmp_path / "mine.plan").write_bytes(entries()["copter/square"].path.read_bytes())
    copter = make("copter")
    assert len(copter.upload("mine.plan")) == 7
    folder = re.escape(str(tmp_path))
    with pytest.raises(OptionError, match=f"no mission file 'yours.plan' in {folder}, and none in the library"):
        copter.upload("yours.plan")


def test_a_mission_of_elsewhere_is_no_mission_here(make: VehicleFactory) -> None:
    copter = make("copter", home=(47.0, 8.0, 500, 0))
    with pytest.raises(OptionError, match="km from home"):
        copter.upload("copter/square")


def test_a_rover_drives(make: VehicleFactory) -> None:
    rover = make("rover")
    rover.start()
    rover.set_position(30, 0)
    rover.set_speed(1.5)
    rover.delay(5)
    assert rover.groundspeed == pytest.approx(1.5, abs=0.3)
    rover.drive_to(8, 3)
    rover.stop()
    assert math.dist(rover.position[:2], (8, 3)) < 2


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
    with pytest.raises(ValueError, match=r"no mode 'THERMAL'; it has STABILIZE, .*LAND"):
        make("copter").change_mode("THERMAL")


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
    with pytest.raises(AssertionError, match="the request for HWSTATUS was refused"):
        copter.message("HWSTATUS")


def test_a_reboot_is_survived(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter")
    copter.reboot()
    copter.wait_ready()
    copter.takeoff(3)
    assert fly_again(copter, tmp_path, "flight", log=True).same


@pytest.mark.parametrize(("angle", "turned"), [(190, -170), (-190, 170), (360, 0), (720 + 5, 5)])
def test_turns_are_the_short_way(angle: float, turned: float) -> None:
    assert turn(angle) == pytest.approx(turned)
