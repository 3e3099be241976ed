# SPDX-License-Identifier: BSD-3-Clause
"""What the EK3_* noise parameters mean to this filter.

ArduPilot's defaults are set for vibrating frames and poor sensors, far above what its simulator produces.
Here each parameter keeps its name and default, and a fixed factor turns it into the standard deviation or
noise density with which the innovations of the default sensors agree with their covariances. Doubling a
parameter doubles the noise.

A sensor that contradicts the filter by far has failed, or the filter has: then the parameters count as they
stand, as in ArduPilot (doubt.py).
"""

from __future__ import annotations

GYRO = 0.04
"""EK3_GYRO_P_NSE to noise density [rad/s/sqrt(Hz)]: 6e-4 by default."""
ACC = 0.02
"""EK3_ACC_P_NSE to noise density [m/s^2/sqrt(Hz)]: 0.007 by default."""
GYRO_BIAS = 0.1
"""EK3_GBIAS_P_NSE to random walk [rad/s/sqrt(s)]: 1e-4 by default."""
ACC_BIAS = 0.3
"""EK3_ABIAS_P_NSE to random walk [m/s^2/sqrt(s)]: 0.006 by default."""
MAG_BIAS = 0.1
"""EK3_MAGB_P_NSE to random walk [gauss/sqrt(s)]: 1e-5 by default."""
FLOW = 0.12
"""EK3_FLOW_M_NSE to standard deviation of one sample of optical flow [rad/s]: 0.03 by default."""
GPS_POSITION = 0.23
"""EK3_POSNE_M_NSE to standard deviation of one fix [m]: 0.115 by default."""
GPS_HEIGHT = 0.3
"""1.5 times EK3_POSNE_M_NSE, which ArduPilot takes for the height of a fix, to its standard deviation [m]: 0.225 by
default."""
GPS_VELOCITY_NE = 0.17
"""EK3_VELNE_M_NSE to standard deviation of one fix [m/s]: 0.05 by default."""
GPS_VELOCITY_D = 0.16
"""EK3_VELD_M_NSE to standard deviation of one fix [m/s]: 0.08 by default."""
HEIGHT = 0.065
"""EK3_ALT_M_NSE to standard deviation of one barometer sample [m]: 0.13 by default."""
MAG = 0.06
"""EK3_MAG_M_NSE to standard deviation of one sample [gauss]: 0.003 by default."""
YAW = 0.002
"""EK3_YAW_M_NSE to standard deviation of one yaw besides the noise of the samples [rad]: 0.001 by default."""

# While the filter is in doubt (doubt.py)
DOUBTED_GYRO = 0.11
"""EK3_GYRO_P_NSE to noise density: a step of ArduPilot's, 12 ms, has the parameter's noise, and sqrt(12 ms) is 0.11."""
DOUBTED_ACC = 0.11
"""EK3_ACC_P_NSE likewise."""
DOUBTED_ACC_BIAS = 0.11
"""EK3_ABIAS_P_NSE likewise."""
DOUBTED_POSITION = 0.18  # [m], what becomes of position and velocity with such noise, when it began long ago
DOUBTED_VELOCITY = 0.07  # [m/s]
DOUBTED_SPEED = 0.8
"""Of horizontal velocities, in place of a smaller EK3_VELNE_M_NSE [m/s]: positions count for more than velocities."""

# The state at the start, standard deviations.
INITIAL_TILT = 0.1  # [rad]
INITIAL_YAW = 0.5  # [rad], before the first magnetometer mean is fused
INITIAL_VELOCITY = 0.2  # [m/s]
INITIAL_POSITION = 0.5  # [m]
INITIAL_GYRO_BIAS = 0.003  # [rad/s], after the calibration at boot
INITIAL_ACC_BIAS = 0.1  # [m/s^2]
INITIAL_MAG_BIAS = 0.005  # [gauss], what compass calibration leaves
STILL_VELOCITY = 0.1  # [m/s], of the zero velocity that stands for GPS on the ground
STILL_POSITION = 0.5  # [m], of the position held on the ground
