# SPDX-License-Identifier: BSD-3-Clause
"""Scripts of real client libraries against ``sitl exec``, over UDP; each runs where its library is installed."""

from __future__ import annotations

import importlib.metadata

import pytest

from tests.clients.conftest import FASTEST, SCRIPTS, Fly

pytestmark = pytest.mark.slow

MAVSDK, UDP = "udpin://127.0.0.1:PORT", "udpin:127.0.0.1:PORT"
BAD_LINK = (
    "--link-loss", "0.2", "--link-delay", "0.1..0.3", "--link-duplicates", "0.05", "--link-reordering", "0.1",
)  # fmt: skip
COPTER_AND_ROVER = pytest.mark.parametrize("vehicle", ["copter", "rover"])


def installed(package: str) -> bool:
    try:
        importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


@pytest.mark.parametrize("name", ["ground", "flight", "setpoints", "missions", "failure", "as_published"])
def test_mavsdk(fly: Fly, name: str) -> None:
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    fly(SCRIPTS / f"mavsdk_{name}.py", MAVSDK)


def test_mavsdk_over_a_bad_link(fly: Fly) -> None:
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    fly(SCRIPTS / "mavsdk_bad_link.py", MAVSDK, *BAD_LINK)


def test_pymavlink_over_a_bad_link(fly: Fly) -> None:
    fly(SCRIPTS / "pymavlink_bad_link.py", UDP, *BAD_LINK)


@pytest.mark.parametrize("name", ["ground", "drive", "missions"])
def test_mavsdk_rover(fly: Fly, name: str) -> None:
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    fly(SCRIPTS / f"mavsdk_rover_{name}.py", MAVSDK, vehicle="rover", speedup=FASTEST)


@pytest.mark.parametrize("name", ["setpoints", "sticks", "missions"])
def test_pymavlink(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"pymavlink_{name}.py", UDP)


@pytest.mark.parametrize("name", ["setpoints", "sticks", "missions"])
def test_pymavlink_rover(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"pymavlink_rover_{name}.py", UDP, vehicle="rover", speedup=FASTEST)


@COPTER_AND_ROVER
def test_mavsdk_grpc(fly: Fly, vehicle: str) -> None:
    pytest.importorskip("mavsdk_grpc")
    script = {"copter": "grpc_flight.py", "rover": "grpc_rover.py"}[vehicle]
    # Its server ends when the vehicle is silent for 3 s in a transfer: at 20 times real time, 0.15 s of a busy machine.
    fly(SCRIPTS / script, MAVSDK, vehicle=vehicle, speedup=FASTEST)


@pytest.mark.skipif(not installed("dronekit"), reason="DroneKit is not installed")
@COPTER_AND_ROVER
def test_dronekit(fly: Fly, vehicle: str) -> None:
    script = {"copter": "dronekit_flight.py", "rover": "dronekit_rover.py"}[vehicle]
    fly(SCRIPTS / script, UDP, vehicle=vehicle)


@pytest.mark.skipif(not installed("dronekit"), reason="DroneKit is not installed")
def test_dronekit_attitudes(fly: Fly) -> None:
    fly(SCRIPTS / "dronekit_attitude.py", UDP)


@pytest.mark.skipif(not installed("MAVProxy"), reason="MAVProxy is not installed")
@COPTER_AND_ROVER
def test_mavproxy(fly: Fly, vehicle: str) -> None:
    script = {"copter": "mavproxy_session.py", "rover": "mavproxy_rover.py"}[vehicle]
    # MAVProxy works by the wall clock: at twenty times real time a busy machine makes its answers late for the vehicle.
    fly(SCRIPTS / script, UDP, vehicle=vehicle, speedup="4")


SWARM = ("--count", "3", "--spacing", "6")


def test_mavsdk_swarm(fly: Fly) -> None:
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    fly(SCRIPTS / "mavsdk_swarm.py", MAVSDK, *SWARM)


def test_pymavlink_swarm(fly: Fly) -> None:
    fly(SCRIPTS / "pymavlink_swarm.py", UDP, *SWARM)


def test_two_copters_that_are_sent_into_each_other_collide(fly: Fly) -> None:
    swarm = ("--count", "2", "--spacing", "6", "--estimator", "truth", "--home=-35.363262,149.165237,584,0")
    said = fly(SCRIPTS / "pymavlink_collision.py", UDP, *swarm)
    assert "ok: both were hit" in said
