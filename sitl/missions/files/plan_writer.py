# SPDX-License-Identifier: BSD-3-Clause
"""Plans as QGroundControl writes them."""

from __future__ import annotations

import copy
import json
import math
from typing import Any

from sitl.autopilot.mission.item import DO_JUMP, MissionItem

from .document import QUADROTOR, Complex, MissionFile
from .items import has_degrees, numbers

CRUISE_SPEED, HOVER_SPEED = 10.0, 5.0
"""Default speeds in a plan [m/s]."""
RELATIVE_MODE, ABSOLUTE_MODE, TERRAIN_MODE = 1, 2, 4
"""AltitudeMode"""
_MODES = {3: RELATIVE_MODE, 6: RELATIVE_MODE, 10: TERRAIN_MODE, 11: TERRAIN_MODE}


def write(file: MissionFile) -> str:
    """The JSON of a plan. Complex items are written as such, with the items that they stand for."""
    items = file.mission.items
    home = file.home or (0.0, 0.0, 0.0)
    plan = {
        "fileType": "Plan",
        "geoFence": _fence(file),
        "groundStation": "QGroundControl",
        "mission": {
            "cruiseSpeed": CRUISE_SPEED if file.cruise_speed is None else file.cruise_speed,
            "firmwareType": file.firmware_type,
            "globalPlanAltitudeMode": RELATIVE_MODE,
            "hoverSpeed": HOVER_SPEED if file.hover_speed is None else file.hover_speed,
            "items": _entries(items, {c.first: c for c in file.complexes}),
            "plannedHomePosition": [round(home[0], 8), round(home[1], 8), home[2]],
            "vehicleType": QUADROTOR if file.vehicle_type is None else file.vehicle_type,
            "version": 2,
        },
        "rallyPoints": {"points": [[*point.place, point.height] for point in file.rally], "version": 2},
        "version": 1,
    }
    return json.dumps(plan, indent=4) + "\n"


def _entries(items: tuple[MissionItem, ...], complexes: dict[int, Complex]) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = []
    seq = 1
    while seq < len(items):
        found = complexes.get(seq)
        if found is None or found.count == 0:
            entries.append(simple(seq, items[seq]))
            seq += 1
            continue
        entry = copy.deepcopy(dict(found.entry))
        style = entry.get("TransectStyleComplexItem")
        if isinstance(style, dict):
            style["Items"] = [simple(seq + k, item) for k, item in enumerate(items[seq : seq + found.count])]
        entries.append(entry)
        seq += found.count
    return entries


def simple(seq: int, item: MissionItem) -> dict[str, Any]:
    """An entry of type SimpleItem."""
    entry: dict[str, Any] = {
        "autoContinue": bool(item.autocontinue),
        "command": item.command,
        "doJumpId": seq,
        "frame": item.frame,
        "params": [None if math.isnan(v) else v for v in numbers(item)],
        "type": "SimpleItem",
    }
    if has_degrees(item.command) and item.command != DO_JUMP:
        mode = _MODES.get(item.frame, ABSOLUTE_MODE)
        entry = {"AMSLAltAboveTerrain": None, "Altitude": item.z, "AltitudeMode": mode, **entry}
    return entry


def _fence(file: MissionFile) -> dict[str, Any]:
    fence: dict[str, Any] = {
        "circles": [
            {"circle": {"center": list(c.centre), "radius": c.radius}, "inclusion": c.inclusion, "version": 1}
            for c in file.circles
        ],
        "polygons": [
            {"inclusion": p.inclusion, "polygon": [list(corner) for corner in p.corners], "version": 1}
            for p in file.polygons
        ],
        "version": 2,
    }
    if file.breach_return is not None:
        fence["breachReturn"] = list(file.breach_return)
    return fence
