# SPDX-License-Identifier: BSD-3-Clause
"""Tasks with places to be at: hold one, pass several, follow one that moves."""
