# SPDX-License-Identifier: BSD-3-Clause
"""SI in JSBSim's units (foot, slug, pound-force). A newton is a kilogram metre per second squared in both."""

from __future__ import annotations

FOOT = 0.3048
"""[m]"""
SLUG = 14.593902937206364
"""[kg]"""
POUND = SLUG * FOOT
"""Of force [N]."""
POUND_FOOT = POUND * FOOT
"""Of torque [N m]."""
SLUG_FOOT2 = SLUG * FOOT * FOOT
"""Of inertia [kg m^2]."""
SLUG_BY_FOOT3 = SLUG / (FOOT * FOOT * FOOT)
"""Of density [kg/m^3]."""
POUNDS_BY_SLUG = 32.174049
"""What JSBSim divides a weight in pounds by to get the mass."""
PASCALS = POUND / (FOOT * FOOT)
"""Of a pound by square foot [Pa]."""
RANKINE = 5.0 / 9.0
"""Of a difference of temperature [K]."""
