"""The page on the open benchmark: a row for each scene, and the example from the repository."""

from project import ROOT

from accuracy.published_scene import make as published
from docs import add_your_solver_page


def test_the_page_lists_scenes_and_shows_the_example():
    model = {"acceleration": 40.0, "z0": 3e-4}
    scene = {"scene": "short", "model": model, "duration": 0.06}
    template = (ROOT / "workflow/templates/add_your_solver.md").read_text(encoding="utf-8")
    example = (ROOT / "scripts/accuracy/example_solver.py").read_text(encoding="utf-8")
    text = add_your_solver_page.make(template, [published(scene)], example)
    assert '| <a href="benchmark/short.json">short</a> | 40 | 0.3 | 0.06 | 3 | ' in text
    assert f"```python\n{example}```\n" in text
