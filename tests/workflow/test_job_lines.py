"""What a terminal shows of jobs: a line for each, and all of what fails."""

import re

LINE = re.compile(r"^\d\d:\d\d:\d\d  (\d+) of (\d+) done  (.+)$", re.MULTILINE)
MESSAGES = (r"Select jobs", r"Execute \d+ jobs", r"Finished jobid", r"^Job \d+:", r"^Reason:", r"^\[\w{3} \w{3}")


def test_each_job_has_a_line(copied):
    for figure in ("fig03", "fig22"):
        (copied.folder / f"figures/{figure}.pdf").unlink()
    run = copied.snakemake("figures/fig03.pdf", "figures/fig22.pdf")
    assert run.returncode == 0
    lines = LINE.findall(run.stdout)
    assert len(lines) == 2
    assert {number for _, number, _ in lines} == {"2"}
    assert {told.split(":")[0] for *_, told in lines} == {"Draw fig03", "Draw fig22"}
    assert "2 of 2 steps (100%) done" in run.stdout
    for message in MESSAGES:
        assert not re.search(message, run.stdout, re.MULTILINE), message
    # The log file keeps all that Snakemake says.
    log = max((copied.folder / ".snakemake/log").iterdir(), key=lambda file: file.stat().st_mtime).read_text()
    for message in MESSAGES:
        assert re.search(message, log, re.MULTILINE), message


def test_a_dry_run_tells_the_reasons(copied):
    (copied.folder / "figures/fig03.pdf").unlink()
    run = copied.snakemake("--dry-run", "figures/fig03.pdf")
    assert "Reason: Missing output files: figures/fig03.pdf" in run.stdout
    assert not LINE.search(run.stdout)


def test_what_fails_is_told_whole(edited):
    project = edited("scripts/figures/plots/fig03.py", "return figure", "raise RuntimeError('broken on purpose')")
    run = project.snakemake("figures/fig03.pdf")
    assert run.returncode == 1
    assert "Error in rule plot_fig03" in run.stdout
    assert "broken on purpose" in run.stdout
