"""The article as a PDF."""

import os
import subprocess
import sys

from project import ROOT

NEWER = """#!/bin/sh
case "$1" in
    --version) echo "pandoc 99.0.0" ;;
    *) exit 1 ;;
esac
"""
TYPESET = r"""
import sys
from docs import article

sys.stdout.buffer.write(article.typeset("# Title\n\nMr. Smith.", "$body$"))
"""


def test_the_users_pandoc_and_its_settings_do_not_count(tmp_path):
    pandoc = tmp_path / "bin/pandoc"
    pandoc.parent.mkdir()
    pandoc.write_text(NEWER)
    pandoc.chmod(0o755)
    data = tmp_path / "data/pandoc"
    data.mkdir(parents=True)
    (data / "abbreviations").write_text("Smith.\n")  # by default: Mr., followed by a no-break space
    users = {"PATH": f"{pandoc.parent}:{os.environ['PATH']}", "XDG_DATA_HOME": str(data.parent)}
    pages = [
        subprocess.run(
            [sys.executable, "-c", TYPESET],
            cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": f"{ROOT}:{ROOT / 'scripts'}"} | environment,
            capture_output=True,
            check=True,
        ).stdout
        for environment in ({}, users)
    ]
    assert pages[0].startswith(b"%PDF")
    assert pages[0] == pages[1]
