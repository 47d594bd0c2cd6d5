"""Pages from their templates: README, article, site and metadata tell the same facts in the same words.

A template is Markdown (or YAML) with Jinja's fields. What it may ask for: the facts of docs.facts, and the names below.

    prefix            of the config; nothing for the paper's
    step              of the paper's method, s
    tighter           how many times tighter the tolerances are from which the uncertainty of the claims follows
    figures           titles, sections, captions and labels of all figures, by their names
    of_the_paper      names of the paper's figures; the others are this project's own
    statements        the claims as docs.facts tells them, with their uncertainty
    tightened         how many of them were looked at with tighter tolerances; same_verdicts: how many did not change
    costs             seconds, memory (MiB) and jobs of all `figures`, all `claims`, and of `everything`
    gaps              keys of the config whose comment says that the paper leaves them open
    keys              all keys of the config, by their sections, with the values of the default config
    entries           entries of a section of the paper's config, with the comments above them
    modules           modules of the library, by the rooms they stand in
    proved            the page of what is proved
    columns           the page of all tables and their columns
    findings          the page of what was found beyond the paper
    figure(name)      a figure with its caption, as the medium wants it
    cell(text)        a text for a cell of a table
"""

import json
import re
from collections import Counter
from collections.abc import Callable

import pandas as pd

from docs.config_keys import Key, Written, keys, written
from docs.facts import facts, of_claims, plain
from pipeline.templates import render

# How a subscript is written for pandoc and for Sphinx; captions are reStructuredText.
SUBSCRIPTS = {"print": r"~\1~", "site": r"{sub}`\1`"}
# Names of the paper's figures.
PAPER = re.compile(r"fig\d\d")
OPEN = re.compile(r"\bopen\b")


def label(name: str) -> str:
    """What a figure is called: "Fig. 3" for one of the paper's, else by its name."""
    return f"Fig. {int(name[3:])}" if PAPER.fullmatch(name) else f"Figure `{name}`"


def cell(text: str) -> str:
    """A text in a cell of a table."""
    return " ".join(str(text).split()).replace("|", "\\|")


def in_markdown(caption: str, medium: str) -> str:
    """A caption on one line of Markdown."""
    # "m\\ :sub:`p`": the space that is none ends the word before.
    return re.sub(r"(?:\\ )?:sub:`([^`]*)`(?:\\ )?", SUBSCRIPTS[medium], " ".join(caption.split()))


def printed(figure: dict, folder: str) -> str:
    """A figure for pandoc."""
    caption = re.sub(r"([\[\]])", r"\\\1", figure["caption"])
    return f"![**{figure['label']}.** {caption}](/{folder}{figure['name']}.pdf)"


def shown(figure: dict, folder: str) -> str:
    """A figure for Sphinx."""
    name = figure["name"]
    return (
        f":::{{figure}} {folder}{name}.png\n:alt: {figure['title']}\n:scale: 50\n\n"
        f'**{figure["label"]}.** {figure["caption"]} (<a href="{folder}{name}.pdf">PDF</a>)\n:::'
    )


FIGURE: dict[str, Callable[[dict, str], str]] = {"print": printed, "site": shown}


def of_figures(figures: dict[str, dict], captions: list[str], medium: str) -> dict[str, dict]:
    """Figures with their names, labels and captions, which the README does without."""
    captions = captions or [""] * len(figures)
    return {
        name: {**entry, "name": name, "label": label(name), "caption": in_markdown(caption, medium)}
        for (name, entry), caption in zip(figures.items(), captions, strict=True)
    }


def readable(path: tuple[str, ...]) -> str:
    """ "orbits.seeds[].z0" of the path of a key."""
    return ".".join(path).replace(".[]", "[]")


def of_gaps(defaults: list[Written]) -> list[dict]:
    """What the paper leaves open: keys, their values, and the comments that say so, each once."""
    return [
        {"key": readable(key.path), "value": key.value, "comment": comment}
        for key in defaults
        for comment in (key.beside, key.above)
        if OPEN.search(comment) and key.path[0] not in NOT_OF_THE_PAPER
    ]


# Sections of the config with things of this project's own, where nothing of the paper can be open.
NOT_OF_THE_PAPER = ("companion", "figures", "claims", "benchmark", "stability", "precision")


