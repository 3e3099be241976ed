# SPDX-License-Identifier: BSD-3-Clause
"""Mission files: "QGC WPL 110" text and QGroundControl's .plan, read and written; KML, KMZ, .fen, .poly and RALLY
lines, read.

https://mavlink.io/en/file_formats/,
https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html
"""

from .document import Complex, FenceCircle, FencePolygon, MissionFile, MissionFileError, RallyPoint
from .flyable import as_flight, for_vehicle
from .splines import straightened
from .store import joined, load, save

__all__ = [
    "Complex",
    "FenceCircle",
    "FencePolygon",
    "MissionFile",
    "MissionFileError",
    "RallyPoint",
    "load",
    "save",
    "joined",
    "as_flight",
    "for_vehicle",
    "straightened",
]
