# SPDX-License-Identifier: BSD-3-Clause
"""Laws that many units contain. A process that compiles many of them compiles these once, before it divides."""

from __future__ import annotations

from . import algebra as a
from . import elementary as e
from . import geodesy as g
from .kernels import law
from .vectors import Euler, Quat, Vec2, Vec3

ENOUGH = 8
"""Units for which it takes less time than it saves."""


@law
def shared(x: float, u: Vec2, v: Vec3, q: Quat, angles: Euler) -> float:
    """Calls what it is about; the value means nothing. What is not called here is compiled with each unit anew."""
    p = a.multiply(a.normalise(q), a.quat_from_rotation_vector(v))
    w = a.rotate(p, a.cross(v, a.by_component(v, a.rotate_inverse(a.conjugate(p), v))))
    h = a.with_down(a.turned(u, a.yaw_of(p) + a.tilt_of(a.quat_from_euler(angles)).roll), a.euler_of(p).yaw)
    y = a.dot(w, h) + a.norm(w) + a.dot2(u, a.horizontal(h)) + a.norm2(u)
    y += e.cos(x) + e.sincos(x)[0] + e.atan2(x, y) + e.asin(x) + e.exp(x) + e.log(x) + e.pow(x, y) + e.hypot(x, y)
    y += g.add_offset(x, y, g.offset_ne(x, y, x, y).x, g.longitude_scale(x))[0]
    return y


def compile_once() -> None:
    """Compile them as units contain them, for those of this process's copies that inline no more than usual."""
    import numba

    from .array_kernels import numba_type_of
    from .compile import make_jitable
    from .numba_tuning import law_options, quick, trust_laws

    make_jitable()
    with quick("no library"), trust_laws():
        numba.njit(**law_options())(shared).compile(tuple(map(numba_type_of, (float, Vec2, Vec3, Quat, Euler))))
