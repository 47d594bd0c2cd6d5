"""The paper's statements: the files claims.yaml beside their findings. Imported by the Snakefile: no slow imports."""

from functools import cache
from pathlib import Path

from ruamel.yaml import YAML

PACKAGE = Path(__file__).resolve().parents[2]


@cache
def read_claims() -> dict[str, dict]:
    """The claims of all floors, in the order of their names."""
    files = [YAML(typ="safe").load(file) for file in PACKAGE.glob("*/claims/claims.yaml")]
    return dict(sorted((name, claim) for claims in files for name, claim in claims.items()))
