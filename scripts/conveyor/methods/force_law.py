"""The forces between part and plate as functions of the state, for methods that evaluate them at points in time."""

import math

from ..solver import model
from ..solver.contact_law import spring_and_damper
from ..solver.jit import compiled, compiled_inline


@compiled
def least_push(tension):
    """The least F_c/m (m/s²) that acts, at a reading of Eq. 7 (the number of one of parameters.TENSION_MODES)."""
    return 0.0 if tension == model.TENSION_CLIP else -math.inf


@compiled
def least_rub(tension):
    """The least F_c/m (m/s²) that causes friction, at a reading of Eq. 11."""
    return 0.0 if tension == model.TENSION_FRICTIONLESS else -math.inf


@compiled_inline
def simple_power(depth, exponent):
    """δ^p (m^p) of δ (m) for the exponents 1 and 1.5, without a library function; no number for a negative δ."""
    return depth * (math.sqrt(depth) if exponent == 1.5 else 1.0)


@compiled
def power_of_depth(depth, exponent):
    """δ^p (m^p) of δ (m) for any exponent; 0 for a negative δ."""
    if depth < 0.0:
        return 0.0
    return simple_power(depth, exponent) if exponent == 1.5 or exponent == 1.0 else depth**exponent


@compiled_inline
def contact_acceleration(gap, speed, power, stiffness, damping, least_push):
    """F_c/m in m/s² from q (m), the speed of approach (m/s), δ^p, k_c/m and d_c/m (Eq. 7; zero in flight)."""
    force = spring_and_damper(stiffness * power, damping, speed)
    force = least_push if least_push > force else force
    return 0.0 if gap > 0.0 else force


@compiled_inline
def friction_acceleration(push, slip, friction, least_rub):
    """F_r/m in m/s² from F_c/m (m/s²) and the slip ẋ_s - ẋ_p (m/s) (Eqs. 11 and 12)."""
    bound = friction * (least_rub if least_rub > push else push)
    return bound if slip > 0.0 else (-bound if slip < 0.0 else 0.0)
