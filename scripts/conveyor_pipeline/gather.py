"""The script of the rule that joins the shards of a table in the order of their rows."""

import sys
from pathlib import Path

# Snakemake puts the folder of all packages last on the path; an installed copy of the library would come first.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from conveyor_pipeline.common import tables
from conveyor_pipeline.common.rule_log import check_code, logged

if __name__ == "__main__":
    with logged(snakemake.log[0]):
        check_code(snakemake.params.code)
        (kind,) = snakemake.output.keys()
        tables.gather(snakemake.output[0], snakemake.input, kind, snakemake.params.settings, snakemake.params.rows)
