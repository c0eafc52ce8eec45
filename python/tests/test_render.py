"""Renders: pictures, films, estimates; the same bits as the command line."""

import pickle
import subprocess

import pytest

import kaustik
from conftest import square_under_sky


def test_half_of_the_sky(scene, numpy):
    """The square reflects half of radiance 1: the closed form, within the picture's own interval."""
    picture = kaustik.render(scene, integrator="path", passes=16, samples_per_pass=4)
    assert picture.shape == (12, 16, 3) and numpy.asarray(picture).dtype == numpy.float32
    mean = picture.mean()
    low, high = mean.interval(0.9999)
    assert low - 1e-6 <= 0.5 <= high + 1e-6
    # It can fail: another reflectance is not within it.
    other = kaustik.render(scene.edit({"grey.reflectance": 0.52}), integrator="path", passes=16,
                           samples_per_pass=4).mean()
    assert not other.interval(0.9999).low - 1e-6 <= 0.5


def test_same_bits_as_the_command_line(scene_file, program, tmp_path):
    film, image = tmp_path / "film.kpt", tmp_path / "image.exr"
    subprocess.run([program, "render", scene_file, "--integrator", "vcm", "--passes", "4", "--spp", "8",
                    "--seed", "3", "--checkpoint", film, "-o", image, "--float", "-q"], check=True)
    scene = kaustik.load_file(scene_file)
    picture = kaustik.render(scene, integrator="vcm", passes=4, spp=8, seed=3)
    assert picture.film == kaustik.Film.load(film)
    shown = kaustik.read(image)
    assert set(shown.channels) == set(picture.channels)
    for channel in picture.channels:
        assert shown[channel].tobytes() == picture[channel].tobytes(), channel
    # It can fail: another seed has other bits.
    assert picture.film != kaustik.render(scene, integrator="vcm", passes=4, spp=8, seed=4).film


@pytest.mark.parametrize("integrator", ["path", "auto", "photonmap"])
def test_films_of_parts_add_up_to_the_whole(scene_file, integrator):
    scene = kaustik.load_file(scene_file)
    settings = {"integrator": integrator, "samples_per_pass": 2}
    whole = kaustik.render(scene, passes=8, **settings)
    first = kaustik.render(scene, passes=4, **settings).film
    last = kaustik.render(scene, passes=4, first_pass=4, **settings).film
    assert (last.passes, first.passes) == ((4, 5, 6, 7), (0, 1, 2, 3))
    for total in (first + last, last + first, sum([first, last]), pickle.loads(pickle.dumps(last)) + first):
        assert total.passes == tuple(range(8))
        assert total.picture().array.tobytes() == whole.array.tobytes()
        assert total.picture()["error"].tobytes() == whole["error"].tobytes()
        assert total == whole.film
    assert first != last


def test_films_that_do_not_belong_together(scene):
    film = kaustik.render(scene, integrator="path", passes=1, samples_per_pass=1).film
    for other, what in ((film, "given before"),
                        (kaustik.render(scene, integrator="path", passes=1, samples_per_pass=1, first_pass=1, seed=1)
                         .film, "seed"),
                        (kaustik.render(scene.edit({"sky.radiance": 2}), integrator="path", passes=1,
                                        samples_per_pass=1, first_pass=1).film, "another scene")):
        with pytest.raises(kaustik.Error, match=what):
            film + other
    with pytest.raises(TypeError):
        film + 1


def test_damaged_films(scene, tmp_path):
    film = kaustik.render(scene, integrator="path", passes=1, samples_per_pass=1).film
    path = tmp_path / "film.kpt"
    film.save(path)
    assert kaustik.Film.load(path) == film
    bytes_of_it = path.read_bytes()
    for damaged in (bytes_of_it[:-1], bytes_of_it[:100] + bytes([bytes_of_it[100] ^ 1]) + bytes_of_it[101:], b""):
        path.write_bytes(damaged)
        with pytest.raises(kaustik.Error):
            kaustik.Film.load(path)


