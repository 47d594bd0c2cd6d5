"""The documentation of the library: file names, and public names."""

import re

from project import ROOT

import conveyor

LIBRARY = ROOT / "scripts/conveyor"
REFERENCE_PAGE = ROOT / "workflow/rules/pages/site/api_simulation.md"
README = (LIBRARY / "README.md").read_text()


def test_files_in_the_readme_exist():
    folder = LIBRARY
    for name in re.findall(r"`([\w/]+\.py)`", README):
        file = LIBRARY / name if (LIBRARY / name).is_file() else folder / name
        assert file.is_file() or name.startswith("tests/"), name
        folder = file.parent


def test_the_reference_page_has_every_public_name_once():
    page = REFERENCE_PAGE.read_text().partition("## Supporting modules")[0]
    constants = [name for row in re.findall(r"^\|.*", page, re.MULTILINE) for name in re.findall(r"`([A-Z_]+)`", row)]
    documented = re.findall(r"^\.\. auto\w+:: conveyor\.(\w+)$", page, re.MULTILINE)
    assert sorted(documented + constants) == sorted(conveyor.__all__)
