"""Formats of numbers and lists in templates."""

import pytest

from conveyor_pipeline.common.templates import render


@pytest.mark.parametrize(
    ("field", "text"),
    [
        ("1 / 3", "0.333333"),
        ("2.0", "2"),
        ("3.1e-10", "3.1e-10"),
        ("1e-9", "1e-9"),
        ("1234567.0", "1.23457e6"),
        ("1234567", "1234567"),
        ("1234567 | thousands", "1,234,567"),
        ("0.00123456 | number", "0.001235"),
        ("none | number", "–"),
        ("nan | number", "–"),
        ("2.61e-9 | plain(1)", "3e-9"),
        ("1.21e-9 | round_up", "1.3e-9"),
        ("1.2 | round_up", "1.2"),
        ("1234.0 | significant(2)", "1200"),
        ("[0.0648, 0.141] | range", "0.0648 to 0.141"),
        ("[0.1, 0.10001] | range", "0.1"),
        ("[nan, nan] | range", "not known"),
        ("[] | listed", ""),
        ("['a'] | listed", "a"),
        ("[0.5, 2.0, 'c'] | listed", "0.5, 2 and c"),
    ],
)
def test_formats_of_fields(field, text):
    assert render(f"{{{{ {field} }}}}", {"nan": float("nan")}) == text
