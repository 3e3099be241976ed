# SPDX-License-Identifier: BSD-3-Clause
"""Two barometers: which of them gives the height (BARO_PRIMARY, and what is healthy)."""

from __future__ import annotations

from ..core.border import BAROS_DIFFER, Sensors
from ..core.constants import TICK_US
from ..core.kernels import law
from ..core.records import Floats, Ints, Record, array

SILENCE_US, FROZEN_US = 500_000, 2_000_000
"""A barometer is healthy while its last sample is no older, and its pressure or temperature has changed in this time:
one that freezes in the air is not found out, as with ArduPilot, since its temperature goes on changing."""


class Barometers(Record):
    """What is known of both barometers, while they differ."""

    primary: int  # whose samples the filter gets: 0 the first's, 1 the second's
    looked_us: int  # at both of them, last
    seen: Ints = array(2, stored="i8")  # counts of samples
    pressure: Floats = array(2, stored="f4")  # [hPa], and the temperature [degC] on top: it changes with either
    received_us: Ints = array(2, stored="i8")  # last sample
    changed_us: Ints = array(2, stored="i8")  # last one that was another


@law
def _look(baros: Barometers, k: int, count: int, pressure: float, now_us: int) -> None:
    """Note a new sample of barometer ``k``."""
    if count == baros.seen[k]:
        return
    baros.seen[k] = count
    baros.received_us[k] = now_us
    before = float(baros.pressure[k])
    baros.pressure[k] = pressure
    if float(baros.pressure[k]) != before:  # at the precision at which it is kept
        baros.changed_us[k] = now_us


@law
def is_healthy(baros: Barometers, k: int, now_us: int) -> bool:
    """Whether barometer ``k`` is heard, and not frozen."""
    return now_us - baros.received_us[k] <= SILENCE_US and now_us - baros.changed_us[k] <= FROZEN_US


@law
def choose(baros: Barometers, sensors: Sensors, wanted: float, now_us: int) -> None:
    """Each tick in which the barometers differ; ``wanted``: BARO_PRIMARY."""
    if now_us - baros.looked_us > TICK_US:  # until now they did not
        for k in range(2):
            baros.received_us[k] = now_us
            baros.changed_us[k] = now_us
    baros.looked_us = now_us
    _look(baros, 0, sensors.baro_count, sensors.abs_pressure + sensors.temperature, now_us)
    _look(baros, 1, sensors.baro2_count, sensors.abs_pressure2 + sensors.temperature, now_us)
    first = 1 if wanted == 1.0 else 0
    if is_healthy(baros, first, now_us) or not is_healthy(baros, 1 - first, now_us):
        baros.primary = first
    else:
        baros.primary = 1 - first


@law
def uses_second(baros: Barometers, sensors: Sensors) -> bool:
    """Whether the filter gets the second barometer's samples."""
    return sensors.baro_state & BAROS_DIFFER != 0 and baros.primary == 1


@law
def are_healthy(baros: Barometers, sensors: Sensors, now_us: int) -> bool:
    """Whether, of two that differ, both are; as far as that is known."""
    if sensors.baro_state & BAROS_DIFFER == 0 or baros.looked_us == 0:
        return True
    return is_healthy(baros, 0, now_us) and is_healthy(baros, 1, now_us)
