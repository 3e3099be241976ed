# SPDX-License-Identifier: BSD-3-Clause
"""Recipes: one .toml file is one tuned way to learn one environment, with how it is evaluated (docs/learning.md)."""

from __future__ import annotations

from .recipe import Recipe, load, names

__all__ = ["Recipe", "load", "names"]
