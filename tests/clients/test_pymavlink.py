# SPDX-License-Identifier: BSD-3-Clause
"""pymavlink scripts against ``sitl exec``, over UDP."""

from __future__ import annotations

import pytest

from tests.clients.drive import FASTEST, SCRIPTS, Fly

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["setpoints", "sticks", "missions"])
def test_script(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"pymavlink_{name}.py", "udpin:127.0.0.1:PORT")


@pytest.mark.parametrize("name", ["setpoints", "sticks", "missions"])
def test_rover_script(fly: Fly, name: str) -> None:
    fly(SCRIPTS / f"pymavlink_rover_{name}.py", "udpin:127.0.0.1:PORT", vehicle="rover", speedup=FASTEST)
