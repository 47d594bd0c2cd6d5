"""The article as a PDF."""

import os
import subprocess
import sys

from project import ROOT

from conveyor_pipeline.pages import article

NEWER = """#!/bin/sh
case "$1" in
    --version) echo "pandoc 99.0.0" ;;
    *) exit 1 ;;
esac
"""
TEXT = ("# Title\n\nMr. Smith.", "$body$")
TYPESET = f"""
import sys
from conveyor_pipeline.pages import article

sys.stdout.buffer.write(article.typeset(*{TEXT}))
"""


def test_the_users_pandoc_and_its_settings_do_not_count(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYPANDOC_PANDOC", raising=False)  # set by the article itself
    pandoc = tmp_path / "bin/pandoc"
    pandoc.parent.mkdir()
    pandoc.write_text(NEWER)
    pandoc.chmod(0o755)
    data = tmp_path / "data/pandoc"
    data.mkdir(parents=True)
    (data / "abbreviations").write_text("Smith.\n")  # by default: Mr., followed by a no-break space
    users = os.environ | {"PATH": f"{pandoc.parent}:{os.environ['PATH']}", "XDG_DATA_HOME": str(data.parent)}
    users |= {"PYTHONPATH": f"{ROOT}:{ROOT / 'scripts'}"}
    theirs = subprocess.run([sys.executable, "-c", TYPESET], env=users, capture_output=True, check=True)
    assert theirs.stdout.startswith(b"%PDF")
    assert theirs.stdout == article.typeset(*TEXT)
