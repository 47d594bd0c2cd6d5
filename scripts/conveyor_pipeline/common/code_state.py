"""Whether code has changed since the Snakefile hashed it.

Imported by all jobs: no slow imports. Hashing again takes 0.05 to 0.2 s in every job, so jobs do it only if a file has
changed.
"""

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2]  # the folder whose code the rules hash
STATE = "CONVEYOR_CODE_STATE"  # the environment variable with the state that the Snakefile found


def sources(folder: str) -> Iterator[os.DirEntry]:
    """All files below a folder that Python reads as source or stub."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name != "__pycache__" and entry.is_dir():
                yield from sources(entry.path)
            elif entry.name.endswith((".py", ".pyi")):
                yield entry


def code_state() -> str:
    """A text that differs if a file below SCRIPTS was changed, added or removed; takes some milliseconds."""
    stats = ((entry.path, entry.stat()) for entry in sources(str(SCRIPTS)))
    known = sorted((path, stat.st_mtime_ns, stat.st_size) for path, stat in stats)
    return hashlib.sha256(repr(known).encode()).hexdigest()
