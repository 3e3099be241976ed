# SPDX-License-Identifier: BSD-3-Clause
"""What ``px4_stand_in`` does in PX4's own modes: hold, missions, return, land; and its parameters."""

from __future__ import annotations

import math
import struct

MODES = TAKEOFF, LOITER, MISSION, RTL, LAND = tuple(4 << 16 | sub << 24 for sub in (2, 3, 4, 5, 6))
INT_32, REAL_32 = 6, 9
METRES = 1e-7 * math.radians(1.0) * 6378100.0
WHOLE = {"NAV_RCL_ACT", "NAV_DLL_ACT", "COM_RC_IN_MODE"}
RETURN_M, NEAR_M = 5.0, 0.5
_FRAME_RELATIVE, _FRAME_MISSION = 3, 2


def choose(px4, mode: int) -> None:
    """Go into a mode: from where it is."""
    px4.mode, px4.place = mode, (*px4.position(), px4.yaw()) if px4.origin is not None else None
    if mode == MISSION:
        px4.current = 0


def _place(px4, lat: int, lon: int, down: float) -> tuple[float, float, float, float]:
    north, cos = (lat - px4.origin[0]) * METRES, math.cos(math.radians(px4.origin[0] * 1e-7))
    return north, (lon - px4.origin[1]) * METRES * cos, down, px4.yaw()


def guide(px4) -> tuple[float, ...]:
    """Velocity and turn rate."""
    if px4.place is None:
        choose(px4, px4.mode)
    if px4.mode == MISSION:
        if px4.current >= len(px4.items):
            choose(px4, LOITER)
        else:
            item = px4.items[px4.current]
            if item.command == 20:
                choose(px4, RTL)
            elif item.command == 21:
                return _sink(px4)
            else:
                px4.place = _place(px4, item.x, item.y, -item.z)
                if math.dist(px4.place[:3], px4.position()) < NEAR_M:
                    px4.link.say("MISSION_ITEM_REACHED", seq=px4.current)
                    px4.current += 1
                    px4.link.say("MISSION_CURRENT", seq=px4.current, total=len(px4.items), mission_state=3)
    if px4.mode == RTL:
        px4.place = (0.0, 0.0, -RETURN_M, px4.yaw())
        if math.dist(px4.place[:3], px4.position()) < NEAR_M:
            px4.mode = LAND
    return _sink(px4) if px4.mode == LAND else px4.towards(px4.place)


def _sink(px4) -> tuple[float, ...]:
    if px4.position()[2] > -0.05 and abs(px4.truth.vz) < 5:
        px4.armed = False
    return (0.0, 0.0, 0.7, 0.0)


def _count(px4, fields) -> None:
    px4.items, px4.awaited = [], fields.count
    px4.link.say("MISSION_REQUEST_INT", seq=0, target_system=255, target_component=190)


def _item(px4, item) -> None:
    if item.seq != len(px4.items):
        return
    placed = item.command in (16, 21, 22)
    assert item.frame == (_FRAME_RELATIVE if placed else _FRAME_MISSION), item
    assert not placed or (item.x and item.y), item
    px4.items.append(item)
    if len(px4.items) == px4.awaited:
        px4.link.acknowledge_mission()
    else:
        px4.link.say("MISSION_REQUEST_INT", seq=len(px4.items), target_system=255, target_component=190)


def _list(px4, fields) -> None:
    px4.link.say("MISSION_COUNT", count=len(px4.items), target_system=255, target_component=190)


def _request(px4, fields) -> None:
    item = px4.items[fields.seq]
    px4.link.say("MISSION_ITEM_INT", **{**item._asdict(), "target_system": 255, "target_component": 190})


def _reposition(px4, fields) -> None:
    if fields.command == 192 and px4.origin is not None:
        assert fields.frame == 5 and int(fields.param2) == 1
        px4.mode, px4.place = LOITER, _place(px4, fields.x, fields.y, px4.origin[2] * 1e-3 - fields.z)
        if not math.isnan(fields.param4):
            px4.place = (*px4.place[:3], fields.param4)
        px4.link.say("COMMAND_ACK", command=192, result=0)


def _say_value(px4, name: str) -> None:
    if name not in px4.given:
        return
    value, whole = px4.given[name], name in WHOLE
    wire = struct.unpack("<f", struct.pack("<i", int(value)))[0] if whole else value
    kind = INT_32 if whole else REAL_32
    px4.link.say("PARAM_VALUE", param_id=name.encode(), param_value=wire, param_type=kind, param_count=1)


def _set(px4, fields) -> None:
    name = fields.param_id.decode()
    if fields.param_type == (INT_32 if name in WHOLE else REAL_32):
        value = fields.param_value
        px4.given[name] = struct.unpack("<i", struct.pack("<f", value))[0] if name in WHOLE else value
    _say_value(px4, name)


HEARD = {
    "COMMAND_INT": _reposition,
    "MISSION_COUNT": _count,
    "MISSION_ITEM_INT": _item,
    "MISSION_REQUEST_LIST": _list,
    "MISSION_REQUEST_INT": _request,
    "PARAM_REQUEST_READ": lambda px4, fields: _say_value(px4, fields.param_id.decode()),
    "PARAM_SET": _set,
}
"""What it hears, by name."""
