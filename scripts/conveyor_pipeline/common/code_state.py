"""Whether code has changed since the Snakefile hashed it.

Imported by all jobs: no slow imports. Hashing again takes 0.05 to 0.2 s in every job, so jobs do it only if a file has
changed.
"""

import hashlib
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2]  # the folder whose code the rules hash
STATE = "CONVEYOR_CODE_STATE"  # the environment variable with the state that the Snakefile found


def code_state() -> str:
    """A text that differs if a file below SCRIPTS was changed, added or removed; takes some milliseconds."""
    stats = ((str(file), file.stat()) for file in SCRIPTS.rglob("*.py*") if file.suffix != ".pyc")
    known = sorted((path, stat.st_mtime_ns, stat.st_size) for path, stat in stats)
    return hashlib.sha256(repr(known).encode()).hexdigest()
