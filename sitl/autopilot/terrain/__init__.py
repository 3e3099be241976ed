# SPDX-License-Identifier: BSD-3-Clause
"""How high the ground is."""
