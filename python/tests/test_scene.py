"""Scenes: from files, text and dicts; their parameters, edits and errors."""

import pathlib
import pickle

import pytest

import kaustik
from conftest import XML, square_under_sky


def test_file_string_and_definitions(scene_file):
    scene = kaustik.load_file(scene_file, light=2)
    assert scene.parameters["sky.radiance"] == (2.0, 2.0, 2.0)
    assert scene.source == str(scene_file)
    text = kaustik.load_string(XML)
    assert text.parameters["sky.radiance"] == (1.0, 1.0, 1.0)
    assert text.parameters["grey.reflectance"] == (0.5, 0.25, 0.125)
    assert text.source == ""


def test_errors_have_places(tmp_path):
    path = tmp_path / "wrong.xml"
    path.write_text(XML.replace('name="radius"', 'name="radios"').replace('value="60"', 'value="sixty"'))
    with pytest.raises(kaustik.Error) as caught:
        kaustik.load_file(path)
    error = caught.value
    assert isinstance(error, ValueError)
    assert error.file == str(path) and error.line == 4 and error.column > 1 and "sixty" in error.message
    assert error.remedy and str(path) in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert again.problems == error.problems and str(again) == str(error)


def test_missing_file():
    with pytest.raises(kaustik.Error, match="nowhere.xml"):
        kaustik.load_file("nowhere.xml")


def test_dict_tells_all_problems_with_their_places():
    wrong = square_under_sky(
        ball={"type": "sphere", "radios": 1.0},
        glas={"type": "dielectrik"},
        lamp={"type": "point", "intensity": {"type": "rgb", "value": (1, 2)}},
        pane={"type": "rectangle", "bsdf": {"type": "ref", "id": "gray"}},
        number=3,
    )
    with pytest.raises(kaustik.Error) as caught:
        kaustik.load_dict(wrong)
    found = {problem.file: problem for problem in caught.value.problems}
    assert {"glas", "lamp.intensity", "pane.bsdf", "number"} <= set(found)
    assert "dielectric" in found["glas"].remedy and "grey" in found["pane.bsdf"].remedy
    with pytest.raises(kaustik.Error) as caught:
        kaustik.load_dict(square_under_sky(ball={"type": "sphere", "radios": 1.0}))
    assert caught.value.file.startswith("ball") and "radius" in caught.value.remedy


@pytest.mark.parametrize("wrong", [None, {}, {"type": "sphere"}, [1, 2], {"type": "scene", 3: {"type": "sphere"}}])
def test_what_is_no_scene(wrong):
    with pytest.raises(kaustik.Error):
        kaustik.load_dict(wrong)


def test_references_in_circles():
    with pytest.raises(kaustik.Error, match="holds itself"):
        kaustik.load_dict(square_under_sky(
            a={"type": "twosided", "bsdf": {"type": "ref", "id": "b"}},
            b={"type": "twosided", "bsdf": {"type": "ref", "id": "a"}}))


def test_references_are_shared(scene):
    objects = scene._native.objects
    assert sum(1 for family, name, *_ in objects if name == "diffuse") == 1


def test_values_of_all_kinds(numpy):
    scene = kaustik.load_dict(square_under_sky(
        ball={"type": "sphere", "center": (0, 0, 0.2), "radius": 1, "to_world": numpy.eye(4) * [2, 2, 2, 1],
              "bsdf": {"type": "roughconductor", "alpha": numpy.float32(0.25), "material": "Au"}},
        lamp={"type": "sphere", "radius": 0.1,
              "emitter": {"type": "area", "radiance": {"type": "spectrum", "value": [(400, 1), (700, 2)]}}},
        sheet={"type": "rectangle", "bsdf": {"type": "diffuse", "reflectance": {
            "type": "bitmap", "data": numpy.full((2, 2, 3), 0.25, "float32")}}},
        blue={"type": "diffuse", "reflectance": {"type": "rgb", "value": (0.1, 0.2, 0.3)}},
        pair={"type": "diffuse", "reflectance": {"type": "blackbody", "temperature": 5000, "scale": 1e-20}},
        lens={"type": "mesh", "mesh": kaustik.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
              "bsdf": {"type": "dielectric"}},
        alone=kaustik.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    ))
    parameters = scene.parameters
    assert parameters["ball.center"] == (0.0, 0.0, 0.2)
    assert parameters["ball.radius"] == 1.0 and isinstance(parameters["ball.radius"], float)
    assert parameters["ball.bsdf.alpha"] == 0.25
    assert parameters["lamp.emitter.radiance"] == ((400.0, 1.0), (700.0, 2.0))
    assert parameters["blue.reflectance"] == (0.1, 0.2, 0.3)
    assert parameters["sheet.bsdf.reflectance.data"].shape == (2, 2, 3)
    assert numpy.asarray(parameters["ball.to_world"]).tolist()[0][0] == 2


