# SPDX-License-Identifier: BSD-3-Clause
"""The checks that both firmwares know."""

from __future__ import annotations

from sitl.autopilot import arming_checks


def test_every_check_is_a_bit_of_its_own_and_has_a_text() -> None:
    public = {name: value for name, value in vars(arming_checks).items() if name.isupper() and isinstance(value, int)}
    bits = [value for name, value in public.items() if not name.startswith(("BY_", "CHECK_", "_"))]
    assert sorted(bits) == sorted(arming_checks.TEXTS)
    assert len(set(bits)) == len(bits) and all(bit & (bit - 1) == 0 for bit in bits)


def test_a_missing_home_explains_the_missing_position() -> None:
    missing = arming_checks.WAITING_FOR_HOME | arming_checks.NEED_POSITION
    assert arming_checks.texts(missing, "Arm: ") == ["Arm: AHRS: waiting for home"]
