"""The workflow uses only the public interface of Snakemake."""

import re

from project import ROOT

SOURCES = [ROOT / "Snakefile", *(path for path in (ROOT / "workflow").rglob("*") if path.suffix in (".smk", ".py"))]
# Private names of another object: `workflow._x`, `snakemake.x._y`. Those of named tuples are public.
PRIVATE = re.compile(r"\b(?!self\b)\w+\._(?!asdict\b|replace\b|fields\b)[a-z]\w*")
DOCUMENTED = {"snakemake.exceptions", "snakemake.utils"}


def test_the_workflow_uses_only_the_public_interface_of_snakemake():
    assert len(SOURCES) > 20
    for path in SOURCES:
        text = path.read_text(encoding="utf-8")
        imported = set(re.findall(r"^(?:from|import) (snakemake[\w.]*)", text, re.MULTILINE))
        assert imported <= DOCUMENTED, path
        assert not PRIVATE.findall(text), path


def test_scripts_use_no_private_name_of_another_package():
    for path in (ROOT / "scripts").rglob("*.py"):
        assert not PRIVATE.findall(path.read_text(encoding="utf-8")), path
