# SPDX-License-Identifier: BSD-3-Clause
"""Faults in the air, beside those of a real ArduPilot.

The figures "of ArduPilot" were flown with its unmodified 4.7-dev executable, frame +, hovering at 10 m in calm air.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults
from sitl.missions.testing.vehicle import Copter

FRAME = "ardupilot_quad"
Fly = Callable[..., Copter]


def hover(copter: Copter) -> None:
    copter.takeoff(10)
    copter.set_rc(roll=1500, pitch=1500, throttle=1500, yaw=1500)
    copter.change_mode("LOITER")
    copter.delay(5)


@pytest.fixture
def fly(tmp_path: Path) -> Iterator[Fly]:
    """Makes copters that hover."""
    factory = VehicleFactory(Defaults(folders=(tmp_path,)), GoldenStore(tmp_path, test="a fault"), tmp_path / "logs")
    yield lambda **options: factory("copter", frame=FRAME, after=hover, **options)
    factory.close()


def where(copter: Copter) -> np.ndarray:
    """True north, east, height [m]."""
    x, y, z = copter.simulation.v.physics.body.pos
    return np.array((x, y, -z))


def lean(copter: Copter) -> float:
    """Pitch [deg], nose up positive."""
    return float(np.degrees(copter.attitude[1]))


def watch(copter: Copter, seconds: float) -> np.ndarray:
    """True places, ten a second, shape (n, 3)."""
    rows = []
    for _ in range(round(10 * seconds)):
        copter.delay(0.1)
        rows.append(where(copter))
    return np.array(rows)


def heard(copter: Copter, text: str, since: float) -> float:
    """When a text came [s since ``since``]."""
    return next(t.time for t in copter.texts if text in t.text and t.time >= since) - since


def test_gps_glitch(fly: Fly) -> None:
    """22 m to the north. ArduPilot: a text after 1.45 s, the estimate follows after 10 s; the copter stays within
    0.1 m, in LOITER, there and back.
    """
    copter = fly()
    start, at = copter.now, where(copter)
    copter.fail("gps", "wrong", amount=22.26)
    seen = watch(copter, 8)
    assert heard(copter, "GPS Glitch or Compass error", start) == pytest.approx(1.45, abs=0.5)
    assert abs(copter.position.north - at[0]) < 2.0
    seen = np.vstack((seen, watch(copter, 8)))
    assert copter.position.north - at[0] == pytest.approx(22.2, abs=1.5)
    assert np.abs(seen - at).max() < 1.0 and copter.mode == "LOITER"
    copter.restore("gps")
    assert np.abs(watch(copter, 14) - at).max() < 1.2
    assert copter.position.north == pytest.approx(where(copter)[0], abs=1.5)


@pytest.mark.parametrize(("name", "value"), [("NOISE", 10), ("DRFTALT", 10), ("ALT_OFS", 5), ("GLTCH_Z", 5)])
def test_height_does_not_come_from_the_receiver(fly: Fly, name: str, value: float) -> None:
    """ArduPilot: the altitude that the receiver tells is off by so much, the height held by 0.1 m at most."""
    copter = fly()
    before = where(copter)
    copter.set_rate("GPS_RAW_INT", 5)
    copter.fail(f"SIM_GPS1_{name}", amount=value)
    with copter.messages("GPS_RAW_INT") as told:
        seen = watch(copter, 13)
    off = [1e-3 * message.alt - 584.0 - before[2] for message in told[2:]]
    assert max(off) == pytest.approx(value, rel=0.25, abs=1.0)
    assert (min(off) < -0.8 * value) == (name == "NOISE")
    assert np.abs(seen - before).max() < 1.0


def test_satellites_are_told_and_no_more(fly: Fly) -> None:
    """ArduPilot hovers on with three: their number counts before take-off only."""
    copter = fly()
    before = where(copter)
    copter.fail("SIM_GPS1_NUMSATS", amount=3)
    assert np.abs(watch(copter, 5) - before).max() < 1.0
    assert copter.message("GPS_RAW_INT").satellites_visible == 3


def test_barometer_glitch(fly: Fly) -> None:
    """10 m too high, in ALT_HOLD. ArduPilot sinks to 5.9 m in 4 s and to 0.8 m in 12 s, and climbs back when it ends:
    7.6 m after 4 s.
    """
    copter = fly()
    copter.change_mode("ALT_HOLD")
    high = where(copter)[2]
    copter.fail("baro", "wrong", amount=10)
    seen = watch(copter, 12)[:, 2] - high
    assert seen[39] == pytest.approx(-4.2, abs=1.0) and seen[-1] == pytest.approx(-9.3, abs=1.0)
    assert copter.height == pytest.approx(10, abs=0.7)
    copter.restore("baro")
    seen = watch(copter, 10)[:, 2] - high
    assert seen[39] == pytest.approx(-2.4, abs=1.2) and abs(seen[-1]) < 1.2


def test_barometer_drift(fly: Fly) -> None:
    """0.5 m/s. ArduPilot sinks by 4.9 m in 12 s and stays low when the drift ends: what has drifted is still there."""
    copter = fly()
    high = where(copter)[2]
    copter.fail("baro", "slow", amount=0.5, until=12.0)
    seen = watch(copter, 22)[:, 2] - high
    assert seen[119] == pytest.approx(-4.6, abs=1.0) and seen[-1] == pytest.approx(-6.0, abs=1.0)


def test_frozen_barometer(fly: Fly) -> None:
    """Throttle at 1700 us for 6 s. ArduPilot climbs by 5.1 m and believes 2.7 m, then on at 1.3 m/s."""
    copter = fly()
    high = where(copter)[2]
    copter.fail("baro", "stuck")
    copter.delay(1)
    copter.set_rc(throttle=1700)
    copter.delay(6)
    copter.set_rc(throttle=1500)
    assert where(copter)[2] - high == pytest.approx(5.1, abs=1.5)
    assert copter.height - 10 < 0.7 * (where(copter)[2] - high)
    before = where(copter)[2]
    copter.delay(5)
    assert (where(copter)[2] - before) / 5 == pytest.approx(1.3, abs=0.7)
    copter.restore("baro")
    copter.delay(14)
    assert copter.height == pytest.approx(where(copter)[2], abs=1.0)


def test_late_barometer_and_noise(fly: Fly) -> None:
    """The height swings more, and is held all the same."""
    for kind, amount in (("delayed", 0.5), ("garbage", 3.0)):
        copter = fly()
        high = where(copter)[2]
        copter.fail("baro", kind, amount=amount)
        seen = watch(copter, 10)[:, 2] - high
        assert 0.05 < np.abs(seen).max() < 2.5, kind


def test_no_barometer(fly: Fly) -> None:
    """The barometer's bit of SYS_STATUS goes out."""
    baro = 8
    copter = fly()
    copter.fail("baro")
    copter.delay(5)
    assert not copter.message("SYS_STATUS").onboard_control_sensors_health & baro
    copter.restore("baro")
    copter.delay(3)
    assert copter.message("SYS_STATUS").onboard_control_sensors_health & baro


