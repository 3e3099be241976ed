# SPDX-License-Identifier: BSD-3-Clause
"""MAVSDK 4 scripts against ``sitl exec``, over UDP."""

from __future__ import annotations

import pytest

from tests.clients.drive import FASTEST, SCRIPTS, Fly

pytestmark = pytest.mark.slow
pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")


@pytest.mark.parametrize("name", ["ground", "flight", "setpoints", "missions"])
def test_script(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"mavsdk_{name}.py", "udpin://127.0.0.1:PORT")


@pytest.mark.parametrize("name", ["ground", "drive", "missions"])
def test_rover_script(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"mavsdk_rover_{name}.py", "udpin://127.0.0.1:PORT", vehicle="rover", speedup=FASTEST)
