"""How long a newcomer waits for a figure: the first time, when the solver is compiled, and later."""

import json
import os
import subprocess
import sys
import tempfile
import time

FIGURE = "figures/fig22.pdf"  # of the README's first command


def make(snakefile: str, cores: int, target: str = FIGURE) -> str:
    """Wall times of two runs of Snakemake, as JSON: `first` with empty caches, and `later`, with all jobs again; s."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "snakemake", "--snakefile", os.path.abspath(snakefile), "--directory", folder]
        environment = os.environ | {"XDG_CACHE_HOME": os.path.join(folder, "cache")}
        # They would name caches that are not empty.
        for variable in ("NUMBA_CACHE_DIR", "MPLCONFIGDIR"):
            environment.pop(variable, None)
        seconds = {}
        for name, options in {"first": [], "later": ["--forceall"]}.items():
            begin = time.perf_counter()
            arguments = [*command, "--cores", str(cores), target, *options]
            run = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=False)
            if run.returncode:
                raise RuntimeError(f"Snakemake could not make {target}:\n{run.stderr}")
            seconds[name] = time.perf_counter() - begin
    return json.dumps(seconds, indent=1)