def test_dict_and_xml_have_the_same_bits():
    """A colour, a reference and a transform mean the same in both."""
    rgb = {"type": "rgb", "value": (0.5, 0.25, 0.125)}
    as_dict = kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective", "fov": 60,
                   "to_world": kaustik.Transform().look_at((0, 0, 1), (0, 0, 0), (0, 1, 0)),
                   "film": {"type": "hdrfilm", "width": 16, "height": 12}},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 1}},
        "grey": {"type": "diffuse", "reflectance": rgb},
        "ball": {"type": "sphere", "radius": 0.3, "bsdf": {"type": "ref", "id": "grey"}},
        "floor": {"type": "rectangle", "bsdf": {"type": "ref", "id": "grey"}},
    })
    pictures = [kaustik.render(scene, integrator="path", passes=2, samples_per_pass=2)
                for scene in (as_dict, kaustik.load_string(XML))]
    assert pictures[0].array.tobytes() == pictures[1].array.tobytes()


def test_parameters_are_a_table(scene):
    assert scene.parameters["grey.reflectance"] == 0.5
    assert "camera.fov" in scene.parameters._ipython_key_completions_()
    assert "camera.fov" in repr(scene.parameters)
    with pytest.raises(kaustik.Error, match="scenes do not change") as caught:
        scene.parameters["grey.reflectance"] = 0.7
    assert 'scene.edit({"grey.reflectance": 0.7})' in caught.value.remedy
    with pytest.raises(KeyError):
        scene.parameters["grey.nothing"]
    table = repr(scene)
    assert "floor" in table and "rectangle" in table and "shape" in table


def test_edits_make_another_scene(scene):
    brighter = scene.edit({"sky.radiance": 2, "grey.reflectance": (0.1, 0.2, 0.3)})
    assert scene.parameters["sky.radiance"] == 1.0 and brighter.parameters["sky.radiance"] == 2.0
    assert brighter.parameters["grey.reflectance"] == (0.1, 0.2, 0.3)
    assert kaustik.render(brighter, integrator="path", spp=4).mean().value > 0


def test_edits_share_what_is_the_same():
    mesh = kaustik.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    scene = kaustik.load_dict(square_under_sky(lens=mesh))
    assert scene._native.shapes_built > 0
    assert scene.edit({"sky.radiance": 2})._native.shapes_built == 0
    assert scene.edit({"lens.face_normals": True})._native.shapes_built > 0


def test_wrong_edits_tell_all_and_change_nothing(scene):
    with pytest.raises(kaustik.Error) as caught:
        scene.edit({"grey.reflectanze": 0.1, "sky.radiance": {"a": 1}})
    assert len(caught.value.problems) == 2 and "grey.reflectance" in caught.value.problems[0].remedy
    with pytest.raises(kaustik.Error, match="grey.reflectance"):
        scene.edit({"grey.reflectance": 1.5})
    assert scene.parameters["grey.reflectance"] == 0.5


def test_edits_of_mistyped_values(scene):
    for wrong in ({"camera.fov": "wide"}, {"camera.fov": float("nan")}, {"floor.to_world": [1, 2, 3]}):
        with pytest.raises(kaustik.Error) as caught:
            scene.edit(wrong)
        assert caught.value.file.startswith(list(wrong)[0])


