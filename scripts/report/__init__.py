"""Stage report: the pages that `snakemake --report` shows, figures beside their captions."""
