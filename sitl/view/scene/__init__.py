# SPDX-License-Identifier: BSD-3-Clause
"""The three-dimensional part of the page: one file for each thing that is drawn."""
