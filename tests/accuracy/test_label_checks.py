"""A sample of what `snakemake results/label_checks.parquet` looks at in full."""

import pandas as pd
from project import read_config

from accuracy import label_checks

CONFIG = read_config()
SETTINGS = {
    **CONFIG["label_checks"],
    "acceleration": [53.0, 61.0, 73.0],
    "starts": 8,
    "unshared": 2,
    "model": CONFIG["model"],
    "settling": CONFIG["solver"]["settling"],
    "tolerance": CONFIG["solver"]["tolerance"],
}


def test_each_start_earns_its_own_label():
    table = pd.DataFrame(label_checks.make(SETTINGS, threads=2))
    assert table.starts.tolist() == [8, 8, 8]
    assert 0 < table.chaotic.sum() < 24
    assert table[["reversed", "alone", "unshared"]].eq(0).all(axis=None)


def test_a_label_that_depends_on_the_order_is_seen(monkeypatch):
    """One that goes by the place in the list."""
    true = label_checks.labels.classify

    def by_place(rows, **options):
        found = true(rows, **options)
        return found._replace(period=found.period + (rows[0, -2] > rows[-1, -2]))

    monkeypatch.setattr(label_checks.labels, "classify", by_place)
    few = SETTINGS | {"acceleration": [40.0]}
    table = pd.DataFrame(label_checks.make(few))
    assert table.reversed.tolist() == [8]
