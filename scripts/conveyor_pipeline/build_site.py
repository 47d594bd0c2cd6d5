"""The script of the rule that makes the site: it collects pages, pictures and files, and runs Sphinx."""

import sys
import tempfile
from pathlib import Path

import numba

# Snakemake puts the folder of all packages last on the path; an installed copy of the library would come first.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from conveyor_pipeline.common.rule_log import check_code, logged
from conveyor_pipeline.pages import site

if __name__ == "__main__":
    # Compiled functions have no signature for the documentation. Must be set before Sphinx imports the library.
    numba.config.DISABLE_JIT = True
    with logged(snakemake.log[0]), tempfile.TemporaryDirectory() as folder:
        check_code(snakemake.params.code)
        inputs = snakemake.input
        extra = {"figures": inputs.pdf, "": [inputs.article, inputs.companion]}
        pages = {
            "": [*inputs.pages, *inputs.examples, *inputs.pictures],
            "guides": inputs.guides,
            "diagrams": inputs.diagrams,
        }
        site.gather(folder, pages, inputs.style, inputs.png, extra)
        site.build(folder, snakemake.output[0])
