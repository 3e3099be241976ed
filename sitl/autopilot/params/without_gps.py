# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of navigation without GPS: optical flow, the range-finder that goes with it, and the filter's sources."""

from __future__ import annotations

from .parameter import INT8, INT16, ParameterGroup, param


class Sources(ParameterGroup):
    """EK3_SRCn_: what the filter takes position, velocity and heading from."""

    POSXY: float = param(0, 0, 7, "", "Horizontal position: 0 none, 3 GPS, 6 external; else none", INT8)
    VELXY: float = param(0, 0, 7, "", "Horizontal velocity: 0 none, 3 GPS, 5 optical flow, 6 external; else none", INT8)
    POSZ: float = param(1, 0, 7, "", "Height: 3 GPS, 6 external; else the barometer", INT8)
    VELZ: float = param(0, 0, 7, "", "Vertical velocity: 3 GPS, 6 external; else none", INT8)
    YAW: float = param(0, 0, 8, "", "Heading: 0 none, 1 compass, 6 external; else the compass", INT8)


class Flow(ParameterGroup):
    """FLOW_: the optical flow sensor, looking down."""

    TYPE: float = param(0, 0, 127, "", "At boot: 0 none, 5 MAVLink (OPTICAL_FLOW), 10 simulated; else none", INT8)
    FXSCALER: float = param(0, -800, 800, "", "Flow about the roll axis is too small by so many thousandths", INT16)
    FYSCALER: float = param(0, -800, 800, "", "Flow about the pitch axis is too small by so many thousandths", INT16)
    ORIENT_YAW: float = param(0, -17999, 18000, "cdeg", "How far the sensor is turned, clockwise", INT16)


class RangeFinder(ParameterGroup):
    """RNGFND1_: a range-finder that looks down, for vehicles of which the airframe has none."""

    TYPE: float = param(0, 0, 127, "", "0: as the airframe has it; else there is one", INT8)
    MIN: float = param(0.2, 0.0, 1000.0, "m", "Least range of such a one")
    MAX: float = param(7.0, 0.0, 7000.0, "m", "Greatest range of such a one")


class VisualOdometry(ParameterGroup):
    """VISO_: another system that knows position or velocity."""

    TYPE: float = param(0, 0, 127, "", "At boot: 0 none, 1 MAVLink; else none", INT8)
    SCALE: float = param(1.0, 0.01, 100.0, "", "Metres for one unit of the positions told")
    DELAY_MS: float = param(10, 0, 250, "ms", "Age of what is told when it comes", INT16)
    VEL_M_NSE: float = param(0.1, 0.05, 5.0, "m/s", "Least standard deviation of a velocity")
    POS_M_NSE: float = param(0.2, 0.1, 10.0, "m", "Least standard deviation of a position")
    YAW_M_NSE: float = param(0.2, 0.05, 1.0, "rad", "Standard deviation of a heading")
    QUAL_MIN: float = param(0, -1, 100, "%", "Least quality of an ODOMETRY message that is believed; 0: any", INT8)
