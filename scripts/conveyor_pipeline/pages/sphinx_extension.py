"""Extension of Sphinx: formulas without a network, and docstrings and signatures in the library's style."""

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxTranslator

# Sphinx's expansion of NumPy's ArrayLike.
ARRAY_LIKE = re.compile(r"[~\w.]*_Buffer \|.*?_NestedSequence\[[^\[\]]*complex[^\[\]]*\]")
# Literal characters of docstrings, |x| and a * b, that are markup in reStructuredText.
LITERAL = re.compile(r"([|*])")


def inline(self: SphinxTranslator, node: nodes.math) -> None:
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def block(self: SphinxTranslator, node: nodes.math_block) -> None:
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def escape(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Escape bars and asterisks, because docstrings are plain text."""
    lines[:] = [LITERAL.sub(r"\\\1", line) for line in lines]


def shorten(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """The signature with the name ArrayLike in place of its expansion."""
    return signature and ARRAY_LIKE.sub("ArrayLike", signature), returned


def skip(app: Sphinx, what: str, name: str, obj: Any, skipped: bool, options: Any) -> bool | None:
    """Skip fields of named tuples that have no docstring."""
    return True if str(getattr(obj, "__doc__", "")).startswith("Alias for field number") else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the functions above; called by Sphinx."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    # Before napoleon, which adds markup.
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-skip-member", skip)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
