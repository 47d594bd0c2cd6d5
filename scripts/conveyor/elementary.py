"""Elementary functions of arrays, by the C library, as compiled code and Python's `math` call them.

NumPy has versions of its own for some processors, whose last digits differ. A search whose next points depend on such
numbers would take another way there.
"""

import math
from collections.abc import Callable
from functools import cache, wraps

import numba
import numpy as np

from .solver import machine_code  # noqa: F401 - chooses the folder of the machine code


def of_arrays(arguments: int) -> Callable[[Callable], Callable]:
    """Decorator: the function of float64 numbers, for arrays; a NumPy ufunc that is made when it is first called.

    Making all of them takes 0.2 s, and most programs call none.
    """

    def decorate(function: Callable) -> Callable:
        @cache
        def ufunc() -> np.ufunc:
            return numba.vectorize([f"float64({', '.join(['float64'] * arguments)})"], cache=True)(function)

        @wraps(function)
        def call(*arrays):
            return ufunc()(*arrays)

        return call

    return decorate


@of_arrays(1)
def exp(x):
    return math.exp(x)


@of_arrays(1)
def log(x):
    # Without the warning with which NumPy passes on a division by zero.
    return math.log(x) if x > 0.0 else (-math.inf if x == 0.0 else math.nan)


@of_arrays(1)
def sin(x):
    return math.sin(x)


@of_arrays(1)
def cos(x):
    return math.cos(x)


@of_arrays(2)
def power(base, exponent):
    return math.pow(base, exponent)
