"""The sources that a script depends on."""

import sys

import pytest
from project import ROOT

from conveyor_pipeline.common import imports, source_hash

# Stages that call functions of other stages; the budget makes the tables of figures again with other settings.
CALLS = {
    "study/accuracy/scene_budget": {
        "paper/dimensions/portraits",
        "paper/motion/critical",
        "paper/motion/impacts",
        "paper/motion/signals",
        "paper/motion/spectra",
        "paper/orbits/estimates",
        "paper/orbits/exponents",
        "paper/orbits/strobes",
        "paper/sweeps/shards",
    },
    "machine/operating/advice": {"machine/operating/transit"},
    "machine/operating/bodies": {"machine/operating/transit"},
    "machine/operating/start": {"machine/operating/transit"},
    "machine/contact/variants": {"machine/operating/transit"},
    "machine/operating/drift": {"machine/operating/transit"},
    "machine/operating/track": {"machine/operating/shares"},
    "machine/operating/drive": {"machine/operating/transit"},
    "machine/excitation/clean_drive": {"machine/operating/transit"},
    "machine/excitation/comparison": {"machine/operating/transit"},
    "machine/operating/throws": {"machine/operating/shares"},
}


@pytest.fixture
def scripts(tmp_path, monkeypatch):
    """A folder of small scripts in place of the project's."""
    files = {
        "use.py": "import numpy\nfrom library import solve\n",
        "read.py": "from library import tables\n",
        "late.py": "def main():\n    import library.deep\n",
        "library/__init__.py": "from .solver import solve\n",
        "library/solver.py": "from . import deep\nsolve = deep.solve\n",
        "library/deep.py": "from .model import g\n",
        "library/model.py": "import math\ng = 9.81\n",
        "library/tables.py": "from .model import g\n",
        "pick.py": "from lazy import g\n",
        "lazy/__init__.py": "import loader\n",
        "lazy/__init__.pyi": "from .model import g\nfrom .other import h\n",
        "lazy/model.py": "g = 9.81\n",
        "lazy/other.py": "h = 1\n",
    }
    for package in ("library", "lazy"):
        (tmp_path / package).mkdir()
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(source_hash, "SCRIPTS", tmp_path)
    yield tmp_path
    source_hash.source_hash.cache_clear()


def modules(*scripts):
    files, _ = source_hash.closure(*scripts)
    return {str(file.relative_to(source_hash.SCRIPTS)) for file in files}


def below_package(*modules):
    """Modules of the pipeline, as paths below scripts/."""
    return [f"conveyor_pipeline/{module}" for module in modules]


def test_imports_are_followed_to_any_depth(scripts):
    library = {"library/__init__.py", "library/solver.py", "library/deep.py", "library/model.py"}
    assert modules("use") == {"use.py", *library}
    assert source_hash.closure("use")[1] == ["math", "numpy"]


def test_the_package_of_an_imported_module_does_not_count(scripts):
    assert modules("read") == {"read.py", "library/tables.py", "library/model.py"}


def test_a_public_name_depends_on_its_own_module_only(scripts):
    assert modules("pick") == {"pick.py", "lazy/model.py"}


def test_imports_inside_functions_count(scripts):
    assert modules("late") == {"late.py", "library/deep.py", "library/model.py"}


@pytest.mark.parametrize(
    "statement",
    [
        "class A:\n    import library.deep",
        "if True:\n    pass\nelse:\n    import library.deep",
        "for x in ():\n    with x:\n        import library.deep",
        "while False:\n    pass\nelse:\n    import library.deep",
        "try:\n    import library.deep\nfinally:\n    pass",
        "try:\n    pass\nexcept OSError:\n    import library.deep",
        "try:\n    pass\nfinally:\n    import library.deep",
        "match 1:\n    case 1:\n        import library.deep",
    ],
)
def test_imports_inside_any_statement_count(scripts, statement):
    (scripts / "some.py").write_text(statement)
    assert modules("some") == {"some.py", "library/deep.py", "library/model.py"}


def test_hash_changes_only_with_imported_files(scripts):
    def write(file: str, text: str) -> None:
        (scripts / file).write_text(text)
        # A process reads each file once.
        imports.direct_imports.cache_clear()
        source_hash.content.cache_clear()
        source_hash.source_hash.cache_clear()

    before = source_hash.source_hash("read")
    write("library/deep.py", "solve = None\n")
    assert source_hash.source_hash("read") == before
    write("library/model.py", "g = 9.8\n")
    assert source_hash.source_hash("read") != before


