# SPDX-License-Identifier: BSD-3-Clause
"""A page in the browser that shows vehicles: a scene, instruments, plots, controls (docs/view.md)."""
