"""The results to test: CONVEYOR_RESULTS names their folder, CONVEYOR_FIGURES has the section `figures` of the config.

Without these variables, the results of the paper's config.
"""

import json
import os
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
RESULTS = Path(os.environ.get("CONVEYOR_RESULTS", ROOT / "results")).resolve()
PREFIX = [] if RESULTS.name == "results" else [RESULTS.name]
FIGURES = RESULTS.parents[len(PREFIX)].joinpath("figures", *PREFIX)


def defaults(section: str) -> dict[str, dict]:
    """The entries of a section in the defaults of all floors."""
    files = sorted((ROOT / "config/defaults").glob(f"*/{section}.yaml"))
    return {name: entry for file in files for name, entry in yaml.safe_load(file.read_text())[section].items()}


def entries() -> dict[str, dict]:
    """The entries of the figures by their names."""
    if "CONVEYOR_FIGURES" in os.environ:
        return json.loads(os.environ["CONVEYOR_FIGURES"])
    return defaults("figures")
