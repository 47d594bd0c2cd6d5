"""Errors in the sections of the floor study."""

import pytest
from project import merged, read_config

from conveyor_pipeline.config import problems

# An overlay, and a part of the expected message.
WRONG = [
    (
        {"scene_budget": {"reasons": {"critical/egde": "none"}}},
        "scene_budget.reasons.critical/egde = 'critical/egde' is unknown; did you mean critical/edge?",
    ),
]


@pytest.mark.parametrize(("overlay", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_an_error_names_key_and_remedy(overlay, message):
    lines = problems(merged(read_config(), overlay))
    assert any(message in line for line in lines), lines
