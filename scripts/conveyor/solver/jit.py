"""The one decorator of compiled functions, and what the compiler is told."""

import numba
from numba.core import types
from numba.extending import intrinsic

from . import machine_code  # noqa: F401 - says where compiled code is kept

# Neighbouring operations share an instruction. Their order stays, and with it every digit.
numba.config.SLP_VECTORIZE = 1

# The GIL is released so that threads can share a sweep; divisions follow IEEE 754 instead of raising.
kernel = numba.njit(cache=True, nogil=True, error_model="numpy")
# For what is called several times in a step: to pass the constants and the arrays would cost a good part of the time.
inlined = numba.njit(cache=True, nogil=True, error_model="numpy", forceinline=True)


@intrinsic
def fused(typing_context, a, b, c):
    """A product and a sum, a b + c, with one rounding: IEEE 754 defines it, so that every machine gives the same."""

    def code(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), code


@intrinsic
def borrowed(typing_context, array):
    """The same array without its own count of references, for a kernel whose caller holds it until the kernel returns.

    Counting them, an atomic operation at each function that an array passes through, would cost more than the solver.
    """

    def code(context, builder, signature, arguments):
        make = context.make_array(signature.return_type)
        view = make(context, builder, value=arguments[0])
        view.meminfo = view.meminfo.type(None)
        view.parent = view.parent.type(None)
        return view._getvalue()

    return array(array), code
