"""Targets of the rule `motion`, which serves several sections of the config."""

from project import call_snakemake


def test_an_entry_of_another_section_is_refused_with_the_key():
    run = call_snakemake("--dry-run", "results/signals/heights.parquet")
    assert run.returncode == 1
    assert "the config has no entry signals.heights; add it, or name another entry" in run.stdout
