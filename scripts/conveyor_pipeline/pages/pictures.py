"""Pictures of figures for screens: scaled down and with a palette, so that they take fewer bytes."""

from typing import BinaryIO

from PIL import Image

from conveyor_pipeline.figures.style import RESOLUTION

SCREEN = 220  # dpi
COLOURS = 256


def make(png: str | BinaryIO) -> Image.Image:
    """The picture of a figure from its PNG file."""
    with Image.open(png) as image:
        size = [max(1, round(extent * SCREEN / RESOLUTION)) for extent in image.size]
        small = image.convert("RGB").resize(size, Image.Resampling.BICUBIC, reducing_gap=2.0)
    return small.quantize(COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
