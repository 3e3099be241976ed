# SPDX-License-Identifier: BSD-3-Clause
"""Environments on the page in the browser (docs/view.md)."""
