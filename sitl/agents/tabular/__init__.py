# SPDX-License-Identifier: BSD-3-Clause
"""Q-learning and Sarsa on tables, as the paper used them."""
