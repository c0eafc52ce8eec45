"""What the tests share: small scenes that render in a fraction of a second."""

import os

import pytest

import kaustik


def square_under_sky(**more):
    """A square that reflects half of the sky's radiance 1 and fills the picture."""
    scene = {
        "type": "scene",
        "camera": {
            "type": "perspective", "fov": 60,
            "to_world": kaustik.Transform().look_at(origin=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0)),
            "film": {"type": "hdrfilm", "width": 16, "height": 12},
        },
        "sky": {"type": "constant", "radiance": 1.0},
        "grey": {"type": "diffuse", "reflectance": 0.5},
        "floor": {"type": "rectangle", "bsdf": {"type": "ref", "id": "grey"}},
    }
    scene.update(more)
    return scene


XML = """<scene version="3.0.0">
  <default name="light" value="1"/>
  <sensor type="perspective" id="camera">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0, 0, 1" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film>
  </sensor>
  <emitter type="constant" id="sky"><rgb name="radiance" value="$light"/></emitter>
  <bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf>
  <shape type="sphere" id="ball"><float name="radius" value="0.3"/><ref id="grey"/></shape>
  <shape type="rectangle" id="floor"><ref id="grey"/></shape>
</scene>
"""


@pytest.fixture
def scene():
    return kaustik.load_dict(square_under_sky())


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "scene.xml"
    path.write_text(XML)
    return path


@pytest.fixture
def program():
    """The command line program of the same build."""
    path = os.environ.get("KAUSTIK_PROGRAM")
    if not path or not os.path.exists(path):
        pytest.skip("no program: set KAUSTIK_PROGRAM")
    return path


@pytest.fixture
def numpy():
    return pytest.importorskip("numpy")
