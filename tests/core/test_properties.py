# SPDX-License-Identifier: BSD-3-Clause
"""Properties of records: read by laws like fields, the same bits compiled; machine code depends on them."""

from __future__ import annotations

import math

import numba
import pytest

from sitl.core.compile import make_jitable
from sitl.core.fingerprint import fingerprint
from sitl.core.kernels import Unit, law
from sitl.core.numba_records import numba_type
from sitl.core.records import PROPERTIES, Record, Records
from sitl.core.vectors import Vec2


class Arrow(Record):
    """An arrow in the plane. Its properties have names that no law of the core reads: else the fingerprints of units
    that do would be other ones in this process."""

    tip: Vec2

    @property
    @law
    def shaft_length(self) -> float:
        """Of the arrow."""
        return math.sqrt(self.tip.x * self.tip.x + self.tip.y * self.tip.y)

    @property
    @law
    def shaft_normal(self) -> Vec2:
        """At right angles, of length 1; not finite for an arrow of no length."""
        return Vec2(-self.tip.y, self.tip.x) / self.shaft_length


class Dart(Arrow):
    """One that flies."""

    speed: float


@law
def work(darts: Records[Dart], k: int) -> float:
    """Length times speed and the normal's components."""
    dart = darts[k]
    return dart.speed * dart.shaft_length + 3.0 * dart.shaft_normal.x + dart.shaft_normal.y


def test_laws_read_properties() -> None:
    fleet = Dart.fleet(2)
    for k in range(2):
        dart = Dart.of(fleet, k)
        dart.tip, dart.speed = Vec2(0.3 * k, -0.7 * k), 1.1
    make_jitable()
    numba_type(Dart)

    @numba.njit(error_model="numpy")
    def call(darts: Records[Dart], k: int) -> float:
        return work(darts, k)

    assert call(fleet, 1) == work([Dart.of(fleet, k) for k in range(2)], 1)
    assert math.isnan(call(fleet, 0)), "a division by zero is no exception"


def test_machine_code_depends_on_properties(monkeypatch: pytest.MonkeyPatch) -> None:
    unit = Unit("work", work, 0)
    before = fingerprint(unit, (Dart,), "")
    monkeypatch.setitem(PROPERTIES, "shaft_length", [*PROPERTIES["shaft_length"], test_laws_read_properties])
    assert fingerprint(unit, (Dart,), "") != before
