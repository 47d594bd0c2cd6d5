"""Numbers typed into the text of a template, where a table should give them."""

import re

# Allowed: fields, references, citations, names, units, code, and single digits in formulas.
ALLOWED = (
    r"\{\{.*?\}\}|\{%.*?%\}",
    r"(?ms)^```.*?^```$",
    r"`[A-Za-z./{(][^`\n]*`",
    r"`[\d.]+ (deg|g|mm|Hz|rpm|%)`",
    r"\]\([^)\s]*\)",
    r"\b(Figs?|Eqs?|Sects?)\. \d+(\.\d+)?(( and|,| to) \d+(\.\d+)?)*",
    r"\bC\d\d\b",
    r":sub:`\d`",
    r"(?m)^:scale: \d+$|^\d+\. ",
    r"(?m)^:::\{figure\} \S+$",
    r"1/s\b",
    r"Γ [<>] 1\b",
    r"\b[A-Z]\w+ \((18|19|20)\d\d\)|\([A-Z][^()\d]* (18|19|20)\d\d(;\s[A-Z][^()\d]* (18|19|20)\d\d)*\)",
    r"(?ms)^## References.*?(?=^## )",
    r"a confidence of 95 %",
    r"DOP853|RK4\d?|SHA-256|BSD-3-Clause|Python 3\.1[14]( to 3\.14)?|x86-64|\bD_2\b",
)
FORMULA = re.compile(r"\$\$.*?\$\$|\$[^$\n]*\$", re.DOTALL)
WORDS = r"\b(?:eleven|twelve|thirteen|fifteen|twenty|thirty|fifty|hundred)\b"


def typed(template: str) -> list[str]:
    """Digits and number words that are typed into a template."""
    for pattern in ALLOWED:
        template = re.sub(pattern, " ", template)
    template = FORMULA.sub(lambda formula: re.sub(r"(?<![\d.])\d(?![\d.])", "", formula[0]), template)
    return re.findall(rf"\S*\d\S*|{WORDS}", template)
