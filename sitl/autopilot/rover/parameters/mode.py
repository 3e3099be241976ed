# SPDX-License-Identifier: BSD-3-Clause
"""Modes on the mode channel."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("MODE1", 0, 0, 127, "", "Mode at position 1 of the mode channel", INT8),
    Parameter("MODE2", 0, 0, 127, "", "Mode at position 2 of the mode channel", INT8),
    Parameter("MODE3", 0, 0, 127, "", "Mode at position 3 of the mode channel", INT8),
    Parameter("MODE4", 0, 0, 127, "", "Mode at position 4 of the mode channel", INT8),
    Parameter("MODE5", 0, 0, 127, "", "Mode at position 5 of the mode channel", INT8),
    Parameter("MODE6", 0, 0, 127, "", "Mode at position 6 of the mode channel", INT8),
    Parameter("MODE_CH", 8, 0, 16, "", "Channel that selects the mode; 0 none", INT8),
)
