"""Score solvers on the open benchmark in docs/benchmark, and compare them with this solver and the paper's method.

    python scripts/score.py my_solver.py              a file with the function solve(scene, tolerance)
    python scripts/score.py my_numbers.csv            results of a program in any language
    python scripts/score.py my_solver.py --chart mine.png --scenes docs/benchmark

docs/add_your_solver.md describes the scenes, both kinds of files, and the errors.
"""

import argparse
import sys
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from accuracy import scores
from figures import style

ROOT = Path(__file__).resolve().parents[1]
COLOURS = {"this solver": style.CONVERGED, "explicit Euler": style.EULER}
OTHERS = ("black", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")  # colours of the scored files
MARKERS = "os^Dv"
LOWEST = 1e-13  # smallest error of the chart


def draw(table: pd.DataFrame, scenes: dict[str, dict]) -> Figure:
    """Draw the error of the trajectory over processor time, a panel for each scene; grey: error of the reference."""
    with style.applied():
        figure = style.figure(style.PAGE, 110.0)
        panels = figure.subplots(-(-len(scenes) // 2), 2, squeeze=False, sharey=True).ravel()
        for axes, (name, scene) in zip(panels, scenes.items(), strict=False):
            axes.set_title(f"{name}, {scene['duration']:g} s")
            for place, (solver, rows) in enumerate(table[table.scene == name].groupby("solver", sort=False)):
                axes.loglog(
                    rows.seconds,
                    rows.error.clip(lower=LOWEST),
                    marker=MARKERS[place % len(MARKERS)],
                    color=COLOURS.get(solver, OTHERS[place % len(OTHERS)]),
                    label=solver,
                )
            axes.axhspan(0.1 * LOWEST, scores.error_bar(scene), color="0.85", linewidth=0.0)
            style.note(axes, "error of the reference solution", (0.99, 0.02), xycoords="axes fraction", ha="right")
            axes.set_ylim(bottom=0.1 * LOWEST)
            axes.set_xlabel("processor time in s")
        for axes in panels[::2]:
            axes.set_ylabel("error of $x$ and $z$ in\namplitudes of the plate")
        for axes in panels[len(scenes) :]:
            axes.set_visible(False)
        style.legend_above(figure, panels[0], ncols=4)
    return figure


def main(arguments: list[str]) -> pd.DataFrame:
    """Score the files of the command line; print the table and draw the chart."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, help=".py with solve(scene, tolerance), or .csv of numbers")
    parser.add_argument("--scenes", type=Path, default=ROOT / "docs/benchmark", help="folder of the scenes")
    parser.add_argument("--chart", type=Path, default=Path("score.png"), help="chart, .png or .pdf")
    options = parser.parse_args(arguments)
    scenes = scores.read_scenes(options.scenes)
    rows = [
        *(row for file in options.files for row in scores.score_file(scenes, file)),
        *scores.compared_scores(scenes),
    ]
    table = pd.DataFrame(rows)
    print(table.to_string(index=False, float_format="{:.2e}".format, na_rep="–"))
    style.save(draw(table, scenes), [str(options.chart)])
    print(f"chart: {options.chart}")
    return table


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.exit(f"score: {error}")
