"""README, article, site and metadata from their templates, with the same facts in the same words.

A template is Markdown (or YAML) with Jinja fields. It can use the facts of facts.py and these names:

    figures           titles, sections, captions and labels of all figures, by name
    statements        the claims, with a margin and an uncertainty of each quantity
    tightened         number of claims evaluated with tighter tolerances
    same_verdicts     number of them whose verdict does not change
    gaps              keys of the config whose comment says that the paper leaves them open
    keys              all keys of the config by section, with the values of the default config
    entries           entries of the sections of the paper's config, with their comments
    modules           modules of the library by package
    figure(name)      a figure with its caption, in the markup of the medium
    cell(text)        a text for a cell of a table
    interval(low, high)   an accepted interval in words
"""

import json
import re
from collections.abc import Callable

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.pages.config_keys import FileKey, Key, list_keys, parse_file
from conveyor_pipeline.pages.facts import describe_interval, margin

# Markup of a subscript for pandoc and for Sphinx; captions are reStructuredText.
SUBSCRIPTS = {"print": r"~\1~", "site": r"{sub}`\1`"}
# Names of the paper's figures.
PAPER = re.compile(r"fig\d\d")
# The comment of a value that the paper leaves open.
OPEN = re.compile(r"\bopen\b")
# Sections of the config that do not describe the paper, so that the paper leaves nothing open in them.
NOT_OF_THE_PAPER = ("companion", "figures", "stability", "precision")


def figure_label(name: str) -> str:
    """ "Fig. 3" for a figure of the paper, "Figure `name`" for any other one."""
    return f"Fig. {int(name[3:])}" if PAPER.fullmatch(name) else f"Figure `{name}`"


def format_cell(text: str) -> str:
    """A text for a cell of a Markdown table."""
    return " ".join(str(text).split()).replace("|", "\\|")


def to_markdown(caption: str, medium: str) -> str:
    """A caption on one line of Markdown."""
    # In "m\\ :sub:`p`", the escaped space only separates the markup from the word.
    return re.sub(r"(?:\\ )?:sub:`([^`]*)`(?:\\ )?", SUBSCRIPTS[medium], " ".join(caption.split()))


def figure_for_pandoc(figure: dict, folder: str) -> str:
    """Markup of a figure for pandoc."""
    caption = re.sub(r"([\[\]])", r"\\\1", figure["caption"])
    return f"![**{figure['label']}.** {caption}](/{folder}{figure['name']}.pdf)"


def figure_for_sphinx(figure: dict, folder: str) -> str:
    """Markup of a figure for Sphinx."""
    name = figure["name"]
    return (
        f":::{{figure}} {folder}{name}.png\n:alt: {figure['title']}\n:scale: 50\n\n"
        f'**{figure["label"]}.** {figure["caption"]} (<a href="{folder}{name}.pdf">PDF</a>)\n:::'
    )


FIGURE: dict[str, Callable[[dict, str], str]] = {"print": figure_for_pandoc, "site": figure_for_sphinx}


def describe_figures(figures: dict[str, dict], captions: list[str], medium: str) -> dict[str, dict]:
    """The entries of figures with names, labels and captions; the README has no captions."""
    captions = captions or [""] * len(figures)
    return {
        name: {**entry, "name": name, "label": figure_label(name), "caption": to_markdown(caption, medium)}
        for (name, entry), caption in zip(figures.items(), captions, strict=True)
    }


def format_path(path: tuple[str, ...]) -> str:
    """The path of a key as text, "orbits.seeds[].z0"."""
    return ".".join(path).replace(".[]", "[]")


def find_gaps(defaults: list[FileKey]) -> list[dict]:
    """Keys that the paper leaves open, with their values and the comments that say so."""
    return [
        {"key": format_path(key.path), "value": key.value, "comment": comment}
        for key in defaults
        for comment in (key.beside, key.above)
        if OPEN.search(comment) and key.path[0] not in NOT_OF_THE_PAPER
    ]


def group_keys(known: list[Key], defaults: list[FileKey]) -> dict[str, list[dict]]:
    """All keys by section, with their default values; a key below a free name has none."""
    values = {key.path: key.value for key in defaults}
    by_section = {}
    for key in known:
        value = values.get(key.path, "")
        by_section.setdefault(key.path[0], []).append({**key._asdict(), "key": format_path(key.path), "value": value})
    return by_section


def list_entries(known: list[Key], defaults: list[FileKey]) -> dict[str, list[dict]]:
    """Entries of the sections in which the user names the entries, with their comments."""
    named = {key.path[0] for key in known if len(key.path) > 1 and key.path[1] == "NAME"}
    entries = {section: [] for section in named}
    for key in defaults:
        section, *names = key.path
        if section in named and len(names) == 1:
            entries[section].append({"name": names[0], "comment": key.above or key.beside})
    return entries


def group_modules(library: list[str]) -> dict[str, list[str]]:
    """Modules of the library by package; modules in no subpackage under "conveyor"."""
    by_package = {}
    for path in library:
        _, *package, _ = path.split("/")
        by_package.setdefault(package[0] if package else "conveyor", []).append(path.replace("/", "."))
    return by_package


def add_uncertainty(claims: dict[str, dict], tighter: dict[str, dict]) -> None:
    """Add the margin of each quantity, and its change at tighter tolerances; None for quantities without a change."""
    for name, claim in claims.items():
        changes = tighter.get(name, {}).get("changes", []) or [None] * len(claim["quantities"])
        for quantity, change in zip(claim["quantities"], changes, strict=True):
            decisive = quantity["paper_method"] if quantity["converged"] is None else quantity["converged"]
            quantity["margin"] = margin(decisive, quantity["accepted_low"], quantity["accepted_high"])
            quantity["uncertainty"] = change


def make(
    templates: list[str],
    facts: str,
    captions: list[str] = (),
    uncertainty: str = "{}",
    medium: str = "site",
    folder: str = "",
    config: list[str] = (),
    schema: str = "",
    library: list[str] = (),
) -> list[str]:
    """The pages from templates, in order.

    Parameters
    ----------
    facts : as facts.py makes them, as JSON
    captions : of all figures, in order
    uncertainty : changes of the claims with tighter tolerances, as JSON
    medium : print or site
    folder : folder of the figures, relative to the page
    config : texts of the default config files
    schema : JSON Schema of the config
    library : files of the library's modules, without extensions
    """
    defaults = [key for text in config for key in parse_file(text)]
    known = list(list_keys(json.loads(schema))) if schema else []
    collected = json.loads(facts)
    changes = json.loads(uncertainty)
    add_uncertainty(collected["statements"], changes)
    described = describe_figures(collected["figures"], captions, medium)
    fields = {
        **collected,
        "figures": described,
        "tightened": len(changes),
        "same_verdicts": sum(change["same_verdict"] for change in changes.values()),
        "gaps": find_gaps(defaults),
        "keys": group_keys(known, defaults),
        "entries": list_entries(known, defaults),
        "modules": group_modules(library),
        "figure": lambda name: FIGURE[medium](described[name], folder),
        "cell": format_cell,
        "interval": describe_interval,
        "medium": medium,
    }
    return [render(template, fields) for template in templates]
