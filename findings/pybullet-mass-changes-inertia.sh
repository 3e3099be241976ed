#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pybullet 3.2.7: changeDynamics(body, link, mass=m) replaces the moments of inertia, too, by those of the collision shape evenly filled
# with that mass (of a cylinder: of the box around it). A URDF's own <inertia>, which URDF_USE_INERTIA_FROM_FILE had taken, is gone,
# even where m is the mass that the body has already; nothing is said. So training with random masses does not train with the vehicle:
# here a quadcopter's yaw answers a torque with 44 % of its acceleration. A link without a collision shape keeps next to nothing,
# 1e-7 kg m^2. Calls that do not set the mass keep the moments. localInertiaDiagonal in the same call is obeyed.
# Seen: the lines below. Fails if the moments stay, or scale with the mass, or the last call's are not the given ones.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q pybullet==3.2.7 numpy==2.4.6
cat > "$work/quadcopter.urdf" <<'URDF'
<robot name="quadcopter">
  <link name="frame">
    <inertial><mass value="1.5"/><inertia ixx="0.029" iyy="0.029" izz="0.055" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><cylinder radius="0.35" length="0.1"/></geometry></collision>
  </link>
  <link name="camera">
    <inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="2e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="mount" type="fixed"><parent link="frame"/><child link="camera"/></joint>
</robot>
URDF
"$work/venv/bin/python" - "$work/quadcopter.urdf" <<'PYTHON'
import math
import sys

import pybullet as p

FRAME, CAMERA = -1, 0
p.connect(p.DIRECT)


def yaw_acceleration(body):
    """Of 0.1 N m about the vertical axis, over one step of 1 ms [rad/s^2]."""
    p.resetBaseVelocity(body, (0, 0, 0), (0, 0, 0))
    p.applyExternalTorque(body, FRAME, (0, 0, 0.1), p.LINK_FRAME)
    p.stepSimulation()
    return p.getBaseVelocity(body)[1][2] / 0.001


def moments(body, link=FRAME):
    return p.getDynamicsInfo(body, link)[2]


def are(found, wanted):
    return all(math.isclose(a, b, rel_tol=1e-3) for a, b in zip(found, wanted))


p.setTimeStep(0.001)
body = p.loadURDF(sys.argv[1], flags=p.URDF_USE_INERTIA_FROM_FILE)
p.changeDynamics(body, FRAME, lateralFriction=0.5, linearDamping=0.0, angularDamping=0.0)
of_file, before = moments(body), yaw_acceleration(body)
print(f"as loaded: moments {of_file}, yaw {before:.3f} rad/s^2")
assert are(of_file, (0.029, 0.029, 0.055))

p.changeDynamics(body, FRAME, mass=1.5)
of_shape, after = moments(body), yaw_acceleration(body)
print(f"mass=1.5, as it was: moments {of_shape}, yaw {after:.3f} rad/s^2")
assert of_shape[2] > 2.0 * of_file[2] and after < 0.5 * before

of_camera = moments(body, CAMERA)
p.changeDynamics(body, CAMERA, mass=0.1)
print(f"no collision shape: moments {of_camera}, after mass=0.1, as it was: {moments(body, CAMERA)}")
assert are(of_camera, (1e-4, 2e-4, 3e-4)) and max(moments(body, CAMERA)) < 1e-6

p.changeDynamics(body, FRAME, mass=1.8, localInertiaDiagonal=[1.2 * moment for moment in of_file])
print(f"mass=1.8 with localInertiaDiagonal: moments {moments(body)}")
assert are(moments(body), (0.0348, 0.0348, 0.066))
PYTHON