def test_estimates(scene):
    picture = kaustik.render(scene, integrator="path", passes=16, samples_per_pass=1)
    pixel = picture.pixel(3, 4)
    assert pixel.unit == "W/(sr·m²)" and pixel.freedom > 0
    narrow, wide = pixel.interval(0.5), pixel.interval(0.99)
    assert wide.low <= narrow.low <= pixel.value <= narrow.high <= wide.high
    low, high = picture.interval(0.95)
    at = memoryview(low).tolist()[4][3], memoryview(high).tolist()[4][3]
    assert at == pytest.approx(pixel.interval(0.95), rel=1e-12)
    region = picture.mean((3, 4, 1, 1))
    assert region.value == pytest.approx(pixel.value, rel=1e-6)
    assert pickle.loads(pickle.dumps(pixel)) == pixel
    for wrong in ((-1, 0), (16, 0), (0, 12)):
        with pytest.raises(kaustik.Error):
            picture.pixel(*wrong)
    for wrong in ((0, 0, 17, 1), (0, 0, 0, 1), (15, 11, 2, 1)):
        with pytest.raises(kaustik.Error, match="region"):
            picture.mean(wrong)
    with pytest.raises(kaustik.Error, match="level"):
        picture.interval(1)


def test_intervals_hold_the_truth_as_often_as_they_say():
    """Of the mean, over seeds: the square is seen under a sky that varies."""
    scene = kaustik.load_dict(square_under_sky(
        lamp={"type": "point", "position": (0.2, 0.1, 0.4), "intensity": 1.0}))
    truth = kaustik.render(scene, integrator="path", passes=64, samples_per_pass=16, seed=99).mean()
    held = 0
    for seed in range(60):
        low, high = kaustik.render(scene, integrator="path", passes=8, samples_per_pass=1, seed=seed).mean().interval(0.8)
        held += low - 3 * truth.noise <= truth.value <= high + 3 * truth.noise
    assert 36 <= held  # 48 expected; 36 or fewer have a chance of 5e-4


def test_repr_of_estimates():
    assert repr(kaustik.Estimate(0.12341, 0.0005, 0, 15)) == "0.1234(5) W/(sr·m²)"
    assert repr(kaustik.Estimate(12345.6, 98, 0, 15)) == "12300(100) W/(sr·m²)"
    assert repr(kaustik.Estimate(0.5, 0.00096, 0, 15)) == "0.500(1) W/(sr·m²)"
    assert repr(kaustik.Estimate(3.2e-7, 4e-9, 0, 15)) == "3.20(4)e-7 W/(sr·m²)"
    assert repr(kaustik.Estimate(0.5, 0, 0, 15)) == "0.5 W/(sr·m²)"
    assert repr(kaustik.Estimate(0.5, 0)) == "0.5(?) W/(sr·m²)"
    assert kaustik.Estimate(0.5, 0.3, 0.4, 15).standard_error == pytest.approx(0.5)


def test_bias_noise_widens_intervals():
    estimate = kaustik.Estimate(1, 0.3, 0, 15, bias_noise=0.4)
    low, high = estimate.interval()
    assert (high - low) / 2 == pytest.approx(0.5 * 2.13145, rel=1e-4)
    assert pickle.loads(pickle.dumps(estimate)) == estimate != kaustik.Estimate(1, 0.3, 0, 15)


def test_bias_of_pixels():
    """A mirror below a lamp throws light at a ceiling, where merging has a bias."""
    scene = kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective", "film": {"type": "hdrfilm", "width": 8, "height": 8},
                   "to_world": kaustik.Transform().look_at(origin=(0, 0, 2), target=(0, 0, 3), up=(0, 1, 0))},
        "lamp": {"type": "point", "position": (0, 0, 1), "intensity": 2.0},
        "mirror": {"type": "rectangle", "bsdf": {"type": "conductor", "material": "none"}},
        "ceiling": {"type": "rectangle", "bsdf": {"type": "diffuse"},
                    "to_world": kaustik.Transform().translate((0, 0, 3)).rotate((1, 0, 0), 180).scale(50)},
    })
    picture = kaustik.render(scene, integrator={"type": "ppm", "radius": 3.0, "light_paths": 100.0}, passes=16)
    pixel, mean = picture.pixel(4, 4), picture.mean()
    # All pixels have the same, as where light is smooth: two thirds of the estimates.
    assert 0.6 < pixel.bias / mean.bias < 0.75
    assert 0 < pixel.bias_noise < pixel.bias
    assert mean.bias_noise == 0


