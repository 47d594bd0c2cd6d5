"""Settings of the stage docs: pages, with units and ranges."""

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import Model, Name, described, entries, list_of


class Companion(TypedDict):
    maps: list_of(Name, "sweeps over two parameters")
    presets: entries(Model, "conveyors of the page", min_length=1)


SECTIONS = {"companion": described(Companion, "the interactive page")}
