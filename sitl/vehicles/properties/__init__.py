# SPDX-License-Identifier: BSD-3-Clause
"""The properties that describe a vehicle: SI units, FRD body frame.

They are part of every vehicle's record, so that each vehicle of a fleet may differ. ``copter`` and ``rover`` put the
groups of their kind together; ``body``, ``battery`` and ``sensors`` belong to both.
"""
