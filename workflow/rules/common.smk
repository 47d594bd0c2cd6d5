# Names of files, common params and functions that the rules share.
import os
import re
import signal

from conveyor_pipeline.figures.titles import caption_file, package_of, title_of
from conveyor_pipeline.common.code_state import STATE, code_state
from conveyor_pipeline.common.source_hash import code_of
from conveyor_pipeline.config.entries import ENTRIES
from conveyor_pipeline.config.files import DEFAULT_FILES, ROOT
from conveyor_pipeline.config.tables import kind_of, references, references_of, settings_of

# Jobs compare it with the files that they import.
os.environ[STATE] = code_state()

# Keep pyarrow's allocator from huge pages: clearing one takes 5 to 14 ms on a virtual machine, and joining shards takes 8 % more
# memory with them.
os.environ.setdefault("MIMALLOC_ALLOW_THP", "0")

# One thread of BLAS: its sums must not depend on the number of cores, and to start more takes 0.1 s of processor time per job.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# If the terminal is closed, Snakemake ends as after SIGTERM and removes its lock. Under nohup it goes on.
if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
    signal.signal(signal.SIGHUP, lambda number, frame: signal.raise_signal(signal.SIGTERM))

# "" or "NAME/": a config with a prefix has its own folder of results and figures.
PREFIX = config["prefix"] and f"{config['prefix']}/"
# Not workflow.cores, which fails without the option --cores, as in --report and --unlock.
CORES = workflow.resource_settings.cores or 1
THREADS = 2  # of a job with threads, so that a small machine runs it, and a large one several of them

# What the floors add to.
FLOOR_FILES = []  # files of the target `all`
NO_FIGURES = {}  # figures that this config cannot make, with the reasons
BUILT = []  # files of a build besides figures, captions and their tables
TESTED = []  # beginnings of the names of tables that tests of the results read
TIMED = []  # kinds of tables with measured times, which differ from build to build
TIMED_PAGES = []  # pages with measured times
PRECISION = {}  # the tables of errors and of times of all methods, by scene


# -- names of files ----------------------------------------------------------------------------------------------------


def source(path):
    """A file of this workflow, also when Snakemake runs in another folder.

    It is not in an object storage, and the `prefix` of a module does not apply to it.
    """
    return local(os.path.relpath(ROOT / path))


def sources(pattern):
    """The files of this workflow that match a pattern, without compiled Python."""
    return sorted(source(path) for path in ROOT.glob(pattern) if path.is_file() and path.suffix != ".pyc")


def modules(pattern):
    """The modules of scripts/ that match a pattern, as paths below it without ".py"."""
    files = sorted((ROOT / "scripts").glob(f"{pattern}.py"))
    return [file.relative_to(ROOT / "scripts").with_suffix("").as_posix() for file in files if file.stem != "__init__"]


def result(name):
    return f"results/{PREFIX}{name}"


def log_file(name):
    return result(f"logs/{name}.log")


def benchmark_file(name):
    """The costs of a job, which the provenance of a build sums: not of pages and other files that are made on request."""
    return result(f"benchmarks/{name}.tsv")


def table(reference):
    """The file of the table SECTION/NAME; tables of the section `results` lie in the folder of results itself."""
    return result(f"{reference.removeprefix('results/')}.parquet")


def reference_of(file):
    """The name SECTION/NAME of the table in a file."""
    name = file.rpartition(f"results/{PREFIX}")[2].removesuffix(".parquet")
    return name if os.path.dirname(name) else f"results/{name}"


def tables_of(*references):
    """Inputs or outputs: the files of tables, by the names of the tables."""
    return {reference.split("/")[1]: table(reference) for reference in references}


def figure_file(figure, ending="pdf"):
    return f"figures/{PREFIX}{figure}.{ending}"


def listed_figures(*names):
    """The figures with these names that this config has."""
    return [name for name in names if name in config["figures"]]


