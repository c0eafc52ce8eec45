"""Irradiance at points and radiance along rays: closed forms within their own intervals."""

import math
import pickle

import pytest

import kaustik
from conftest import square_under_sky


def lit_floor(**more):
    """A matt floor, z = 0, and a point lamp of 3 W/sr, 1 m above the origin."""
    return kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective"},
        "lamp": {"type": "point", "position": (0, 0, 1), "intensity": 3.0},
        "floor": {"type": "rectangle", "to_world": kaustik.Transform().scale(4),
                  "bsdf": {"type": "diffuse", "reflectance": 0.4}},
        **more,
    })


def from_lamp(x, y, z):
    return 3 * (1 - z) / (x * x + y * y + (1 - z) ** 2) ** 1.5


@pytest.mark.parametrize("integrator", ["auto", "path", "photonmap"])
def test_irradiance(integrator):
    measured = kaustik.irradiance(lit_floor(), [[0.5, 0.2, 0], [0.5, 0.2, 0.6], [0, 0, 1.5]], [0, 0, 1],
                                  integrator=integrator, passes=8)
    assert len(measured) == 3 and measured.unit == "W/m²"
    assert measured[0].value == pytest.approx(from_lamp(0.5, 0.2, 0), rel=1e-4)
    assert measured[1].value == pytest.approx(from_lamp(0.5, 0.2, 0.6), rel=1e-4)
    assert measured[2].value == 0
    # Its own normal for each; from below comes what the floor sends back: less than it gets.
    up, down = kaustik.irradiance(lit_floor(), [(0.5, 0.2, 0.6)] * 2, [(0, 0, 1), (0, 0, -2)], integrator=integrator,
                                  passes=8)
    assert up.value == pytest.approx(measured[1].value, rel=1e-6)
    assert 0 < down.standard_error < 0.05 * down.value < 0.4 * 3


def test_irradiance_of_a_sky():
    """π L on the front; the estimate knows how good it is, and can be wrong."""
    scene = kaustik.load_dict(square_under_sky())
    above, low = kaustik.irradiance(scene, [(0, 0, 0.5), (0, 0, -0.5)], (0, 0, 1))
    # The square is black for none, but from above nothing of it is seen.
    assert above.interval(0.9999).low - 1e-5 <= math.pi <= above.interval(0.9999).high + 1e-5
    assert low.value < 2.6 and not low.interval(0.9999).high > math.pi


def test_radiance():
    scene = lit_floor()
    measured = kaustik.radiance(scene, (0.3, -0.2, 2), [(0, 0, -1), (0, 0, 1)], passes=4)
    assert measured.unit == "W/(sr·m²)"
    assert measured[0].value == pytest.approx(0.4 / math.pi * from_lamp(0.3, -0.2, 0), rel=1e-4)
    assert measured[1].value == 0
    # A pixel of a camera that looks the same way sees the same.
    camera = {"type": "perspective", "fov": 0.01, "film": {"type": "hdrfilm", "width": 1, "height": 1},
              "to_world": kaustik.Transform().look_at(origin=(0.3, -0.2, 2), target=(0.3, -0.2, 0), up=(0, 1, 0))}
    pixel = kaustik.render(lit_floor(camera=camera), integrator="path", passes=4, samples_per_pass=4).pixel(0, 0)
    assert measured[0].value == pytest.approx(pixel.value, rel=1e-3)


