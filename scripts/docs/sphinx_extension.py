"""Extension of Sphinx: formulas without a network, and docstrings and signatures in the form that the library uses."""

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxTranslator

# How Sphinx spells out NumPy's ArrayLike.
ARRAY_LIKE = re.compile(r"[~\w.]*_Buffer \|.*?_NestedSequence\[[^\[\]]*complex[^\[\]]*\]")
# What reStructuredText takes for markup and docstrings mean literally: |x| and a * b.
LITERAL = re.compile(r"([|*])")


def inline(self: SphinxTranslator, node: nodes.math) -> None:
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def block(self: SphinxTranslator, node: nodes.math_block) -> None:
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def escape(app: Sphinx, what: str, name: str, of: Any, options: Any, lines: list[str]) -> None:
    """Docstrings are plain text: bars and asterisks in them are no markup."""
    lines[:] = [LITERAL.sub(r"\\\1", line) for line in lines]


def shorten(
    app: Sphinx, what: str, name: str, of: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """A signature with ArrayLike by its name."""
    return signature and ARRAY_LIKE.sub("ArrayLike", signature), returned


def skip(app: Sphinx, what: str, name: str, of: Any, skipped: bool, options: Any) -> bool | None:
    """Fields of a named tuple say no more than their number."""
    return True if str(getattr(of, "__doc__", "")).startswith("Alias for field number") else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    # Before napoleon, which writes markup.
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-skip-member", skip)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
