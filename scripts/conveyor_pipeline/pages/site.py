"""The site: HTML by Sphinx from pages in Markdown, with pictures for screens."""

import shutil
from collections.abc import Iterable
from io import StringIO
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.docutils import docutils_namespace, patch_docutils

from conveyor_pipeline.pages import pictures

SETTINGS = {
    "project": "Dynamics of a vibratory conveyor",
    "html_title": "Dynamics of a vibratory conveyor",
    "extensions": [
        "myst_parser",
        "sphinx.ext.autodoc",
        "sphinx.ext.napoleon",
        "conveyor_pipeline.pages.sphinx_extension",
    ],
    "myst_enable_extensions": ["colon_fence", "dollarmath"],
    "myst_heading_anchors": 3,
    "html_theme": "furo",
    "html_copy_source": False,
    "html_show_copyright": False,
    "html_last_updated_fmt": None,
    "html_extra_path": ["extra"],
    "html_static_path": ["style"],
    "html_css_files": ["site.css"],
    "autodoc_member_order": "bysource",
    "autodoc_typehints": "signature",
    "napoleon_use_ivar": True,
    "napoleon_use_rtype": False,
    "default_role": "code",
    "add_module_names": False,
    "html_math_renderer": "mathml",
}


def gather(
    folder: str, pages: dict[str, Iterable[str]], style: str, figures: Iterable[str], extra: dict[str, Iterable[str]]
) -> None:
    """Copy the sources of the site into a folder.

    Parameters
    ----------
    folder : of the sources
    pages : Markdown pages and their pictures, by folder of the site
    style : the style sheet
    figures : PNG files, scaled down into figures/
    extra : files that are copied unchanged, by target folder
    """
    source = Path(folder)
    (source / "style").mkdir()
    shutil.copyfile(style, source / "style" / Path(style).name)
    for place, files in pages.items():
        (source / place).mkdir(exist_ok=True)
        for file in files:
            shutil.copyfile(file, source / place / Path(file).name)
    (source / "figures").mkdir()
    for figure in figures:
        pictures.make(figure).save(source / "figures" / Path(figure).name)
    for place, files in extra.items():
        (source / "extra" / place).mkdir(parents=True, exist_ok=True)
        for file in files:
            shutil.copyfile(file, source / "extra" / place / Path(file).name)


def build(source: str, output: str) -> None:
    """Run Sphinx on a folder of pages.

    Raises
    ------
    RuntimeError
        with all warnings if there are any: for a missing page, a broken link, an invalid docstring
    """
    warnings = StringIO()
    doctrees = str(Path(source, "_doctrees"))
    # As in Sphinx's own command: a build must not see what an earlier one registered with docutils.
    with patch_docutils(source), docutils_namespace():
        app = Sphinx(source, None, output, doctrees, "html", SETTINGS, status=None, warning=warnings, freshenv=True)
        app.build(force_all=True)
    if app.statuscode or warnings.getvalue():
        raise RuntimeError(f"Sphinx reports problems; correct the pages that it names:\n{warnings.getvalue()}")
    Path(output, ".buildinfo").unlink(missing_ok=True)
