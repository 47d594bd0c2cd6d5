"""Saving of figures."""

from figures import style


def test_files_of_a_figure_have_one_layout(tmp_path):
    """The layout of the first file, because the layout depends slightly on the file format."""

    def position(*names):
        with style.applied():
            figure = style.figure(50.0, 40.0)
            axes = figure.subplots()
            axes.set(xlabel="time in s", ylabel="height in mm")
            style.save(figure, [str(tmp_path / name) for name in names])
        return axes.get_position().bounds

    page, picture = position("a.pdf"), position("a.png")
    assert page != picture
    assert position("b.pdf", "b.png") == page
    assert position("c.png", "c.pdf") == picture
