"""Rule companion: the page to play with, one HTML file."""

from pathlib import Path

from conveyor import tables
from docs.companion import build
from rule_log import logged

if __name__ == "__main__":
    with logged(snakemake.log[0]):
        maps = [tables.read(path, "sweeps") for path in snakemake.input.maps]
        text = build.page(maps, snakemake.params.settings)
        Path(snakemake.output[0]).write_text(text, encoding="utf-8")
