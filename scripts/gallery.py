"""Rule gallery: pictures of the figures side by side, for the README."""

import matplotlib.image as mpimg
from matplotlib.figure import Figure

from plots import style
from rule_log import logged

COLUMNS = 4
RESOLUTION = 100  # dpi


def gallery(pictures: dict[str, str]) -> Figure:
    """The PNG files of figures by their names, each with its name above it."""
    rows = -(-len(pictures) // COLUMNS)
    figure = style.figure(2.0 * style.PAGE, 58.0 * rows)
    for axes, (name, path) in zip(figure.subplots(rows, COLUMNS).flat, pictures.items(), strict=False):
        axes.imshow(mpimg.imread(path)[::2, ::2], interpolation="antialiased")
        axes.set_title(name)
    for axes in figure.axes:
        axes.axis("off")
    return figure


if __name__ == "__main__":
    with logged(snakemake.log[0]), style.applied():
        pictures = dict(zip(snakemake.params.names, snakemake.input, strict=True))
        gallery(pictures).savefig(snakemake.output[0], format="png", dpi=RESOLUTION)
