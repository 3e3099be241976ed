# SPDX-License-Identifier: BSD-3-Clause
"""The compiled core as it comes with a wheel: how it is built, and how it is used without a compiler."""
