# SPDX-License-Identifier: BSD-3-Clause
"""Events of the core."""

from __future__ import annotations

from sitl.autopilot import events


def test_every_event_has_a_number_of_its_own() -> None:
    codes = {name: code for name, code in vars(events).items() if name.isupper() and isinstance(code, int)}
    del codes["EVENT_RING"]
    assert sorted(codes.values()) == sorted(set(codes.values()))
