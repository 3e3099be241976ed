# SPDX-License-Identifier: BSD-3-Clause
"""A real MAVSDK script at 20x: what the vehicle hears from it is what it would hear at 1x."""

import importlib.metadata
import json
import sys

import pytest

pytest.importorskip("pymavlink")

from tests.warp.drive import SCRIPTS, run
from tests.warp.fake_vehicle import FakeVehicle

LAND, TERMINATE = 21, 185


def mavsdk_generation() -> int:
    """The major version of the installed mavsdk package; 0 if there is none."""
    try:
        return int(importlib.metadata.version("mavsdk").split(".")[0])
    except importlib.metadata.PackageNotFoundError:
        return 0


@pytest.mark.slow
@pytest.mark.skipif(mavsdk_generation() < 4, reason="needs mavsdk 4 or newer")
def test_native_mavsdk_behaves_as_at_real_time():
    vehicle = FakeVehicle()
    vehicle.deaf, vehicle.silent_on = {LAND}, TERMINATE
    try:
        output, _ = run([sys.executable, str(SCRIPTS / "native_mavsdk.py"), str(vehicle.port)], 20.0, vehicle)
    finally:
        vehicle.close()
    check(vehicle, json.loads(next(line for line in output.splitlines() if line.startswith("{"))))


def check(vehicle: FakeVehicle, measured: dict) -> None:
    """Heartbeats, off-board set-points, retransmissions and time-outs, all in simulated time."""
    assert all(abs(interval - 1.0) < 0.5 for interval in vehicle.intervals("HEARTBEAT"))
    setpoints = vehicle.intervals("SET_POSITION_TARGET_LOCAL_NED")
    assert 150 <= len(setpoints) <= 230  # every 50 ms for 10 s
    assert max(setpoints) < 1.0  # far from the vehicle's time-out of 3 s
    assert [round(interval, 1) for interval in vehicle.intervals(f"COMMAND_{LAND}")] == pytest.approx([0.5] * 3, abs=0.2)
    assert "TIMEOUT" in measured["land"]
    assert measured["land_s"] == pytest.approx(2.0, abs=0.5)
    assert measured["lost_s"] == pytest.approx(3.0, abs=1.0)
    assert measured["speed_factor"] == pytest.approx(1.0, abs=0.1)
    assert len(vehicle.mission_items) == 5
    assert measured["upload_s"] < 1.0
