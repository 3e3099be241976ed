# SPDX-License-Identifier: BSD-3-Clause
"""Outputs 1 .. 4.

SERVOn_FUNCTION (ArduPilot's numbers): 0 none (free for DO_SET_SERVO), 1 the same channel of the receiver, 26 steering,
51 .. 66 channel 1 .. 16 of the receiver, 70 throttle, 73 and 74 left and right motor of a skid-steered vehicle.
"""

from __future__ import annotations

from ...params.parameter import INT8, INT16, Parameter

PARAMETERS = (
    Parameter("SERVO1_MIN", 1100, 800, 2200, "us", "Shortest pulse of output 1", INT16),
    Parameter("SERVO1_MAX", 1900, 800, 2200, "us", "Longest pulse of output 1", INT16),
    Parameter("SERVO1_TRIM", 1500, 800, 2200, "us", "Pulse of output 1 at rest", INT16),
    Parameter("SERVO1_REVERSED", 0, 0, 1, "", "Output 1 works the other way round", INT8),
    Parameter("SERVO1_FUNCTION", 26, -1, 300, "", "What output 1 does", INT16),
    Parameter("SERVO2_MIN", 1100, 800, 2200, "us", "Shortest pulse of output 2", INT16),
    Parameter("SERVO2_MAX", 1900, 800, 2200, "us", "Longest pulse of output 2", INT16),
    Parameter("SERVO2_TRIM", 1500, 800, 2200, "us", "Pulse of output 2 at rest", INT16),
    Parameter("SERVO2_REVERSED", 0, 0, 1, "", "Output 2 works the other way round", INT8),
    Parameter("SERVO2_FUNCTION", 0, -1, 300, "", "What output 2 does", INT16),
    Parameter("SERVO3_MIN", 1100, 800, 2200, "us", "Shortest pulse of output 3", INT16),
    Parameter("SERVO3_MAX", 1900, 800, 2200, "us", "Longest pulse of output 3", INT16),
    Parameter("SERVO3_TRIM", 1500, 800, 2200, "us", "Pulse of output 3 at rest", INT16),
    Parameter("SERVO3_REVERSED", 0, 0, 1, "", "Output 3 works the other way round", INT8),
    Parameter("SERVO3_FUNCTION", 70, -1, 300, "", "What output 3 does", INT16),
    Parameter("SERVO4_MIN", 1100, 800, 2200, "us", "Shortest pulse of output 4", INT16),
    Parameter("SERVO4_MAX", 1900, 800, 2200, "us", "Longest pulse of output 4", INT16),
    Parameter("SERVO4_TRIM", 1500, 800, 2200, "us", "Pulse of output 4 at rest", INT16),
    Parameter("SERVO4_REVERSED", 0, 0, 1, "", "Output 4 works the other way round", INT8),
    Parameter("SERVO4_FUNCTION", 0, -1, 300, "", "What output 4 does", INT16),
)
