# SPDX-License-Identifier: BSD-3-Clause
"""JSBSim (https://jsbsim.org) as an engine: a vehicle's properties written as a JSBSim aircraft, which JSBSim moves."""
