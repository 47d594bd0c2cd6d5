"""The claims: all there, each with a verdict, each verdict other than `reproduced` with a reason."""

from claims import FINDINGS, NOT_REPRODUCED, PAPER_METHOD_ONLY, REPRODUCED


def test_every_claim_has_a_verdict(result):
    table = result("claims")
    assert list(table.id) == sorted(FINDINGS)
    assert set(table.verdict) <= {REPRODUCED, PAPER_METHOD_ONLY, NOT_REPRODUCED}


def test_every_other_verdict_has_a_reason_with_numbers(result):
    table = result("claims")
    others = table[table.verdict != REPRODUCED]
    assert others.reason.notna().all()
    assert others.reason.str.contains(r"\d").all()
