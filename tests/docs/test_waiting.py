"""How long a newcomer waits for a figure."""

import json

import pytest

from docs import waiting

RULE = """
rule figure:
    output: "a.pdf"
    shell: "ls $XDG_CACHE_HOME >> {seen}; mkdir -p $XDG_CACHE_HOME/compiled; touch {{output}}"
"""


def test_the_first_run_has_an_empty_cache_and_the_later_one_its_content(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    snakefile, seen = tmp_path / "Snakefile", tmp_path / "seen"
    snakefile.write_text(RULE.format(seen=seen))
    found = json.loads(waiting.make(str(snakefile), 1, "a.pdf"))
    assert list(found) == ["first", "later"]
    assert all(seconds > 0.0 for seconds in found.values())
    assert seen.read_text().split().count("compiled") == 1


def test_a_figure_that_cannot_be_made_is_an_error(tmp_path):
    (tmp_path / "Snakefile").write_text("")
    with pytest.raises(RuntimeError, match=r"could not make a\.pdf"):
        waiting.make(str(tmp_path / "Snakefile"), 1, "a.pdf")
