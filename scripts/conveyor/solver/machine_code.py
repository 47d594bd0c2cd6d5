"""Where the machine code of kernels is kept: in folders named by the content of all that a kernel's module imports.

Numba decides by one file's age whether cached machine code is current, and so misses a change in a function that was
inlined from another file. Here a change anywhere among a module's own imports starts a new folder for its kernels, and
leaves those of other modules alone; equal sources share one between clones, and a checkout may be read-only.
"""

import ast
import hashlib
import os
import platform
import stat
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import llvmlite
import numba
from numba.core.caching import _CacheLocator

from .imports import all_imports, parse

LIBRARY = Path(__file__).resolve().parents[1]


@cache
def syntax(module: Path) -> bytes:
    """The name of a module and its syntax tree, which comments and the places of lines do not change."""
    return f"{module.relative_to(LIBRARY)}\0{ast.dump(parse(module))}\0".encode()


@cache
def content(module: Path) -> str:
    """First 16 hexadecimal digits of the SHA-256 of a module, all that it imports at any depth, and the compilers."""
    files, _ = all_imports([module], LIBRARY.parent, LIBRARY.name)
    digest = hashlib.sha256(f"{platform.python_version()} {numba.__version__} {llvmlite.__version__}".encode())
    for file in files:
        digest.update(syntax(file))
    return digest.hexdigest()[:16]


def roots() -> Iterator[Path]:
    """Folders that may hold machine code, the best first: numba's own, the user's cache, one in the temporary folder.

    What lies there is executed. The temporary folder belongs to everyone, so that one's folder counts only if nobody
    else owns it or may write to it; else there is a fresh one, for this process only.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        yield Path(os.environ["NUMBA_CACHE_DIR"])
    yield Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "conveyor"
    shared = Path(tempfile.gettempdir()) / f"conveyor-{os.getuid()}"
    shared.mkdir(mode=0o700, exist_ok=True)
    found = shared.lstat()
    if stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077:
        yield shared
    yield Path(tempfile.mkdtemp(prefix="conveyor-"))


@cache
def root() -> Path:
    """The first of the `roots` that can be written."""
    for folder in roots():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    raise OSError("no writable folder for compiled code: set XDG_CACHE_HOME to one")


class ByContent(_CacheLocator):
    """Numba's interface to all this: the folder of one kernel."""

    def __init__(self, module: Path):
        self.module = module

    def get_cache_path(self) -> str:
        return str(root() / content(self.module))

    def get_source_stamp(self) -> str:
        return content(self.module)

    def get_disambiguator(self) -> str:
        return ""  # kernels of a module have names of their own

    @classmethod
    def from_function(cls, py_func, py_file):
        module = Path(py_file).resolve()
        return cls(module) if module.is_relative_to(LIBRARY) else None


# Kernels of others keep numba's own places.
OTHERS = "UserProvidedCacheLocator,InTreeCacheLocator,UserWideCacheLocator,IPythonCacheLocator,ZipCacheLocator"
numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{ByContent.__name__},{OTHERS}"
