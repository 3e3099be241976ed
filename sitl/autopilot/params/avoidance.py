# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of proximity and avoidance; a copter has more of them (``copter.parameters.avoidance``)."""

from __future__ import annotations

from .parameter import INT8, INT16, ParameterGroup, group, param

_LIDARS = "5, 8, 10, 16 the vehicle's lidar (10 without one: fences, as ArduPilot's simulator)"


class Proximity(ParameterGroup):
    """PRX_: what is seen around the vehicle."""

    FILT: float = param(0.25, 0.0, 20.0, "Hz", "Low-pass of the distances; 0: none")


class ProximitySensor(ParameterGroup):
    """PRX1_: the sensor that looks around."""

    TYPE: float = param(0, 0, 17, "", f"At boot: 0 none, 2 MAVLink messages, {_LIDARS}", INT8)
    ORIENT: float = param(0, 0, 1, "", "1: upside down, angles are counted the other way round", INT8)
    YAW_CORR: float = param(0, -180, 180, "deg", "Added to the angles, clockwise", INT16)
    IGN_ANG1: float = param(0, 0, 360, "deg", "A direction that is not looked at, clockwise from the nose", INT16)
    IGN_WID1: float = param(0, 0, 127, "deg", "So much around it; 0: all is looked at", INT8)
    IGN_ANG2: float = param(0, 0, 360, "deg", "Another such direction", INT16)
    IGN_WID2: float = param(0, 0, 127, "deg", "So much around it", INT8)
    IGN_ANG3: float = param(0, 0, 360, "deg", "Another such direction", INT16)
    IGN_WID3: float = param(0, 0, 127, "deg", "So much around it", INT8)
    IGN_ANG4: float = param(0, 0, 360, "deg", "Another such direction", INT16)
    IGN_WID4: float = param(0, 0, 127, "deg", "So much around it", INT8)
    MIN: float = param(0.0, 0.0, 500.0, "m", "Readings below it are none; 0: as the sensor says")
    MAX: float = param(0.0, 0.0, 500.0, "m", "Readings above it are none; 0: as the sensor says")


class BendyRuler(ParameterGroup):
    """OA_BR_: how BendyRuler looks for a path."""

    LOOKAHEAD: float = param(15.0, 1.0, 100.0, "m", "So far it looks, at most")
    CONT_RATIO: float = param(1.5, 1.0, 2.0, "", "A great change of bearing must gain so much of margin; 0: nothing")
    CONT_ANGLE: float = param(75, 0, 180, "deg", "A change of bearing greater than this is a great one", INT16)


class ObjectDatabase(ParameterGroup):
    """OA_DB_: the objects that BendyRuler keeps away from."""

    SIZE: float = param(100, 0, 10000, "", "Objects that are remembered, no more than 32", INT16)
    EXPIRE: float = param(10, 0, 127, "s", "So long after it was last seen an object counts; 0: for ever", INT16)
    BEAM_WIDTH: float = param(5.0, 1.0, 10.0, "deg", "Width of the sensor's beam, which is an object's")
    RADIUS_MIN: float = param(0.01, 0.0, 10.0, "m", "Least radius of an object")
    DIST_MAX: float = param(0.0, 0.0, 10.0, "m", "What is further away is no object; 0: everything is")


class PathPlanning(ParameterGroup):
    """OA_: paths around fences and objects, in modes that follow legs."""

    TYPE: float = param(
        0,
        0,
        3,
        "",
        "0 straight, 1 BendyRuler, 2 the shortest path around areas (Dijkstra), 3 both",
        INT8,
    )
    MARGIN_MAX: float = param(5.0, 0.1, 100.0, "m", "Distance that such paths keep from areas, and from objects")
    OPTIONS: float = param(1, 0, 7, "", "1: after BendyRuler a leg begins where the vehicle is, else goes on", INT16)
    BR: BendyRuler = group("BendyRuler")
    DB: ObjectDatabase = group("Objects that are known to BendyRuler")


class CopterPathPlanning(PathPlanning):
    """OA_ of a copter."""

    BR_TYPE: float = param(1, 1, 2, "", "BendyRuler: 1 around what is in the way, 2 over it", INT8)


class Avoid(ParameterGroup):
    """AVOID_: stops before obstacles and fences, or slides along them."""

    ENABLE: float = param(3, 0, 7, "", "Bits: 1 fences, 2 what the proximity sensor sees (4 beacons: none)", INT8)
    MARGIN: float = param(2.0, 0.1, 10.0, "m", "Distance that is kept from what the proximity sensor sees")
    BEHAVE: float = param(0, 0, 1, "", "Before obstacles and fences: 0 slides along them, 1 stops", INT8)
    BACKUP_SPD: float = param(0.75, 0.0, 5.0, "m/s", "Speed of backing out of a margin, at most; 0: does not")
    ACCEL_MAX: float = param(3.0, 0.0, 9.0, "m/s/s", "Change of the velocity that avoidance makes; 0: any")
    BACKUP_DZ: float = param(0.1, 0.0, 2.0, "m", "So far into the margin of an obstacle it does not back out")
    BACKZ_SPD: float = param(0.75, 0.0, 5.0, "m/s", "Vertical speed of backing out of a margin, at most; 0: does not")
