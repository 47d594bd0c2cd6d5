"""The manifest: the SHA-256 of every result and figure, or a note that the file may differ between builds.

All builds of a config have the same manifest, so that two builds can be compared by their manifests.
"""

import hashlib
from collections.abc import Collection, Iterable
from pathlib import Path

HEAD = """\
# Results and figures with their SHA-256: equal on any number of cores, in any folder, time zone and locale.
# Check that all files are unchanged: sha256sum --quiet --check MANIFEST
# Compare two builds: diff MANIFEST OTHER_MANIFEST
"""
MAY_DIFFER = "# may differ between builds, because it contains measured times: "


def line(file: str, timed: bool) -> str:
    """The line of a file; for a file that may differ between builds a comment, which sha256sum ignores."""
    if timed:
        return f"{MAY_DIFFER}{file}\n"
    return f"{hashlib.sha256(Path(file).read_bytes()).hexdigest()}  {file}\n"


def list_files(files: Iterable[str], timed: Collection[str]) -> str:
    """The manifest of `files`; the files in `timed` contain measured times and may differ between builds."""
    return HEAD + "".join(line(file, file in timed) for file in files)