def of_keys(known: list[Key], defaults: list[Written]) -> dict[str, list[dict]]:
    """All keys by their sections, with the value of the default config where a key has one name only."""
    values = {key.path: key.value for key in defaults}
    found = {}
    for key in known:
        value = values.get(key.path, "")
        found.setdefault(key.path[0], []).append({**key._asdict(), "key": readable(key.path), "value": value})
    return found


def of_entries(known: list[Key], defaults: list[Written]) -> dict[str, list[dict]]:
    """Entries of the sections whose entries have names of one's own choice, with the comments above them."""
    named = {key.path[0] for key in known if len(key.path) > 1 and key.path[1] == "NAME"}
    found = {section: [] for section in named}
    for key in defaults:
        section, *rest = key.path
        if section in named and len(rest) == 1:
            found[section].append({"name": rest[0], "comment": key.above or key.beside})
    return found


def of_modules(library: list[str]) -> dict[str, list[str]]:
    """Modules of the library by their rooms; those in none by "conveyor"."""
    found = {}
    for path in library:
        _, *room, _ = path.split("/")
        found.setdefault(room[0] if room else "conveyor", []).append(path.replace("/", "."))
    return found


def with_uncertainty(claims: dict[str, dict], sure: dict[str, dict]) -> dict[str, dict]:
    """Claims with what tighter tolerances change in each of their quantities; a dash where nobody looked."""

    def changes(name: str) -> list[str]:
        found = sure.get(name, {}).get("changes", [])
        return [f"{value:.1g}" if value is not None else "–" for value in found] or ["–"] * len(
            claims[name]["quantities"]
        )

    return {name: claim | {"uncertainty": changes(name)} for name, claim in claims.items()}


def context(
    tables: dict[str, pd.DataFrame],
    figures: dict[str, dict],
    values: dict[str, float | str],
    captions: list[str],
    costs: str,
    uncertainty: str,
    proved: str,
    findings: str,
    columns: str,
    medium: str,
    folder: str,
    defaults: list[Written],
    known: list[Key],
    library: list[str],
) -> dict:
    """All that a template may ask for."""
    told = of_figures(figures, captions, medium)
    sure = json.loads(uncertainty) if uncertainty else {}
    claims = with_uncertainty(of_claims(tables["claims"]), sure)
    return {
        **facts(tables),
        **{name: value if isinstance(value, str) else plain(value) for name, value in values.items()},
        "figures": told,
        "of_the_paper": [name for name in told if PAPER.fullmatch(name)],
        "statements": claims,
        "tightened": str(len(sure)),
        "same_verdicts": str(sum(one["same_verdict"] for one in sure.values())),
        "verdicts": Counter(claim["verdict"] for claim in claims.values()),
        "costs": json.loads(costs) if costs else {},
        "proved": proved,
        "findings": findings,
        "columns": columns,
        "gaps": of_gaps(defaults),
        "keys": of_keys(known, defaults),
        "entries": of_entries(known, defaults),
        "modules": of_modules(library),
        "figure": lambda name: FIGURE[medium](told[name], folder),
        "cell": cell,
        "medium": medium,
    }


def make(
    templates: list[str],
    figures: dict[str, dict],
    values: dict[str, float | str],
    captions: list[str] = (),
    costs: str = "",
    uncertainty: str = "",
    proved: str = "",
    findings: str = "",
    columns: str = "",
    medium: str = "site",
    folder: str = "",
    config: list[str] = (),
    schema: str = "",
    library: list[str] = (),
    **tables: pd.DataFrame,
) -> list[str] | str:
    """The pages of some templates, in their order, or the one page of one.

    Parameters
    ----------
    figures : entries of the config, with title and section
    values : of the config, by the names under which templates ask for them
    captions : of all figures, in their order
    costs : of figures and claims, as JSON
    uncertainty : by how much tighter tolerances change the claims, as JSON
    proved : the page of what is proved
    findings : the list of findings beyond the paper
    columns : the page of all tables and their columns
    medium : print or site
    folder : where the figures are, as the page says it
    config : texts of the default config files
    schema : JSON Schema of the config
    library : files of the library's modules, without their endings
    tables : those that docs.facts asks for
    """
    defaults = [key for text in config for key in written(text)]
    known = list(keys(json.loads(schema))) if schema else []
    fields = context(
        tables,
        figures,
        values,
        captions,
        costs,
        uncertainty,
        proved,
        findings,
        columns,
        medium,
        folder,
        defaults,
        known,
        library,
    )
    pages = [render(template, fields) for template in templates]
    return pages if len(pages) > 1 else pages[0]
