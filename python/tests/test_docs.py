"""The code of docs/guides/python*.md runs as it stands, on small pictures; numbers are not compared."""

import json
import pathlib
import re

import pytest

import kaustik
from kaustik import _session

docs = pathlib.Path(__file__).parent.parent.parent / "docs"
pages = sorted((docs / "guides").glob("python*.md"))


def shortened(monkeypatch):
    """Pictures of 24 pixels' width, two passes of one sample."""
    load = kaustik.load_dict
    goals = _session._Goals

    def small(scene, **more):
        made = load(scene, **more)
        sizes = {key: 24 for key in made.parameters if key.endswith((".film.width", ".film.height"))}
        return made.edit(sizes) if sizes else made

    class Few(goals):
        def __init__(self, **given):
            super().__init__(**given)
            self.wishes.update(time=None, error=None, spp=None, samples_per_pass=1)
            if not given.get("passes"):
                self.wishes["passes"] = 2

    monkeypatch.setattr(kaustik, "load_dict", small)
    monkeypatch.setattr(_session, "_Goals", Few)


def test_docs(monkeypatch, tmp_path, capsys):
    blocks = [(page, block) for page in pages
              for block in re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)]
    assert len(blocks) >= 6
    shortened(monkeypatch)
    monkeypatch.chdir(tmp_path)
    names = {}
    for page, block in blocks:
        # Pixels that are there in small pictures, too.
        block = block.replace("(312, 90, 20, 14)", "(12, 9, 2, 4)").replace("pixel(320, 97)", "pixel(12, 9)")
        exec(compile(block, str(page), "exec"), names)
    assert (tmp_path / "ring.png").exists() and (tmp_path / "ring.kpt").exists()
    assert "did you mean" in capsys.readouterr().out
    assert kaustik.render(names["with_lens"]).mean().value > 0
    assert not any("closed" in warning for warning in names["with_lens"].warnings)


@pytest.mark.parametrize("page", pages, ids=lambda page: page.stem)
def test_links(page):
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        assert (page.parent / target).exists(), target


notebooks = sorted((docs / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", notebooks, ids=lambda path: path.stem)
def test_notebooks_were_run(path):
    """`make notebooks` runs them; here it is checked that somebody did, and that nothing failed."""
    cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    for cell in cells:
        compile("".join(cell["source"]), path.name, "exec")
        assert not any(output["output_type"] == "error" for output in cell["outputs"])
    assert sum("cover" in cell["metadata"].get("tags", []) for cell in cells) == 1
    assert path.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert any(f"notebooks/{path.name}" in page.read_text(encoding="utf-8") for page in pages)


def test_there_are_notebooks():
    assert len(notebooks) >= 4
