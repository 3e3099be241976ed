# SPDX-License-Identifier: BSD-3-Clause
"""Digests of a fixed set of flights, to prove that two trees fly the same, bit for bit (docs/digests.md).

The package needs nothing of the project but what ``tree`` looks up, so that one copy of it serves old and new trees.
"""
