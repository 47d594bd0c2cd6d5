"""What jobs find in their environment."""

POOL = """
    import pyarrow
    from pathlib import Path

    Path("pool.txt").write_text(pyarrow.default_memory_pool().backend_name)
    return figure"""


def test_tables_have_the_memory_that_all_else_has(edited, monkeypatch):
    monkeypatch.delenv("ARROW_DEFAULT_MEMORY_POOL", raising=False)
    project = edited("scripts/figures/plots/fig03.py", "\n    return figure", POOL)
    project.make("figures/fig03.pdf")
    assert (project.folder / "pool.txt").read_text() == "system"
