"""What Snakemake's linter says, and why that is left as it is."""

import re
import subprocess
import sys

from project import ROOT

# By the beginning of what it says: why it does not apply here.
ACCEPTED = {
    "Specify a conda environment or container for each rule.": "one environment for all, environment.txt, with hashes",
    "Mixed rules and functions in same snakefile.": "a stage's rules and what they alone need stand together",
    'Absolute path "/': "a separator of SECTION/NAME, no path",
    "Param file is a prefix of input or output file but hardcoded": "a picture, which its job opens by itself",
    "Param results is a prefix of input or output file but hardcoded": "results/PREFIX/, which the config names",
}


def test_the_linter_says_only_what_is_accepted():
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--lint"],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    said = set(re.findall(r"^    \* (.+)$", run.stdout, re.MULTILINE))
    assert said, run.stdout
    kinds = {line: next((kind for kind in ACCEPTED if line.startswith(kind)), None) for line in said}
    assert [line for line, kind in kinds.items() if kind is None] == []
    # What it does not say any more needs no reason.
    assert set(kinds.values()) == ACCEPTED.keys()
