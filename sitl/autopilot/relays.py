# SPDX-License-Identifier: BSD-3-Clause
"""Relays: switches on the board's pins (RELAYn_*). The pins are the bits of SIM_PIN_MASK. The core does not read these.

Numbers count from 0, those of parameters from 1.
"""

from __future__ import annotations

from .params.table import Values

RELAYS = 6
PINS = 15
"""So many bits SIM_PIN_MASK has."""
SWITCH, CAMERA = 1, 4
"""RELAYn_FUNCTION of a relay for commands and missions, and of one that triggers the camera."""
OFF_AT_BOOT, ON_AT_BOOT = 0, 1
"""RELAYn_DEFAULT; any other leaves it."""
MASK = "SIM_PIN_MASK"

MEANINGS = {
    MASK: "State of the board's pins, a bit each: relays switch theirs",
    **{
        f"RELAY{n}_{name}": doc.format(n=n)
        for n in range(1, RELAYS + 1)
        for name, doc in (
            ("FUNCTION", "1: relay {n} is there for commands and missions; 4: it triggers the camera; 0: neither"),
            ("PIN", "Pin of relay {n}, 0 to 14; -1 none"),
            ("DEFAULT", "Relay {n} at boot: 0 off, 1 on, 2 as it was"),
            ("INVERTED", "1: the pin of relay {n} is low when the relay is on"),
        )
    },
}
"""Parameters that are read here, and what they do."""


def is_fitted(values: Values, relay: int) -> bool:
    """Whether there is such a relay."""
    return 0 <= relay < RELAYS and values[f"RELAY{relay + 1}_FUNCTION"] == SWITCH


def _pin_bit(values: Values, relay: int) -> int:
    pin = int(values[f"RELAY{relay + 1}_PIN"])
    return 1 << pin if 0 <= pin < PINS else 0


def is_on(values: Values, relay: int) -> bool:
    """Whether it is on; one without a pin never is."""
    bit = _pin_bit(values, relay)
    high = int(values[MASK]) & bit != 0
    return bit != 0 and high != (values[f"RELAY{relay + 1}_INVERTED"] == 1.0)


def switch(values: Values, relay: int, on: bool) -> None:
    """Switch it."""
    bit, mask = _pin_bit(values, relay), int(values[MASK])
    high = on != (values[f"RELAY{relay + 1}_INVERTED"] == 1.0)
    switched = mask | bit if high else mask & ~bit
    if switched != mask:
        values[MASK] = float(switched)


def fitted(values: Values) -> list[int]:
    """Those that are there."""
    return [relay for relay in range(RELAYS) if is_fitted(values, relay)]


def of_camera(values: Values) -> list[int]:
    """Those that trigger the camera."""
    return [relay for relay in range(RELAYS) if values[f"RELAY{relay + 1}_FUNCTION"] == CAMERA]


def power_on(values: Values) -> None:
    """At boot they are as RELAYn_DEFAULT says."""
    for relay in fitted(values) if MASK in values.table else ():
        at_boot = values[f"RELAY{relay + 1}_DEFAULT"]
        if at_boot in (OFF_AT_BOOT, ON_AT_BOOT):
            switch(values, relay, at_boot == ON_AT_BOOT)