def figure_files(figures=config["figures"], ending="pdf"):
    """The files of some figures, or of all figures that are made without an explicit target."""
    return [figure_file(figure, ending) for figure in figures]


def caption_files(figures=config["figures"]):
    return [result(f"captions/{figure}.rst") for figure in figures]


def one_of(names):
    """A wildcard constraint: one of these names."""
    return "|".join(map(re.escape, names)) or "(?!)"


# Tests of the results, which apply to the paper's conveyor only.
RESULT_TESTS = sources("tests/results/**/*.py") if IS_PAPER else []


# -- params ------------------------------------------------------------------------------------------------------------


def stage(module, reference=None, scripts=lambda wildcards: ()):
    """Common params of jobs with the script make.py.

    They are the module that the script calls, the hash of all code behind it, what each input table must be, and the
    settings of the table SECTION/NAME that the job makes (`reference`). Module and table may have wildcards; `scripts` returns further
    scripts, which the module imports by name.
    """

    def code(wildcards):
        return code_of("conveyor_pipeline/make", module.format(**wildcards).replace(".", "/"), *scripts(wildcards))

    # Not a function of the output: Snakemake does not rerun jobs after a change of params that depend on inputs or outputs.
    def settings(wildcards):
        return settings_of_table(reference.format(**wildcards))

    params = {"stage": module, "code": code, "expected": expected}
    return params | {"settings": settings} if reference else params


def settings_of_table(reference):
    """The settings of the table SECTION/NAME; an error if this config has none."""
    section, name = reference.split("/")
    if section in ENTRIES and name not in config[section]:
        raise WorkflowError(f"the config has no entry {section}.{name}; add it, or name another entry")
    return settings_of(config, reference)


def check_paper(target):
    """An error for a target about the paper's conveyor, if this config has another model."""
    if not IS_PAPER:
        raise WorkflowError(
            f"{target} is about the paper's conveyor, but this config has another model, or names measurements; use the paper's config"
        )


def expected(wildcards, input):
    """A param: kind and settings that each input table must have, so that no other table is read in its place."""
    references = {file: reference_of(file) for file in input if file.endswith(".parquet")}
    return {file: [kind_of(name), settings_of_table(name)] for file, name in references.items()}


# -- figures ---------------------------------------------------------------------------------------------------------

FIGURES = config["figures"] | config["figures_on_request"]


def settings_of_figure(figure):
    """The settings of a figure, with the paper's numbers that it marks in the results without a prefix."""
    entry = FIGURES[figure]
    return entry.get("settings", {}) | ({} if PREFIX else entry.get("marks", {}))


def figure_modules(figure, part="figures"):
    """The module of a figure, as a list of its path below scripts/ without ".py"; an empty list if there is none."""
    package = package_of(figure, part)
    return [f"{package.replace('.', '/')}/{figure}"] if package else []


def tables_of_figure(wildcards):
    """The tables that a figure draws, by their roles; an error for a figure that this config cannot make."""
    if reason := NO_FIGURES.get(wildcards.figure):
        raise WorkflowError(f"{figure_file(wildcards.figure)} cannot be made with this config: {reason}")
    return {role: table(reference) for role, reference in FIGURES[wildcards.figure]["tables"].items()}


def tables_of_caption(wildcards):
    """The tables that a figure draws, and further tables of its caption, by their roles."""
    tables = tables_of_figure(wildcards)
    further = FIGURES[wildcards.figure].get("caption_tables", {})
    return tables | {role: table(reference) for role, reference in further.items()}


def section_in_report(wildcards):
    """The category of a figure in Snakemake's report."""
    section = FIGURES[wildcards.figure]["section"]
    return f"Section {section}" if wildcards.figure in PAPER_FIGURES else f"Section {section}, beyond the paper"


def labels_in_report(wildcards):
    """The labels of a figure in Snakemake's report, which takes {name} for a wildcard."""
    title = title_of(wildcards.figure)
    return {"figure": wildcards.figure, "title": title.replace("{", "{{").replace("}", "}}")}
