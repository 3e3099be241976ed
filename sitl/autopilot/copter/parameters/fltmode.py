# SPDX-License-Identifier: BSD-3-Clause
"""Flight modes on the mode channel."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("FLTMODE1", 0, 0, 127, "", "Mode at position 1 of the mode channel", INT8),
    Parameter("FLTMODE2", 0, 0, 127, "", "Mode at position 2 of the mode channel", INT8),
    Parameter("FLTMODE3", 0, 0, 127, "", "Mode at position 3 of the mode channel", INT8),
    Parameter("FLTMODE4", 0, 0, 127, "", "Mode at position 4 of the mode channel", INT8),
    Parameter("FLTMODE5", 0, 0, 127, "", "Mode at position 5 of the mode channel", INT8),
    Parameter("FLTMODE6", 0, 0, 127, "", "Mode at position 6 of the mode channel", INT8),
    Parameter("FLTMODE_CH", 5, 0, 8, "", "Channel that selects the mode; 0 none", INT8),
)
