# SPDX-License-Identifier: BSD-3-Clause
"""The airframe of a vehicle from its logs, each figure with a 95 % interval (docs/identify.md).

from sitl.identify import identify

found = identify(["flight.bin"], mass=1.8)
print(found.table())
found.write("my_copter.toml")
"""

from .figure import Figure
from .flight import FlightLog, IdentifyError
from .identification import Identification, identify

__all__ = ["Figure", "FlightLog", "Identification", "IdentifyError", "identify"]
