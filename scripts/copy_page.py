"""Rule claims_page: a made page, kept beside the sources."""

import shutil

from rule_log import logged

if __name__ == "__main__":
    with logged(snakemake.log[0]):
        shutil.copyfile(snakemake.input[0], snakemake.output[0])
