# SPDX-License-Identifier: BSD-3-Clause
"""Real client libraries at 20x: what the vehicle hears from their scripts is what it would hear at 1x."""

import importlib.metadata
import json
import sys

import pytest

pytest.importorskip("pymavlink")

from tests.warp.drive import SCRIPTS, patiently, run
from tests.warp.fake_vehicle import FakeVehicle

LAND, TERMINATE = 21, 185


def installed(package: str) -> int:
    """The major version of an installed package; 0 if there is none."""
    try:
        return int(importlib.metadata.version(package).split(".")[0])
    except importlib.metadata.PackageNotFoundError:
        return 0


def fly(script: str, speedup: float | str) -> tuple[FakeVehicle, dict]:
    """Run one of the scripts; returns the vehicle it talked to and what the script measured."""
    vehicle = FakeVehicle()
    vehicle.deaf, vehicle.silent_on = {LAND}, TERMINATE
    try:
        output, _ = run([sys.executable, str(SCRIPTS / script), str(vehicle.port)], speedup, vehicle)
    finally:
        vehicle.close()
    return vehicle, json.loads(next(line for line in output.splitlines() if line.startswith("{")))


@pytest.mark.slow
@pytest.mark.parametrize("speedup", [20.0, "max"])
@pytest.mark.skipif(installed("mavsdk") < 4, reason="needs mavsdk 4 or newer")
def test_native_mavsdk_behaves_as_at_real_time(speedup):
    patiently(lambda: check(*fly("native_mavsdk.py", speedup)))


@pytest.mark.slow
@pytest.mark.skipif(installed("mavsdk") != 3 and not installed("mavsdk-grpc"), reason="needs mavsdk 3 or mavsdk-grpc")
def test_grpc_mavsdk_behaves_as_at_real_time():
    patiently(lambda: check(*fly("grpc_mavsdk.py", 20.0)))


def test_pymavlink_behaves_as_at_real_time():
    patiently(lambda: check_pymavlink(*fly("pymavlink_script.py", 20.0)))


def check_pymavlink(vehicle: FakeVehicle, measured: dict) -> None:
    """Heartbeats and overrides in time, a question without answer given up after 3 s."""
    assert measured["armed"] and measured["ack_s"] < 1.0
    assert not measured["answer"]
    assert 3.0 <= measured["timeout_s"] < 4.0
    assert all(abs(interval - 1.0) < 0.5 for interval in vehicle.intervals("HEARTBEAT"))
    overrides = vehicle.intervals("RC_CHANNELS_OVERRIDE")
    assert len(overrides) == 99
    assert max(overrides) < 1.0


def check(vehicle: FakeVehicle, measured: dict) -> None:
    """Heartbeats, off-board set-points, retransmissions and time-outs, all in simulated time."""
    # The library's first interval is shorter at 1x as well.
    assert all(abs(interval - 1.0) < 0.5 for interval in vehicle.intervals("HEARTBEAT")[1:])
    setpoints = vehicle.intervals("SET_POSITION_TARGET_LOCAL_NED")
    assert 150 <= len(setpoints) <= 230  # every 50 ms for 10 s
    assert max(setpoints) < 1.0  # far from the vehicle's time-out of 3 s
    assert vehicle.intervals(f"COMMAND_{LAND}") == pytest.approx([0.5] * 3, abs=0.2)
    assert "TIMEOUT" in measured["land"]
    assert measured["land_s"] == pytest.approx(2.0, abs=0.5)
    assert measured["lost_s"] == pytest.approx(3.0, abs=1.0)
    assert measured["speed_factor"] == pytest.approx(1.0, abs=0.1)
    assert len(vehicle.mission_items) == 5
    assert measured["upload_s"] < 1.0
