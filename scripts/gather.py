"""The script of the rule that joins the shards of a table in the order of their rows."""

from functools import partial

from pipeline import grid, tables
from pipeline.rule_log import logged

if __name__ == "__main__":
    with logged(snakemake.log[0]):
        (kind,) = snakemake.output.keys()
        params = snakemake.params
        expected = partial(grid.columns_of_axes, params.settings["axes"])
        tables.gather(snakemake.output[0], snakemake.input, kind, params.settings, params.points, expected)