def test_scenes_pickle_to_the_bit(scene_file):
    for scene in (kaustik.load_file(scene_file), kaustik.load_dict(square_under_sky(
            lens=kaustik.Mesh([[0, 0, .1], [1, 0, .1], [0, 1, .1]], [[0, 1, 2]])))):
        copy = pickle.loads(pickle.dumps(scene))
        assert repr(copy) == repr(scene)
        pictures = [kaustik.render(s, integrator="path", passes=1, samples_per_pass=2) for s in (scene, copy)]
        assert pictures[0].array.tobytes() == pictures[1].array.tobytes()
        assert pictures[0].film == pictures[1].film


def test_warnings():
    foreign = XML.replace("<float name=\"radius\"", '<float name="zzyzx" value="1"/><float name="radius"')
    scene = kaustik.load_string(foreign)
    assert any("zzyzx" in warning for warning in scene.warnings)
    with pytest.raises(kaustik.Error, match="zzyzx"):
        kaustik.load_string(foreign, strict=True)


def test_xml_and_back(scene, scene_file):
    again = kaustik.load_string(scene.to_xml())
    assert again.parameters["grey.reflectance"] == 0.5
    with pytest.raises(kaustik.Error, match="positions|array|buffer"):
        kaustik.load_dict(square_under_sky(
            lens=kaustik.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))).to_xml()


def test_scenes_are_not_made_by_hand():
    for kind in (kaustik.Scene, kaustik.Film, kaustik.Picture):
        with pytest.raises(TypeError):
            kind()


shipped = pathlib.Path(__file__).parent.parent.parent / "scenes"


@pytest.mark.parametrize("name", ["metal_ring", "cornell_spheres", "cornell_box"])
def test_to_dict_gives_the_same_scene(name):
    scene = kaustik.load_file(shipped / name / f"{name}.xml")
    small = {key: 16 for key in scene.parameters if key.endswith((".film.width", ".film.height", "film.width",
                                                                  "film.height"))}
    again = kaustik.load_dict(scene.to_dict(), strict=False).edit(small)
    scene = scene.edit(small)
    assert again.to_xml() == scene.to_xml() or len(again.parameters) == len(scene.parameters)
    pictures = [kaustik.render(one, integrator="path", passes=1, samples_per_pass=1) for one in (scene, again)]
    assert pictures[0].array.tobytes() == pictures[1].array.tobytes()


def test_to_dict():
    mesh = kaustik.Mesh([[0, 0, .1], [1, 0, .1], [0, 1, .1]], [[0, 1, 2]])
    given = square_under_sky(
        ball={"type": "sphere", "radius": 0.25, "bsdf": {"type": "ref", "id": "grey"}},
        lens={"type": "mesh", "mesh": mesh, "bsdf": {"type": "dielectric", "id": "glass", "int_ior": 1.5}},
        other={"type": "sphere", "bsdf": {"type": "ref", "id": "glass"}},
        lamp={"type": "point", "intensity": {"type": "spectrum", "value": [(400, 0.1), (700, 0.8)]}})
    made = kaustik.load_dict(given).to_dict()
    assert made["type"] == "scene" and list(made)[1:] == ["camera", "sky", "grey", "floor", "ball", "lens", "other", "lamp"]
    assert made["sky"] == {"type": "constant", "radiance": 1.0}
    assert made["ball"] == {"type": "sphere", "radius": 0.25, "bsdf": {"type": "ref", "id": "grey"}}
    assert made["lens"]["bsdf"] == {"type": "dielectric", "id": "glass", "int_ior": 1.5}
    assert made["other"]["bsdf"] == {"type": "ref", "id": "glass"}
    assert made["lamp"]["intensity"] == {"type": "spectrum", "value": [(400.0, 0.1), (700.0, 0.8)]}
    assert made["lens"]["positions"].tobytes() == mesh.vertices.tobytes()
    assert isinstance(made["camera"]["to_world"], kaustik.Transform)
    again = kaustik.load_dict(made)
    assert list(again.to_dict()) == list(made) and dict(again.parameters).keys() == dict(kaustik.load_dict(given).parameters).keys()
