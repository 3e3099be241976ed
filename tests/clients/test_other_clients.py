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


def test_mavsdk_grpc(fly: Fly) -> None:
    pytest.importorskip("mavsdk_grpc")
    fly(SCRIPTS / "grpc_flight.py", "udpin://127.0.0.1:PORT")


@pytest.mark.skipif(not installed("dronekit"), reason="DroneKit is not installed")
def test_dronekit(fly: Fly) -> None:
    fly(SCRIPTS / "dronekit_flight.py", "udpin:127.0.0.1:PORT")


@pytest.mark.skipif(not installed("MAVProxy"), reason="MAVProxy is not installed")
def test_mavproxy(fly: Fly) -> None:
    fly(SCRIPTS / "mavproxy_session.py", "udpin:127.0.0.1:PORT")
