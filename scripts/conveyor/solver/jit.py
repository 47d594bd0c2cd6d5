"""The decorators of compiled functions, and operations that numba compiles badly or has no word for.

`compiled` is for a function that is called from Python, or rarely. Numba compiles it by itself; a caller jumps to it.
`compiled_entry` is for one that takes seconds to compile and that only Python calls. Processes that start together
compile different entries at the same time.
`compiled_inline` is for a small function that runs several times in each step. Numba compiles it by itself, and LLVM
copies its machine code into every caller. LLVM turns a loop over lanes into vector code only if all functions in it are
copied: otherwise maps would take 1.5 times as long, and their labels 1.8 times. Single runs gain 4 %.
`compiled_into_callers` is for any other function with one or two callers. Numba copies its source into them and never
compiles it alone: otherwise sweeps would take 2.5 times as long, and the first `simulate` would compile for a tenth
longer.
"""

import functools

import numba
from numba.core import types
from numba.extending import intrinsic, register_jitable

from . import compilation, machine_code  # noqa: F401 - chooses the folder of the machine code

# Functions run without the GIL, so that threads can share the rows of a sweep. Divisions by zero follow IEEE 754
# instead of raising. C code calls no function, so that numba need not compile an entry for it.
OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}


def compiled(function, **options):
    """Compile a function when it is first called."""
    return numba.njit(**OPTIONS, **options)(function)


def compiled_entry(function):
    """`compiled`, for calls from Python only, with a lock of its own."""
    dispatcher, name = compiled(function), f"{function.__module__}.{function.__name__}"

    @functools.wraps(dispatcher, updated=())
    def entry(*arguments):
        compilation.OneProcess.threads.entry = name
        try:
            return dispatcher(*arguments)
        finally:
            compilation.OneProcess.threads.entry = compilation.OTHERS

    return entry


def compiled_inline(function):
    """Compile a function for compiled callers, with its machine code copied into them; Python calls its source."""
    return register_jitable(**OPTIONS, forceinline=True)(function)


def compiled_into_callers(function):
    """`compiled`, with its source copied into every compiled caller."""
    return compiled(function, inline="always")


@compiled_inline
def copy(target, source):
    """Copy the numbers of a tuple, or of an array of one dimension, to an array of the same length.

    Numba takes 1.6 s longer to compile `target[:] = source`, because of the message for unequal lengths.
    """
    for k in range(len(source)):
        target[k] = source[k]


@intrinsic
def fma(typing_context, a, b, c):
    """a b + c, rounded once (fused multiply-add, IEEE 754), so that every machine gives the same bits."""

    def code(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), code


@intrinsic
def no_refcount(typing_context, value):
    """The same array, or tuple of arrays, numbers and tuples, without reference counting.

    For a function whose caller holds the arrays until it returns. Numba counts references atomically at each function
    that an array passes through. Sweeps would take three times as long, labels 1.3 times.
    """

    def without_refcount(context, builder, kind, value):
        if isinstance(kind, types.BaseTuple):
            for place, kind_of_part in enumerate(kind):
                part = without_refcount(context, builder, kind_of_part, builder.extract_value(value, place))
                value = builder.insert_value(value, part, place)
        elif isinstance(kind, types.Array):
            fields = context.data_model_manager[kind]
            for name in ("meminfo", "parent"):
                place = fields.get_field_position(name)
                value = builder.insert_value(value, value.type.elements[place](None), place)
        return value

    def code(context, builder, signature, arguments):
        return without_refcount(context, builder, signature.return_type, *arguments)

    return value(value), code


@intrinsic
def number_at(typing_context, address, place):
    """The float64 at a place behind an address. The array must exist as long as the address is in use.

    A tuple with an array of its own instead of its address counts references wherever it is copied: labels of maps
    would take 1.25 times as long.
    """

    def code(context, builder, signature, arguments):
        address, place = arguments
        numbers = builder.inttoptr(address, context.get_value_type(types.float64).as_pointer())
        return builder.load(builder.gep(numbers, [place]))

    return types.float64(types.int64, types.int64), code
