# What `snakemake --report` shows: a start page, the figures of each section beside their captions, the claims, the provenance.


# Figures on a page beyond the paper: a browser shows no page of the report above two megabytes (see report.figure_pages).
AT_ONCE = 5


def section_pages():
    """The figures by the sections of the paper, in its order, and on the last pages those that the paper does not have."""
    sections = {}
    for figure, entry in sorted(config["figures"].items(), key=lambda item: item[1]["section"]):
        number = re.fullmatch(r"fig(\d+)", figure)
        sections.setdefault(entry["section"] if number else BEYOND, []).append(
            {
                "name": figure,
                "number": f"Fig. {int(number[1])}" if number else figure,
                "title": entry["title"],
                "section": entry["section"],
                "file": figure_file(figure),
                "png": figure_file(figure, "png"),
                "rst": result(f"captions/{figure}.rst"),
            }
        )
    beyond = sections.pop(BEYOND, [])
    parts = [beyond[first : first + AT_ONCE] for first in range(0, len(beyond), AT_ONCE)]
    return sections | {f"{BEYOND}, {place} of {len(parts)}": part for place, part in enumerate(parts, start=1)}


def in_label(text):
    """A text for a label of the report, where {name} is a wildcard that nothing escapes: an invisible character does."""
    return text.replace("{", "{\u2060")


def report_file(name):
    return result(f"report/{name}.html")


def shown_page(name, category, labels):
    """A page as an output, with its place in the report."""
    told = {key: in_label(value) for key, value in labels.items()}
    return report(report_file(name), category=category, labels=told)


def numbers_of(page):
    """Which figures are on a page, in few words."""
    first, *_, last = [figure["number"] for figure in page["figures"]] * 2
    if page["section"].startswith(BEYOND):
        return f"{len(page['figures'])} figures"
    return first if first == last else f"{first} to {last.removeprefix('Fig. ')}"


def points(sweeps):
    """Number of points of all sweeps."""
    return sum(count_points(entry["axes"]) * len(entry.get("methods", [None])) for entry in sweeps.values())


def told_of_the_config():
    """What stands on top of every page, heading and text, where overlays change the paper's config; else nothing."""
    if not workflow.overwrite_configfiles:
        return {}
    own, paper = points(config["sweeps"]), points(PAPER["sweeps"])
    kind = f"coarse axes, {own:,} points of sweeps in place of {paper:,}" if own < paper else "a config of its own"
    files = ", ".join(os.path.relpath(file) for file in workflow.overwrite_configfiles)
    return {
        "heading": f"Made with {files}, on {kind}.",
        "text": "Verdicts, captions and numbers are those of this config, not those of the paper's.",
    }


def findings():
    """The page of what was found beyond the paper, where all the paper's statements are checked."""
    checked = config["claims"].keys()
    return {"findings": result("findings.md")} if checked and checked >= PAPER["claims"].keys() else {}


BEYOND = "beyond the paper"
PAGES = {
    f"figures_{place}": {
        "heading": section.capitalize() if section.startswith(BEYOND) else f"Section {section}",
        "section": section,
        "figures": figures,
    }
    for place, (section, figures) in enumerate(section_pages().items(), start=1)
}
TOLD = told_of_the_config()

RULES["report_figures"] = {
    "stage": "report.figure_pages",
    "message": "The figures with their captions for the report",
    "depends": [
        *(figure[kind] for page in PAGES.values() for figure in page["figures"] for kind in ("png", "rst")),
        *(f"scripts/report/{name}" for name in ("page.html", "page.css", "told.html", "figures.html")),
    ],
    "output": {
        name: shown_page(
            name,
            "Figures",
            {
                "section": page["section"],
                "figures": numbers_of(page),
            },
        )
        for name, page in PAGES.items()
    },
    "place": "report/figures",
    "runtime": 10,
    "params": {"pages": PAGES, "told": TOLD},
}

RULES["report_summary"] = {
    "stage": "report.summary",
    "message": "The start page of the report",
    "depends": sorted(glob.glob("scripts/report/*.html")) + ["scripts/report/page.css"],
    "input": {
        "claims": result("claims.parquet"),
        "provenance": result("provenance.json"),
        **findings(),
    },
    "output": {
        "summary": report_file("summary"),
        "claims": shown_page("claims", "Claims", {"page": "The paper's statements"}),
        "provenance": shown_page("provenance", "Provenance", {"page": "Where these results come from"}),
    },
    "place": "report/summary",
    "runtime": 10,
    "params": {
        "step": config["solver"]["step"],
        "pages": [
            {
                "heading": page["heading"],
                "file": report_file(name),
                "figures": [{key: figure[key] for key in ("name", "number", "title")} for figure in page["figures"]],
            }
            for name, page in PAGES.items()
        ],
        "files": {name: report_file(name) for name in ("claims", "provenance")},
        "told": TOLD,
    },
}


def report_files():
    """All pages of the report."""
    return [file for name in ("report_figures", "report_summary") for file in RULES[name]["output"].values()]
