"""Rule join_sweep: the shards of a sweep below each other."""

from conveyor import tables
from rule_log import logged

if __name__ == "__main__":
    with logged(snakemake.log[0]):
        tables.save(snakemake.output[0], tables.join(snakemake.input, "sweeps"))
