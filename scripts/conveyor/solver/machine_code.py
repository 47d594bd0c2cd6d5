"""The folders in which numba keeps machine code: named by the content of the library's modules.

Numba alone recognises a change only in the file of a function, although the machine code also holds functions of other
files. Here any change in the library gives the machine code of its modules a new folder, so that no stale code runs.
Only the modules of `solver`, which import nothing but SHARED modules and each other, keep theirs after a change
elsewhere, so that the first `simulate` need not compile for half a minute again. Clones with equal sources share their
folders, and the library itself may be read-only. Numba writes each file under a name of its own and then renames it, so
that no process reads half a file.
"""

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
from numba.core.caching import UserWideCacheLocator

# Not numba.config.DISABLE_JIT, which the documentation sets, because compiled functions have no signature there.
if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
    raise ImportError("NUMBA_DISABLE_JIT is set, but this library runs only as compiled code; unset the variable")

SOLVER = Path(__file__).resolve().parent
LIBRARY = SOLVER.parent
SHARED = "arguments.py", "parallel.py", "parameters.py", "progress.py"


@cache
def content(folder: Path) -> str:
    """16 hexadecimal digits: the SHA-256 of all modules below a folder, of SHARED, and of the compilers."""
    digest = hashlib.sha256(f"{platform.python_version()} {numba.__version__} {llvmlite.__version__}".encode())
    for file in sorted({*(LIBRARY / name for name in SHARED), *folder.rglob("*.py")}):
        digest.update(f"\0{file.relative_to(LIBRARY)}\0".encode() + file.read_bytes())
    return digest.hexdigest()[:16]


def roots() -> Iterator[Path]:
    """Folders that may hold machine code, the best first: NUMBA_CACHE_DIR, the user's cache, the temporary folder.

    Machine code in them is executed. Everyone may write to the temporary folder. A folder in it therefore counts only
    if it belongs to this user and nobody else may write to it. The last resort is a new folder for this process alone.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        yield Path(os.environ["NUMBA_CACHE_DIR"])
    yield Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "conveyor"
    shared = Path(tempfile.gettempdir()) / f"conveyor-{os.getuid()}"
    shared.mkdir(mode=0o700, exist_ok=True)
    status = shared.lstat()
    if stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o077:
        yield shared
    yield Path(tempfile.mkdtemp(prefix="conveyor-"))


@cache
def root() -> Path:
    """The first of the `roots` that this process can write to."""
    for folder in roots():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    raise OSError("no writable folder for compiled code: set XDG_CACHE_HOME to one")


class ByContent(UserWideCacheLocator):
    """One of numba's cache locators (see "Notes on Caching" in its documentation) for the modules of this library."""

    def __init__(self, function, file: str):
        super().__init__(function, file)
        self.module = Path(file).resolve()
        self.content = content(SOLVER if self.module.is_relative_to(SOLVER) else LIBRARY)

    @classmethod
    def from_function(cls, function, file: str):
        """The locator of a function; None for functions of other packages, which numba's other locators place."""
        return cls(function, file) if Path(file).resolve().is_relative_to(LIBRARY) else None

    def get_cache_path(self) -> str:
        return str(root() / self.content / self.module.relative_to(LIBRARY).with_suffix(""))

    def get_source_stamp(self) -> str:
        return self.content

    def get_disambiguator(self) -> str:
        return ""  # no two compiled functions of a module have one name


# The documented setting NUMBA_CACHE_LOCATOR_CLASSES: ours first, then numba's own in their order.
OTHERS = "UserProvidedCacheLocator,InTreeCacheLocator,UserWideCacheLocator,IPythonCacheLocator,ZipCacheLocator"
numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{ByContent.__name__},{OTHERS}"
