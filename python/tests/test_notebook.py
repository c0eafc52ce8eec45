"""Progress in notebooks: a picture that is replaced, made by the thread that waits. IPython is a stand-in here;
`make notebooks` runs real ones."""

import base64
import sys
import threading
import types

import pytest

import kaustik
from kaustik import _progress


class Handle:
    def __init__(self, shown):
        self.shown = shown

    def update(self, shown):
        assert threading.current_thread() is threading.main_thread()
        self.shown.append(shown)


@pytest.fixture
def notebook(monkeypatch):
    """What is shown in it."""
    shown = []
    ipython, display = types.ModuleType("IPython"), types.ModuleType("IPython.display")
    ipython.get_ipython = lambda: types.SimpleNamespace(kernel=object())

    def show(thing, display_id):
        assert display_id
        shown.append(thing)
        return Handle(shown)

    display.display = show
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setattr(_progress._Notebook, "_least", 0.05)
    return shown


def test_shows_the_picture_so_far(notebook, scene, capsys):
    kaustik.render(scene, integrator="path", time=1.5)
    assert len(notebook) >= 3
    html = [one._repr_html_() for one in notebook if "img" in one._repr_html_()][-1]
    picture = base64.b64decode(html.split("base64,")[1].split('"')[0])
    assert picture.startswith(b"\x89PNG") and "<progress" in html and "passes" in html
    assert notebook[-1]._repr_html_() == "" and repr(notebook[-1]) == ""
    assert capsys.readouterr() == ("", "")


def test_is_quiet(notebook, scene):
    kaustik.render(scene, integrator="path", time=0.5, progress=False)
    assert notebook == []
    kaustik.render(scene, integrator="path", passes=1, samples_per_pass=1)  # done before anybody waits
    assert notebook == []


def test_ipython_in_a_terminal_is_no_notebook(notebook, scene, monkeypatch):
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: types.SimpleNamespace())
    kaustik.render(scene, integrator="path", time=0.5)
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: None)
    kaustik.render(scene, integrator="path", time=0.5)
    assert notebook == []