def test_caustics():
    """A lamp that nothing but light paths finds, behind a pane of glass."""
    pane = {"type": "cube", "to_world": kaustik.Transform().translate((0, 0, 0.7)).scale((20, 20, 0.1)),
            "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}}
    estimate, = kaustik.irradiance(lit_floor(pane=pane), [(0, 0, 0.3)], [(0, 0, 1)])
    expected = sum(3 * 0.96 ** 2 * 0.04 ** (2 * k) / (0.7 - 0.2 + (1 + 2 * k) * 0.2 / 1.5) ** 2 for k in range(5))
    low, high = estimate.interval(0.9999)
    # What the floor sends up comes back from the pane, a little.
    assert low <= 1.05 * expected and expected <= high * 1.02
    assert estimate.standard_error < 0.05 * expected


def test_what_they_are():
    measured = kaustik.irradiance(lit_floor(), [(0, 0, 0.1 * i) for i in range(5)], [(0, 0, 1)] * 5, passes=2,
                                  integrator="path")
    assert list(measured.values) == [one.value for one in measured]
    assert list(measured.standard_errors) == [one.standard_error for one in measured]
    assert list(measured.interval(0.9).low) == [one.interval(0.9).low for one in measured]
    assert measured.rgb[1] == pytest.approx((measured[1].value,) * 3, rel=1e-5)
    assert measured[1:3] == (measured[1], measured[2])
    assert list(pickle.loads(pickle.dumps(measured))) == list(measured)
    assert repr(measured).count("\n") == 5
    with pytest.raises(TypeError):
        kaustik.Estimates()


def test_same_bits_for_any_number_of_threads():
    points, normals = [(0.1 * i, 0, 0.2) for i in range(7)], (0, 0.1, 1)
    one, three = (kaustik.irradiance(lit_floor(), points, normals, passes=2, threads=threads) for threads in (1, 3))
    assert one.picture.film == three.picture.film
    assert one.picture.film != kaustik.irradiance(lit_floor(), points, normals, passes=2, seed=1).picture.film


def test_cameras_of_the_scene_do_not_count():
    meter = {"type": "irradiancemeter"}
    scene = lit_floor(disk={"type": "disk", "bsdf": {"type": "null"}, "meter": meter})
    plain, other = (kaustik.irradiance(one, [(0.5, 0.2, 0.6)], [(0, 0, 1)], integrator="path", passes=2)
                    for one in (lit_floor(), scene))
    assert other[0].value == pytest.approx(plain[0].value, rel=1e-5)


def test_scenes_without_a_camera():
    scene = lit_floor().to_dict()
    del scene["camera"]
    plain = kaustik.load_dict(scene)
    assert not plain.warnings
    measured = kaustik.irradiance(plain, [(0.5, 0.2, 0.6)], (0, 0, 1), integrator="path", passes=2)
    assert measured[0].value == pytest.approx(from_lamp(0.5, 0.2, 0.6), rel=1e-4)
    brighter = plain.edit({"lamp.intensity": 6.0})
    assert kaustik.radiance(brighter, (0.3, -0.2, 2), [(0, 0, -1)], passes=2)[0].value == pytest.approx(
        2 * 0.4 / math.pi * from_lamp(0.3, -0.2, 0), rel=1e-3)
    assert kaustik.trace_photons(plain, integrator={"type": "photonmap", "global_photons": 1000})["global"] is not None
    for picture in (lambda: kaustik.render(plain), lambda: kaustik.Session(plain), lambda: kaustik.view(plain)):
        with pytest.raises(kaustik.Error, match="the scene has no camera") as caught:
            picture()
        assert "irradiance" in caught.value.remedy and caught.value.file == "scene"
    # What else is wrong with it is told as ever.
    with pytest.raises(kaustik.Error, match="floor.bsdf.reflectance"):
        kaustik.load_dict({**scene, "floor": {"type": "rectangle", "bsdf": {"type": "diffuse", "reflectance": 2}}})
    # Not read strictly a camera stands for it, which is told.
    assert any("no camera" in warning for warning in kaustik.load_dict(scene, strict=False).warnings)


def test_wrong_arguments():
    scene, nan = lit_floor(), math.nan
    for points, normals, message in (
            ([], [], "points"), ([(0, 0)], [(0, 0, 1)], "points"), ([(0, 0, nan)], [(0, 0, 1)], "points"),
            ([(0, 0, 0)], [(0, 0, 0)], "normals"), ([(0, 0, 0)], [(0, 0, 1)] * 2, "normals"), ([(0, 0, 0)], "up", "normals"),
            ([(0, 0, 0)], [(0, 0, math.inf)], "normals"), (3, [(0, 0, 1)], "points"),
            ([(0, 0, 0)], [], "normals")):
        with pytest.raises(kaustik.Error, match=message):
            kaustik.irradiance(scene, points, normals)
    for origins, directions, message in (((0, 0, 0), [], "directions"), ((0, nan, 0), [(0, 0, 1)], "origins"),
                                         ([(0, 0, 0)] * 3, [(0, 0, 1)] * 2, "directions")):
        with pytest.raises(kaustik.Error, match=message):
            kaustik.radiance(scene, origins, directions)
    # The argument is the place, and nothing that nobody has written.
    for call, argument in ((lambda: kaustik.irradiance(scene, [(0, 0, 0)], [(0, 0, 0)]), "normals"),
                           (lambda: kaustik.irradiance(scene, [(0, 0, 1e300)], [(0, 0, 1)]), "points"),
                           (lambda: kaustik.radiance(scene, (0, 0, 0), [(0, 0, 0)]), "directions")):
        with pytest.raises(kaustik.Error, match=f"^{argument}: ") as caught:
            call()
        assert caught.value.file == argument and "irradiancepoints" not in str(caught.value)
        assert "radiancerays" not in str(caught.value) and ":0" not in str(caught.value)
    with pytest.raises(kaustik.Error, match="scene"):
        kaustik.irradiance("scene.xml", [(0, 0, 0)], [(0, 0, 1)])
    with pytest.raises(kaustik.Error, match="^integrator: .*lighttracer.*knows nothing"):
        kaustik.irradiance(scene, [(0, 0, 0)], [(0, 0, 1)], integrator="lighttracer")
    with pytest.raises(kaustik.Error, match="passes"):
        kaustik.radiance(scene, [(0, 0, 0)], [(0, 0, 1)], passes=0)
