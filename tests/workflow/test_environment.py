"""The environment of jobs."""

STATUS = """
    import pyarrow
    from pathlib import Path

    pyarrow.array([1.0])
    Path("status.txt").write_text(Path("/proc/self/status").read_text())
    return figure"""


def test_tables_request_no_huge_pages(edited, monkeypatch):
    monkeypatch.delenv("MIMALLOC_ALLOW_THP", raising=False)
    project = edited("scripts/figures/plots/fig03.py", "\n    return figure", STATUS)
    project.make("figures/fig03.pdf")
    assert "THP_enabled:\t0" in (project.folder / "status.txt").read_text()
