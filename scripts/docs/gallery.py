"""Pictures of the figures side by side, small enough to be kept beside the sources."""

import matplotlib.image as mpimg
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from figures import style

RESOLUTION = 100  # dpi
COLOURS = 256


def gallery(pictures: dict[str, str], columns: int) -> Figure:
    """The PNG files of figures by their names; if there are several, each has its name above it."""
    rows = -(-len(pictures) // columns)
    images = {name: mpimg.imread(path) for name, path in pictures.items()}
    tallest = max(image.shape[0] / image.shape[1] for image in images.values()) if rows == 1 else 2.0 / 3.0
    width = 2.0 * style.PAGE
    figure = style.figure(width, rows * (tallest * width / columns))
    for axes, (name, image) in zip(figure.subplots(rows, columns, squeeze=False).flat, images.items(), strict=False):
        axes.imshow(image, interpolation="antialiased")
        if len(images) > 1:
            axes.set_title(name)
    for axes in figure.axes:
        axes.axis("off")
    return figure


def few_colours(figure: Figure) -> Image.Image:
    """A picture of the figure with a palette: a fraction of the bytes of one without."""
    figure.set_dpi(RESOLUTION)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    return picture.quantize(COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)


def make(files: dict[str, str], columns: int) -> Image.Image:
    """The picture of the PNG files of figures, by their names."""
    with style.applied():
        return few_colours(gallery(files, columns))