def test_picture(scene, tmp_path, numpy):
    picture = kaustik.render(scene, integrator="vcm", passes=2, samples_per_pass=2)
    assert {"caustic", "direct", "albedo", "depth", "error"} <= set(picture.layers)
    assert picture["caustic"].shape == (12, 16, 3) and picture["depth"].shape == (12, 16)
    assert picture["R"].shape == (12, 16)
    with pytest.raises(KeyError, match="caustic"):
        picture["caustik"]
    assert picture.error.shape == (12, 16, 3)
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert picture.tonemap("linear", exposure=1).dtype == "uint8"
    with pytest.raises(kaustik.Error):
        picture.tonemap("linear", exposuree=1)
    smooth = picture.denoise()
    assert smooth.metadata["denoised"] and smooth.array.tobytes() != picture.array.tobytes()
    paths = [tmp_path / name for name in ("a.exr", "b.png", "c.pfm")]
    picture.write(*paths)
    assert all(path.stat().st_size > 0 for path in paths)
    assert kaustik.read(tmp_path / "c.pfm").array.tobytes() == picture.array.tobytes()
    with pytest.raises(kaustik.Error, match="xyz"):
        picture.write(tmp_path / "a.xyz", tmp_path / "d.png")
    assert (tmp_path / "d.png").exists()
    copy = pickle.loads(pickle.dumps(picture))
    assert copy.array.tobytes() == picture.array.tobytes() and copy.film == picture.film
    assert copy.metadata == picture.metadata
    with pytest.raises(kaustik.Error, match="film"):
        kaustik.read(tmp_path / "a.exr").mean()


def test_xarray(scene):
    pytest.importorskip("xarray")
    array = kaustik.render(scene, integrator="path", passes=1, samples_per_pass=1).to_xarray()
    assert array.dims == ("y", "x", "channel") and array.attrs["units"] == "W/(sr·m²)"


def test_errors_name_arguments(scene):
    """As Python calls them, not as the command line does."""
    for call in (lambda: kaustik.render(scene, integrator="pth"), lambda: kaustik.Session(scene, integrator="pth").run(),
                 lambda: kaustik.irradiance(scene, [(0, 0, 0)], (0, 0, 1), integrator="pth")):
        with pytest.raises(kaustik.Error, match="^integrator: unknown integrator type 'pth'") as caught:
            call()
        assert caught.value.file == "integrator" and "did you mean 'path'" in caught.value.remedy
    with pytest.raises(kaustik.Error, match="^definitions: the scene does not use 'size'") as caught:
        kaustik.load_string(scene.to_xml(), size=3)
    assert "-D" not in str(caught.value)
    with pytest.raises(kaustik.Error, match="define it: size=") as caught:
        kaustik.load_string('<scene version="3.0.0"><sensor type="$size"/></scene>')
    assert "-D" not in str(caught.value)


def test_integrators_by_dict(scene):
    picture = kaustik.render(scene, integrator={"type": "path", "max_depth": 1}, passes=1, samples_per_pass=1)
    assert picture.mean().value == 0  # nothing but what lamps show, and the square hides the sky
    with pytest.raises(kaustik.Error, match="max_depht"):
        kaustik.render(scene, integrator={"type": "path", "max_depht": 1})
    with pytest.raises(kaustik.Error, match="integrator"):
        kaustik.render(scene, integrator={"type": "sphere"})
    with pytest.raises(kaustik.Error, match="paath"):
        kaustik.render(scene, integrator="paath")


@pytest.mark.parametrize("wrong", [{"passes": 0}, {"passes": 1.5}, {"passes": 2 ** 40}, {"spp": -1}, {"time": 0},
                                   {"time": float("nan")}, {"error": -0.1}, {"seed": -1}, {"threads": -2},
                                   {"passes": "3"}, {"integrator": 3}, {"first_pass": -1}, {"time": True}])
def test_wrong_wishes(scene, wrong):
    with pytest.raises(kaustik.Error, match=list(wrong)[0]):
        kaustik.render(scene, **wrong)


def test_what_is_no_scene():
    with pytest.raises(kaustik.Error, match="scene: str is no scene"):
        kaustik.render("scene.xml")


def test_threads_make_no_difference(scene_file):
    scene = kaustik.load_file(scene_file)
    one, two = (kaustik.render(scene, integrator="vcm", passes=2, samples_per_pass=2, threads=n) for n in (1, 2))
    assert one.film == two.film