@pytest.mark.parametrize(
    ("params", "pitch"),
    [
        ({"SIM_WIND_T": 1}, 29.1),
        ({"SIM_WIND_T": 0}, 9.0),
        ({"SIM_WIND_T": 2, "SIM_WIND_T_COEF": 0.1}, 11.8),
    ],
)
def test_wind_by_height(fly: Fly, params: dict[str, float], pitch: float) -> None:
    """10 m/s from the south at 60 m. ArduPilot leans by so much against it at 10 m."""
    copter = fly()
    for name, value in {**params, "SIM_WIND_SPD": 10}.items():
        copter.fail(name, amount=value)
    copter.delay(25)
    heading = np.radians(copter.heading)
    against = lean(copter) * np.cos(heading) - np.degrees(copter.attitude[0]) * np.sin(heading)
    assert against == pytest.approx(pitch, abs=1.2)


def test_wind_from_below(fly: Fly) -> None:
    """5 m/s, 30 degrees upwards: ArduPilot hovers with 33 % throttle in place of 36 %."""
    copter = fly()
    before = copter.message("VFR_HUD").throttle
    for name, value in {"SIM_WIND_DIR_Z": 30, "SIM_WIND_SPD": 5}.items():
        copter.fail(name, amount=value)
    copter.delay(25)
    assert copter.message("VFR_HUD").throttle - before == pytest.approx(-3, abs=1)


def test_twist_and_shove(fly: Fly) -> None:
    """1 rad/s/s about the vertical for 0.5 s. ArduPilot's heading goes off by 2.5 degrees and is back 1 s later."""
    copter = fly()
    heading = copter.heading
    turn = lambda: (copter.heading - heading + 180.0) % 360.0 - 180.0  # noqa: E731
    copter.fail("twist", amount=1.0)
    copter.delay(0.5)
    assert turn() == pytest.approx(2.5, abs=1.0)
    copter.delay(1.5)
    assert abs(turn()) < 1.0
    before = where(copter)
    copter.fail("shove", amount=4.0)
    seen = watch(copter, 10)
    assert np.hypot(*(seen - before)[:, :2].T).max() > 0.5
    assert np.hypot(*(seen - before)[-1, :2]) < 0.5


@pytest.mark.parametrize(("kind", "after"), [("off", 1.0), ("wrong", 0.1)])
def test_transmitter(fly: Fly, kind: str, after: float) -> None:
    """ArduPilot: "Radio Failsafe" and RTL 1.0 s after silence, 0.09 s after a throttle of 950 us; it lands from where
    it is, 10 m high, at 0.5 m/s after 7 s.
    """
    copter = fly(params={"RC_OVERRIDE_TIME": 0.5})
    copter.release_rc()
    copter.change_mode("ALT_HOLD")
    copter.delay(1.0)
    start = copter.now
    copter.fail("rc", kind)
    copter.wait_mode("RTL", timeout=3)
    assert heard(copter, "Radio Failsafe", start) == pytest.approx(after, abs=0.15)
    assert (copter.message("RC_CHANNELS").chan3_raw == 950) == (kind == "wrong")
