"""Check overlays: python -m workflow.config FILE …

Snakemake itself reads overlays first, and says of invalid YAML neither the file nor the line.
"""

import sys

from . import ConfigError, load_config
from .files import DEFAULT_FILES

try:
    load_config(DEFAULT_FILES, sys.argv[1:], {})
except ConfigError as error:
    sys.exit(str(error))
print("The config is valid.")
