# SPDX-License-Identifier: BSD-3-Clause
"""Flight along legs."""

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter("WPNAV_SPEED", 1000.0, 10.0, 10000.0, "cm/s", "Horizontal speed limit in missions"),
    Parameter("WPNAV_RADIUS", 200.0, 5.0, 1000.0, "cm", "Distance at which a waypoint is reached"),
    Parameter("WPNAV_SPEED_UP", 250.0, 10.0, 5000.0, "cm/s", "Climb speed limit in missions"),
    Parameter("WPNAV_SPEED_DN", 150.0, 10.0, 2000.0, "cm/s", "Descent speed limit in missions"),
    Parameter("WPNAV_ACCEL", 250.0, 50.0, 2000.0, "cm/s/s", "Horizontal acceleration limit in missions"),
    Parameter("WPNAV_ACCEL_Z", 100.0, 50.0, 1000.0, "cm/s/s", "Vertical acceleration limit in missions"),
    Parameter("WPNAV_JERK", 1.0, 0.1, 50.0, "m/s/s/s", "Jerk limit along legs"),
    Parameter("WPNAV_ACCEL_C", 0.0, 0.0, 2000.0, "cm/s/s", "Acceleration in corners; 0: twice WPNAV_ACCEL"),
)
