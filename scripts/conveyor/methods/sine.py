"""Sine and cosine without a library function, for loops over lanes: the same digits on every machine."""

import numpy as np

from ..solver.jit import compiled_inline, fma

TWO_OVER_PI = 0.6366197723675814
HALF_PI = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591833e-33)  # their sum is π/2 to 161 bits
# Doubles of this size have no fractional bits: adding ROUNDER rounds to an integer, which is then in the low bits.
ROUNDER = 1.5 * 2.0**52
SIGN = np.int64(-(2**63))  # the bit of the sign
# Coefficients of r³, r⁵, ..., r¹³ and r⁴, r⁶, ..., r¹⁴ on |r| ≤ π/4: k_sin.c and k_cos.c of fdlibm (Sun Microsystems
# 1993).
S3, S5, S7 = -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04
S9, S11, S13 = 2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10
C4, C6, C8 = 4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05
C10, C12, C14 = -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11


@compiled_inline
def with_sign(value, sign):
    """A number, negated if an integer is negative."""
    return np.int64(np.float64(value).view(np.int64) ^ (sign & SIGN)).view(np.float64)


@compiled_inline
def sine_and_cosine(phase):
    """Sine and cosine of a phase in rad, at most 1.5 units in the last place off for |phase| ≤ 1e12 (measured).

    The whole number of quarter turns is subtracted as in Cody and Waite's reduction, here without rounding in the
    first term: phase - turns HALF_PI[0] is a multiple of 2⁻⁵² below 1. The last two bits of the number of turns, which
    are the last bits of `rounded`, select polynomial and sign. Beyond 2⁵¹ quarter turns, where neighbouring numbers are
    half a radian apart, the values mean nothing.
    """
    rounded = fma(phase, TWO_OVER_PI, ROUNDER)
    turns = rounded - ROUNDER
    r = fma(turns, -HALF_PI[2], fma(turns, -HALF_PI[1], fma(turns, -HALF_PI[0], phase)))
    q = r * r
    sine = fma(r * q, fma(fma(fma(fma(fma(S13, q, S11), q, S9), q, S7), q, S5), q, S3), r)
    bend = fma(fma(fma(fma(fma(C14, q, C12), q, C10), q, C8), q, C6), q, C4)
    cosine = fma(q, fma(q, bend, -0.5), 1.0)
    quarter = np.float64(rounded).view(np.int64)
    is_odd = quarter & 1 == 1
    s, c = cosine if is_odd else sine, sine if is_odd else cosine
    # The sine is negative in the quarters 2 and 3, the cosine in the quarters 1 and 2.
    return with_sign(s, quarter << 62), with_sign(c, quarter << 62 ^ quarter << 63)
