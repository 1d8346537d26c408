r"""Formulas as MathML, which browsers draw by themselves: no script, nothing from a network.

A ``\tag{30}`` puts a number beside a formula that stands alone: here those of the paper.
"""

from __future__ import annotations

import re

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

TAG = re.compile(r"\\tag\{(.*?)\}")


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    translator.body.append(mathml(node, node.astext(), alone=False))
    raise nodes.SkipNode


def block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on lines of its own."""
    text = node.astext()
    numbers = "".join(f'<span class="eqno">({tag})</span>' for tag in TAG.findall(text))
    formula = mathml(node, TAG.sub("", text), alone=True)
    translator.body.append(f'<div class="formula">{formula}{numbers}</div>\n')
    raise nodes.SkipNode


def mathml(node: nodes.Node, text: str, *, alone: bool) -> str:
    """Translate a formula; one that cannot be is a warning of the build."""
    try:
        return str(latex2mathml.tex2mathml(text, as_block=alone))
    except MathError as error:
        logging.getLogger(__name__).warning("%s in %s", error, text, location=node)
        return ""


def setup(app: Sphinx) -> dict[str, bool]:
    """Offer Sphinx the renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
