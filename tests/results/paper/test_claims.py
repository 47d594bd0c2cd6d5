"""The claims are complete and unchanged, and each verdict other than `reproduced` has a reason."""

import re

import numpy as np
import pytest

from conveyor_pipeline.paper.claims.statements import read_claims
from conveyor_pipeline.paper.claims.verdicts import NOT_REPRODUCED, PAPER_METHOD_ONLY, REPRODUCED
from made import RESULTS, ROOT

PAGE = ROOT / "docs/claims.md"
# Claims whose tables are the same on coarse axes.
ON_ANY_AXES = ("C07", "C08", "C12", "C13", "C14", "C20", "C23")
# Relative tolerance of the comparison with the page, which has four digits.
DIGITS = 3e-3


def kept() -> dict[str, dict]:
    """The numbers and verdicts of the page in the repository, by claim."""
    rows = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("| C"):
            name, *_, paper_method, converged, _, verdict = line.strip("| ").split(" | ")
            rows[name] = {
                "paper_method": numbers_in(paper_method),
                "converged": numbers_in(converged),
                "verdict": verdict.strip("*"),
            }
    return rows


def numbers_in(cell: str) -> list[float]:
    return [] if cell == "–" else [np.nan if part == "–" else float(part) for part in cell.split(", ")]


def differences(table, names) -> list[str]:
    """Claims that differ from the page, with both values."""
    found, page = [], kept()
    for row in table[table.id.isin(names)].itertuples():
        was = page[row.id]
        if row.verdict != was["verdict"]:
            found.append(f"{row.id} is {row.verdict}, on the page {was['verdict']}")
        for column in ("paper_method", "converged"):
            now = np.array(getattr(row, column), dtype=float)
            before = np.array(was[column])
            if now.shape != before.shape or not np.allclose(now, before, rtol=DIGITS, atol=1e-9, equal_nan=True):
                found.append(f"{row.id} has {column} {now.tolist()}, on the page {before.tolist()}")
    return found


def test_every_claim_has_a_verdict(result):
    table = result("claims")
    assert list(table.id) == list(read_claims())
    assert set(table.verdict) <= {REPRODUCED, PAPER_METHOD_ONLY, NOT_REPRODUCED}


def test_every_other_verdict_has_a_reason_with_numbers(result):
    others = result("claims").query("verdict != @REPRODUCED")
    assert others.reason.notna().all()
    assert others.reason.str.contains(r"\d").all()
    assert not others.reason.str.contains("nan").any()


def test_every_limit_has_a_reason(result):
    table = result("claims")
    assert all(len(because) == len(low) for because, low in zip(table.because, table.accepted_low, strict=True))
    assert all(re.search("[a-z]{3}", text) for row in table.because for text in row)


@pytest.mark.skipif(RESULTS != ROOT / "results", reason="other axes than the page of claims has")
def test_verdicts_and_numbers_agree_with_the_page(result):
    """docs/claims.md is made by a separate rule, so it changes only on request."""
    table = result("claims")
    assert set(kept()) == set(table.id)
    assert differences(table, table.id) == []


def test_claims_that_do_not_depend_on_axes_agree_with_the_page(result):
    table = result("claims")
    assert differences(table, ON_ANY_AXES) == []
