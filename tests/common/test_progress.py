"""Progress: a bar on a terminal, lines elsewhere, no empty lines; failed points are counted."""

import io
import sys

import pytest

from conveyor import progress
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common.rule_log import JobError, logged


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def swept(label: str | None) -> None:
    """Ten points; one in the last chunk has failed."""
    for_each_chunk(lambda begin, end: 1 if end == 10 else None, 10, chunk=5, progress=label)


def test_lines_without_a_terminal(monkeypatch):
    monkeypatch.setattr(progress, "SECONDS_OF_LINES", 0.0)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    swept("mine")
    lines = sys.stderr.getvalue().splitlines()
    # The first range has one point, whose time gives the length of the next ranges.
    assert [line.split(" of 10 points, ")[0] for line in lines] == ["mine: 1", "mine: 5", "mine: 10"]
    assert lines[-1].endswith(" left, 1 failed")
    assert " points/s, " in lines[-1]


def test_a_quick_job_has_one_line(monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    swept("mine")
    assert list(progress.progress_bar("abc", label="turns", unit="rounds")) == ["a", "b", "c"]
    lines = sys.stderr.getvalue().splitlines()
    assert [line.split(",")[0] for line in lines] == ["mine: 10 of 10 points", "turns: 3 of 3 rounds"]


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_nothing_without_a_label(monkeypatch, stream):
    monkeypatch.setattr(sys, "stderr", stream())
    swept(None)
    assert sys.stderr.getvalue() == ""


def test_a_log_has_the_final_state_of_a_bar(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "stderr", Terminal())
    log = tmp_path / "log"
    with logged(str(log)):
        swept("mine")
        print("done", file=sys.stderr, end="")
    assert "\r" in sys.stderr.getvalue()
    bar, last = log.read_text().splitlines()
    assert bar.startswith("mine: 100%")
    assert "10/10" in bar
    assert "1 failed" in bar
    assert "\r" not in log.read_text()
    assert last == "done"


def test_a_log_has_the_traceback(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with pytest.raises(ValueError, match="wrong"), logged(str(tmp_path / "log")):
        raise ValueError("wrong")
    assert "ValueError: wrong" in (tmp_path / "log").read_text()
    assert isinstance(sys.stderr, io.StringIO)


def test_what_a_user_can_repair_has_no_traceback(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with pytest.raises(SystemExit) as end, logged(str(tmp_path / "log")):
        raise JobError("give fewer")
    assert end.value.code == "give fewer"
    assert (tmp_path / "log").read_text() == "give fewer\n"
