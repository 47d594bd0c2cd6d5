"""The one decorator of compiled functions, and where their machine code is kept.

Numba decides by one file's age whether cached machine code is current, and so misses a change in a function that was
inlined from another file. The cache therefore lives in a folder named by the content of the whole library: a change
anywhere starts a new folder, equal sources share one between clones, and a read-only checkout needs no write access.
"""

import hashlib
import os
import tempfile
from pathlib import Path

import numba
from numba.core import types
from numba.extending import intrinsic


def library_hash() -> str:
    """First 16 hexadecimal digits of the SHA-256 of all modules of this package, in alphabetical order."""
    digest = hashlib.sha256(numba.__version__.encode())
    for module in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(module.name.encode() + b"\0" + module.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """A writable folder for machine code: below $XDG_CACHE_HOME or ~/.cache, else below the temporary folder."""
    for root in (os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", tempfile.gettempdir()):
        folder = Path(root) / "conveyor" / library_hash()
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(folder, os.W_OK):
            return folder
    raise OSError("no writable folder for compiled code: set XDG_CACHE_HOME to one")


if "NUMBA_CACHE_DIR" not in os.environ:
    numba.config.CACHE_DIR = str(cache_folder())

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
