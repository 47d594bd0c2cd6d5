"""The sources that a script depends on."""

import sys

import pytest
from project import ROOT

from conveyor_pipeline.common import imports, source_hash


@pytest.fixture
def scripts(tmp_path, monkeypatch):
    """A folder of small scripts in place of the project's."""
    files = {
        "use.py": "import numpy\nfrom library import solve\n",
        "read.py": "from library import tables\n",
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


@pytest.mark.parametrize(
    "statement",
    [
        "def main():\n    import library.deep",
        "if True:\n    pass\nelse:\n    import library.deep",
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
        *below_package("figures/plots", "paper/figures/fig22", "paper/fit/regressions", "paper/sweeps/shards")
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


PACKAGE = ROOT / "scripts/conveyor_pipeline"
STAGES = sorted(
    path.relative_to(PACKAGE).with_suffix("").as_posix()
    for path in PACKAGE.rglob("*.py")
    if "\nTABLES = {" in path.read_text(encoding="utf-8")
)


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
