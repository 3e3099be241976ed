# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a rover from its logs."""
