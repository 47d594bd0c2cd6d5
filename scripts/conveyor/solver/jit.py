"""The one decorator of compiled functions, and what the compiler is told."""

import numba
from numba.core import types
from numba.extending import intrinsic

from . import machine_code  # noqa: F401 - says where compiled code is kept


def kernel(function, **options):
    """Compile a function when it is called first, once for all values of its arguments.

    The GIL is released so that threads can share a sweep; divisions follow IEEE 754 instead of raising.
    """
    dispatcher = numba.njit(cache=True, nogil=True, error_model="numpy", **options)(function)
    if numba.config.DISABLE_JIT:  # the function itself
        return dispatcher
    template_for = dispatcher.get_call_template

    def template_for_any_value(arguments, keywords):
        # Numba takes the type of a 0 in a call to be that of no other number, and would compile for it alone.
        return template_for(
            tuple(map(types.unliteral, arguments)), {name: types.unliteral(one) for name, one in keywords.items()}
        )

    dispatcher.get_call_template = template_for_any_value
    return dispatcher


def inlined(function):
    """A `kernel` for what is called several times in a step: to pass constants and arrays would cost much of the time.

    The compiler inlines its machine code, so that it is compiled by itself, too.
    """
    return kernel(function, forceinline=True)


def spliced(function):
    """A `kernel` that one or two others call, and hardly Python: it is compiled there, not by itself as well."""
    return kernel(function, inline="always")


@intrinsic
def fused(typing_context, a, b, c):
    """A product and a sum, a b + c, with one rounding: IEEE 754 defines it, so that every machine gives the same."""

    def code(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), code


@intrinsic
def float_bits(typing_context, value):
    """The 64 bits of a float as an integer, which grows with a value that is not negative."""

    def code(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], context.get_value_type(types.int64))

    return types.int64(types.float64), code


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
