"""Settings of the stage docs: pages, with units and ranges."""

from typing_extensions import TypedDict

from ..pipeline.settings import Model, Name, described, entries, many, mapping, number


class Companion(TypedDict):
    maps: many(Name, "sweeps over two parameters")
    presets: entries(Model, "conveyors of the page", min_length=1)


SECTIONS = {
    "companion": described(Companion, "the interactive page"),
    "archive": mapping(
        "the archive of figures, tables and sources",
        {"megabytes": number("largest size of the archive", "MB", gt=0, le=1e6)},
    ),
}
