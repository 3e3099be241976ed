# SPDX-License-Identifier: BSD-3-Clause
"""An artificial horizon as SVG, with heading, speed and height."""

from __future__ import annotations

import math

from ..core.algebra import euler_of
from .frame import Frame

_PIXELS_A_DEGREE = 2.2
_WIDTH, _HEIGHT = 260, 170


def draw(frame: Frame) -> str:
    """The instrument for a moment."""
    roll, pitch, yaw = (math.degrees(angle) for angle in euler_of(frame.q))
    speed, height = math.hypot(frame.vel.x, frame.vel.y), height_of(frame)
    middle_x, middle_y, far = _WIDTH / 2, _HEIGHT / 2, 400
    down = pitch * _PIXELS_A_DEGREE
    ladder = "".join(
        f'<line x1="{-w}" x2="{w}" y1="{-k * _PIXELS_A_DEGREE:.1f}" y2="{-k * _PIXELS_A_DEGREE:.1f}"/>'
        for k in range(-60, 61, 10) if k for w in [22 if k % 20 == 0 else 11]
    )  # fmt: skip
    return (
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="100%" style="display:block;border-radius:6px" '
        f'font-family="sans-serif" font-size="12">'
        f'<g transform="translate({middle_x} {middle_y}) rotate({-roll:.1f}) translate(0 {down:.1f})">'
        f'<rect x="{-far}" y="{-far}" width="{2 * far}" height="{far}" fill="#5aa9e6"/>'
        f'<rect x="{-far}" y="0" width="{2 * far}" height="{far}" fill="#a9744f"/>'
        f'<g stroke="#fff"><line x1="{-far}" x2="{far}" y1="0" y2="0" stroke-width="1.5"/>{ladder}</g></g>'
        f'<g stroke="#ffd400" stroke-width="3" fill="none">'
        f'<path d="M{middle_x - 55} {middle_y}h35l8 8M{middle_x + 55} {middle_y}h-35l-8 8"/></g>'
        f'<circle cx="{middle_x}" cy="{middle_y}" r="2.5" fill="#ffd400"/>'
        f'<g fill="#111" fill-opacity="0.55"><rect x="0" y="{middle_y - 12}" width="58" height="24"/>'
        f'<rect x="{_WIDTH - 58}" y="{middle_y - 12}" width="58" height="24"/>'
        f'<rect x="{middle_x - 28}" y="0" width="56" height="20"/></g>'
        f'<g fill="#fff" text-anchor="middle"><text x="29" y="{middle_y + 4}">{speed:.1f} m/s</text>'
        f'<text x="{_WIDTH - 29}" y="{middle_y + 4}">{height:.1f} m</text>'
        f'<text x="{middle_x}" y="14">{yaw % 360.0:03.0f}°</text></g></svg>'
    )


def height_of(frame: Frame) -> float:
    """Height above home, or above the scene's origin while there is no home [m]."""
    return (frame.home.z if frame.home is not None else 0.0) - frame.pos.z
