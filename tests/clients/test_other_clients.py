# SPDX-License-Identifier: BSD-3-Clause
"""Clients that are not among the project's own dependencies; each test runs where its client is installed."""

from __future__ import annotations

import importlib.metadata

import pytest

from tests.clients.drive import SCRIPTS, Fly

pytestmark = pytest.mark.slow


def installed(package: str) -> bool:
    try:
        importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


COPTER_AND_ROVER = pytest.mark.parametrize("vehicle", ["copter", "rover"])


@COPTER_AND_ROVER
def test_mavsdk_grpc(fly: Fly, vehicle: str) -> None:
    pytest.importorskip("mavsdk_grpc")
    script = {"copter": "grpc_flight.py", "rover": "grpc_rover.py"}[vehicle]
    fly(SCRIPTS / script, "udpin://127.0.0.1:PORT", vehicle=vehicle)


@pytest.mark.skipif(not installed("dronekit"), reason="DroneKit is not installed")
@COPTER_AND_ROVER
def test_dronekit(fly: Fly, vehicle: str) -> None:
    script = {"copter": "dronekit_flight.py", "rover": "dronekit_rover.py"}[vehicle]
    fly(SCRIPTS / script, "udpin:127.0.0.1:PORT", vehicle=vehicle)


@pytest.mark.skipif(not installed("MAVProxy"), reason="MAVProxy is not installed")
@COPTER_AND_ROVER
def test_mavproxy(fly: Fly, vehicle: str) -> None:
    script = {"copter": "mavproxy_session.py", "rover": "mavproxy_rover.py"}[vehicle]
    fly(SCRIPTS / script, "udpin:127.0.0.1:PORT", vehicle=vehicle)
