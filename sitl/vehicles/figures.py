# SPDX-License-Identifier: BSD-3-Clause
"""Old name of ``sitl.vehicles.properties``: airframes in Python of version 0.1 import their constants from it."""

from __future__ import annotations

import sys

from ..deprecation import warn
from .properties import body, ground_vehicle, multicopter

warn("sitl.vehicles.figures", since="0.2", removed_in="0.4", instead="sitl.vehicles.properties")
for _name, _module in {"body": body, "copter": multicopter, "rover": ground_vehicle}.items():
    sys.modules[f"{__name__}.{_name}"] = _module
