"""The forces between part and plate as functions of the state, for methods that evaluate them at points in time."""

import math

from ..solver import model
from ..solver.jit import compiled


def spring_and_damper(stiffness, spring, damping, gap_velocity):
    """F_c of a closed contact from k_c, δ^p, d_c and q̇ (Eq. 7), also for vectors of lanes and for symbols."""
    return stiffness * spring - damping * gap_velocity


spring_and_damper_of_numbers = compiled(spring_and_damper)


@compiled
def contact_acceleration(gap, gap_velocity, stiffness, damping, exponent, tension):
    """F_c/m in m/s² from q (m), q̇ (m/s), k_c/m and d_c/m (Eq. 7; zero in flight)."""
    if gap > 0.0:
        return 0.0
    depth = -gap
    if exponent == 1.5:
        spring = depth * math.sqrt(depth)
    elif exponent == 1.0:
        spring = depth
    else:
        spring = depth**exponent
    force = spring_and_damper_of_numbers(stiffness, spring, damping, gap_velocity)
    if tension == model.TENSION_CLIP and force < 0.0:
        return 0.0
    return force


@compiled
def friction_acceleration(force, slip, friction, tension):
    """F_r/m in m/s² from F_c/m (m/s²) and the slip ẋ_s - ẋ_p (m/s) (Eqs. 11 and 12)."""
    if tension == model.TENSION_FRICTIONLESS and force < 0.0:
        return 0.0
    bound = friction * force
    if slip > 0.0:
        return bound
    if slip < 0.0:
        return -bound
    return 0.0
