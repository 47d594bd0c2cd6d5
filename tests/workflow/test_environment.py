"""The environment of jobs."""

import pytest
from project import Project

pytestmark = pytest.mark.long

MATPLOTLIBRC = """
text.usetex: True
font.size: 20
axes.grid: True
lines.linewidth: 5
savefig.bbox: tight
savefig.transparent: True
path.simplify: False
"""


def test_figures_do_not_depend_on_the_users_matplotlib_settings(built, copied, tmp_path):
    (tmp_path / "matplotlibrc").write_text(MATPLOTLIBRC)
    project = Project(copied.folder, environment={"MPLCONFIGDIR": str(tmp_path)})
    project.make("figures/fig03.pdf", "--force")
    for name in ("figures/fig03.pdf", "figures/fig03.png"):
        assert (project.folder / name).read_bytes() == (built.folder / name).read_bytes()
