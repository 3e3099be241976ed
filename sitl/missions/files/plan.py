# SPDX-License-Identifier: BSD-3-Clause
"""QGroundControl plans (JSON).

https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html
"""

from __future__ import annotations

import copy
import json
import math
from typing import Any

from sitl.autopilot.mission.item import COMMANDS, RELATIVE_FRAMES, MissionItem
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.autopilot.mission.validate import MAY_BE_NAN
from sitl.core.mavlink import MavAutopilot, MavCmd, MavFrame, MavType

from . import complex_items
from .document import Complex, FenceCircle, FencePolygon, MissionFile, MissionFileError, RallyPoint, make, numbers
from .json_reader import Node

FARTHEST = 1e6
"""Greatest radius of a fence, greatest height of a rally point [m]."""
ABOVE_TERRAIN = 3
"""AltitudeMode of a height above terrain; the ground station works out what it is above sea level."""


def parse(text: str, name: str = "mission") -> MissionFile:
    """The mission of a plan, home first, complex items as the items they stand for; fence and rally points.

    Raises:
        MissionFileError: names the member of the document.
    """
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise MissionFileError(f"{name}:{error.lineno}: {error.msg} (column {error.colno})") from None
    except RecursionError:
        raise MissionFileError(f"{name}: lists within lists without end") from None
    except ValueError as error:  # a whole number of more digits than Python takes
        raise MissionFileError(f"{name}: {str(error).partition(':')[0]}") from None
    top = Node(document, name)
    if not isinstance(document, dict) or document.get("fileType") != "Plan":
        found = document.get("fileType") if isinstance(document, dict) else None
        raise top.fail(
            f"fileType is {found!r}: not a plan of QGroundControl ('Plan'). A mission is a .plan (Save in "
            "QGroundControl's Plan view) or 'QGC WPL 110' text (Write WP File in Mission Planner, wp save in MAVProxy)"
        )
    Node(top["version"].value, f"{name}: version").whole(1)
    found = Node(top["mission"].value, f"{name}: mission")
    found["version"].whole(2)
    items, complexes = _mission(found)
    try:
        mission = Mission.of(items)
    except MissionError as error:
        raise found.fail(str(error)) from None
    fence = Node(top.get("geoFence", {}).value, f"{name}: geoFence")
    rally = Node(top.get("rallyPoints", {}).value, f"{name}: rallyPoints")
    return MissionFile(
        mission,
        name,
        vehicle_type=found["vehicleType"].whole() if "vehicleType" in found else None,
        firmware_type=found.get("firmwareType", MavAutopilot.ARDUPILOTMEGA).whole(),
        cruise_speed=found["cruiseSpeed"].number(0.0) if "cruiseSpeed" in found else None,
        hover_speed=found["hoverSpeed"].number(0.0) if "hoverSpeed" in found else None,
        circles=tuple(_circle(entry) for entry in fence.get("circles", [])),
        polygons=tuple(_polygon(entry) for entry in fence.get("polygons", [])),
        breach_return=_point(fence["breachReturn"]) if "breachReturn" in fence else None,
        rally=tuple(RallyPoint(_point(p)[:2], _point(p)[2]) for p in rally.get("points", [])),
        complexes=tuple(complexes),
    )


def _mission(found: Node) -> tuple[list[MissionItem], list[Complex]]:
    """Home and the items of the object "mission"."""
    home = tuple(0.0 if math.isnan(v) else v for v in found.get("plannedHomePosition", [0.0, 0.0, 0.0]).numbers(3))
    where = found.get("plannedHomePosition", None).where
    items = [make(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL, (0.0, 0.0, 0.0, 0.0, *home), 1, where)]
    complexes: list[Complex] = []
    numbers: dict[int, int] = {}
    """doJumpId -> number of the item."""
    inner: dict[int, int] = {}
    """The same for items within complex ones, which some programs number separately."""
    jumps: list[tuple[int, Node]] = []
    for entry in found["items"]:
        kind = entry["type"].text
        if kind == "SimpleItem":
            _add(items, entry, numbers, jumps)
        elif kind == "ComplexItem":
            first = len(items)
            stored = complex_items.stored(entry)
            if stored is not None:
                for part in stored:
                    _add(items, part, inner, jumps)
            else:
                items += complex_items.expand(entry)
            name = entry["complexItemType"].text
            complexes.append(Complex(name, first, len(items) - first, entry.value, stored is not None))
        else:
            raise entry["type"].fail(f"{kind!r} is not 'SimpleItem' or 'ComplexItem'")
    for seq, entry in jumps:
        target, known = items[seq].p1, {**inner, **numbers}
        if target not in known:
            raise entry["params"].fail(f"DO_JUMP to {target:g}: no item has this doJumpId")
        items[seq] = items[seq]._replace(p1=float(known[int(target)]))
    return items, complexes


