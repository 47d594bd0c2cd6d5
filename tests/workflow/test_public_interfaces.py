"""The rules use only the public interface of Snakemake; ruff says so of Python files."""

import re

from project import ROOT

RULES = [ROOT / "Snakefile", *(ROOT / "workflow").rglob("*.smk")]
# Private names of another object: `workflow._x`. Those of named tuples are public.
PRIVATE = re.compile(r"\b\w+\._(?!asdict\b|replace\b|fields\b)[a-z]\w*")
DOCUMENTED = {"snakemake.exceptions", "snakemake.utils"}


def test_rules_use_only_the_public_interface_of_snakemake():
    assert len(RULES) > 10
    for path in RULES:
        text = path.read_text(encoding="utf-8")
        imported = set(re.findall(r"^(?:from|import) (snakemake[\w.]*)", text, re.MULTILINE))
        assert imported <= DOCUMENTED, path
        assert not PRIVATE.findall(text), path
