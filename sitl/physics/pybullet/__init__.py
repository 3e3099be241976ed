# SPDX-License-Identifier: BSD-3-Clause
"""Physics by PyBullet: rigid bodies, joints and contacts (``pip install 'gym-sitl[pybullet]'``)."""
