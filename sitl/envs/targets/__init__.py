# SPDX-License-Identifier: BSD-3-Clause
"""Tasks with target positions: hold one, pass several in order, follow one that moves."""
