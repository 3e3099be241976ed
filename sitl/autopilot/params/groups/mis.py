# SPDX-License-Identifier: BSD-3-Clause
"""Missions."""

from ..parameter import INT8, INT16, Parameter

PARAMETERS = (
    Parameter("MIS_TOTAL", 1, 0, 32766, "", "Items in the mission, home included; read only", INT16, True),
    Parameter("MIS_RESTART", 0, 0, 1, "", "On entering AUTO: 0 resume the mission, 1 start again", INT8),
)