@pytest.mark.parametrize("package", ["numpy", "python"])
def test_hash_changes_with_the_version_of_packages(scripts, monkeypatch, package):
    before = source_hash.source_hash("use")
    true = source_hash.version
    monkeypatch.setattr(source_hash, "version", lambda name: "0.0" if name == package else true(name))
    if package == "python":
        monkeypatch.setattr(source_hash, "PYTHON", "0.0")
    source_hash.source_hash.cache_clear()
    assert source_hash.source_hash("use") != before


def test_a_patch_of_python_reruns_nothing():
    assert f"python=={sys.version_info.major}.{sys.version_info.minor}" in source_hash.versions([])


def test_every_package_behind_a_number_or_a_picture_counts():
    """They are found from imports, without a list: pandas, and indirectly llvmlite and pillow."""
    _, packages = source_hash.closure(
        *below_package("draw", "paper/figures/fig22", "paper/fit/regressions", "paper/sweeps/shards")
    )
    names = {one.split("==")[0] for one in source_hash.versions(packages)}
    assert {
        "python",
        "pandas",
        "numpy",
        "numba",
        "llvmlite",
        "matplotlib",
        "pillow",
        "pyarrow",
        "pymoo",
        "scipy",
    } <= names
    assert not names & {"math", "dataclasses"}


def test_checks_of_the_config_rerun_nothing():
    files = [path for path in source_hash.SCRIPTS.rglob("*.py") if path.name != "settings.py"]
    scripts = {str(path.relative_to(source_hash.SCRIPTS).with_suffix("")) for path in files}
    # Pages show the comments of the config files and where the workflow puts its tables.
    readers = ("pages/article", "pages/config_keys", "pages/pages", "pages/tables_page")
    # What the Snakefile imports, but no job.
    checks = {
        script for script in scripts if "/config/" in script or script.endswith(("/checks", "/budgeted", "/statements"))
    }
    assert len(checks) > 10
    files, packages = source_hash.closure(*scripts - checks - {*below_package(*readers)})
    assert "numpy" in packages
    assert not {"pydantic", "pydantic_core", "ruamel", "yaml", "snakemake"} & set(packages)
    assert [file for file in files if file.parent.name == "config"] == []


@pytest.mark.parametrize(
    ("module", "users"),
    [
        ("solver/contact.py", {"paper/sweeps/shards", "paper/orbits/estimates"}),
        ("analysis/chaos/lyapunov.py", {"paper/sweeps/shards"}),
        ("analysis/attractors/labels.py", {"paper/sweeps/shards"}),
        ("analysis/chaos/pairs.py", {"paper/orbits/estimates"}),
    ],
)
def test_an_analysis_reruns_only_what_uses_it(module, users):
    """Labels need exponents; estimates from pairs of trajectories need no labels."""
    stages = ("paper/sweeps/shards", "paper/orbits/estimates")
    assert {stage for stage in stages if f"conveyor/{module}" in modules(*below_package(stage))} == users


def test_plots_depend_on_no_solver():
    for figure in ("fig03", "fig22"):
        files = (
            "draw",
            "common/code_state",
            "common/imports",
            "common/rule_log",
            "common/source_hash",
            "common/tables",
            "figures/style",
            "figures/titles",
            f"paper/figures/{figure}",
        )
        assert modules(*below_package("draw", f"paper/figures/{figure}")) == {
            f"{file}.py" for file in below_package(*files)
        }


PACKAGE = ROOT / "scripts/conveyor_pipeline"
STAGES = sorted(
    path.relative_to(PACKAGE).with_suffix("").as_posix()
    for path in PACKAGE.rglob("*.py")
    if "\nTABLES = {" in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("stage", STAGES)
def test_only_a_stage_itself_has_the_columns_of_its_tables(stage):
    """A new description of a column reruns the stage and the stages that call its functions, but no other stage."""
    users = {other for other in STAGES if PACKAGE / f"{stage}.py" in source_hash.closure(*below_package(other))[0]}
    assert users == {stage} | {user for user, used in CALLS.items() if stage in used}


def test_the_list_of_calls_names_stages():
    assert set(STAGES) >= {*CALLS, *(stage for used in CALLS.values() for stage in used)}


@pytest.mark.parametrize("stage", STAGES)
def test_a_table_depends_on_the_values_of_its_settings_but_not_on_their_declarations(stage):
    """Otherwise a new description or range of one setting would rerun all tables."""
    assert [file for file in source_hash.closure(*below_package(stage))[0] if file.name == "settings.py"] == []


def test_the_library_knows_nothing_of_snakemake():
    for module in (source_hash.SCRIPTS / "conveyor").rglob("*.py"):
        _, imported = imports.direct_imports(module, source_hash.SCRIPTS)
        # `to_frame` imports pandas when it is called.
        frames = {"pandas"} if module.name == "columns.py" else set()
        assert not imported & {"snakemake", "conveyor_pipeline", "pandas", "pyarrow"} - frames, module