def _add(items: list[MissionItem], entry: Node, numbers: dict[int, int], jumps: list[tuple[int, Node]]) -> None:
    """The next item, of an entry of type SimpleItem."""
    item = plan_simple(entry)
    if "doJumpId" in entry:
        numbers.setdefault(entry["doJumpId"].whole(), len(items))
    else:
        numbers.setdefault(len(items), len(items))
    if item.command == MavCmd.DO_JUMP:
        jumps.append((len(items), entry))
    items.append(item)


def plan_simple(entry: Node) -> MissionItem:
    """Item of an entry of type SimpleItem.

    A parameter that is null counts as NaN, "as it is", where vehicles take that (validate.MAY_BE_NAN), elsewhere as 0.
    The frame says what the altitude counts from; AltitudeMode says how it was entered. It counts
    only where the ground station did not know the terrain yet: the altitude is null then, and Altitude is meant.
    """
    values = entry["params"].numbers(7)
    command, frame = entry["command"].whole(), entry["frame"].whole()
    if math.isnan(values[6]) and entry.get("AltitudeMode", 0).value == ABOVE_TERRAIN and "Altitude" in entry:
        values, frame = (
            (*values[:6], entry["Altitude"].number()),
            MavFrame.GLOBAL_RELATIVE_ALT,
        )  # the ground is flat, as high as home
    is_nav = command in COMMANDS and COMMANDS[command].is_nav
    may_be_nan = {1, 2, 3} if is_nav else set()  # of navigation commands the first three are asked for
    may_be_nan |= {*MAY_BE_NAN.get(command, ())}
    clean = [0.0 if math.isnan(v) and k not in may_be_nan else v for k, v in enumerate(values, 1)]
    return make(command, frame, tuple(clean), int(entry.get("autoContinue", True).flag), entry.where)


def _circle(entry: Node) -> FenceCircle:
    circle = entry["circle"]
    return FenceCircle(circle["center"].location(), circle["radius"].number(0.0, FARTHEST), _included(entry))


def _polygon(entry: Node) -> FencePolygon:
    corners = tuple(corner.location() for corner in entry["polygon"])
    if len(corners) < 3:
        raise entry["polygon"].fail(f"{len(corners)} corners; a polygon has three or more")
    return FencePolygon(corners, _included(entry))


def _included(entry: Node) -> bool:
    return entry.get("inclusion", True).flag


def _point(entry: Node) -> tuple[float, float, float]:
    """[latitude, longitude, height]."""
    if not isinstance(entry.value, list) or len(entry.value) != 3:
        raise entry.fail("expected [latitude, longitude, height]")
    height = list(entry)[2]
    return (*entry.location(), height.number(-FARTHEST, FARTHEST))


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
            "vehicleType": MavType.QUADROTOR if file.vehicle_type is None else file.vehicle_type,
            "version": 2,
        },
        "rallyPoints": {"points": [_rally(point, file.name) for point in file.rally], "version": 2},
        "version": 1,
    }
    return json.dumps(plan, indent=4) + "\n"


def _entries(items: tuple[MissionItem, ...], complexes: dict[int, Complex]) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = []
    seq = 1
    while seq < len(items):
        found = complexes.get(seq)
        if found is None or found.count == 0:
            entries.append(plan_writer_simple(seq, items[seq]))
            seq += 1
            continue
        entry = copy.deepcopy(dict(found.entry))
        style = entry.get("TransectStyleComplexItem")
        if isinstance(style, dict):
            style["Items"] = [
                plan_writer_simple(seq + k, item) for k, item in enumerate(items[seq : seq + found.count])
            ]
        entries.append(entry)
        seq += found.count
    return entries


def plan_writer_simple(seq: int, item: MissionItem) -> dict[str, Any]:
    """An entry of type SimpleItem."""
    entry: dict[str, Any] = {
        "autoContinue": bool(item.autocontinue),
        "command": item.command,
        "doJumpId": seq,
        "frame": item.frame,
        "params": [None if math.isnan(v) else v for v in numbers(item)],
        "type": "SimpleItem",
    }
    if item.command not in COMMANDS or COMMANDS[item.command].has_location:
        mode = _MODES.get(item.frame, ABSOLUTE_MODE)
        entry = {"AMSLAltAboveTerrain": None, "Altitude": item.z, "AltitudeMode": mode, **entry}
    return entry


def _rally(point: RallyPoint, name: str) -> list[float]:
    if point.frame not in RELATIVE_FRAMES:
        raise MissionFileError(f"{name}: a rally point of frame {point.frame}: heights in a plan are above home")
    return [*point.place, point.height]


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
