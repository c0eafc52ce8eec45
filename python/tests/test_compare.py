"""Comparing and merging, with the figures and bits of the command line."""

import re
import subprocess

import pytest

import kaustik
from conftest import square_under_sky


def test_compare(scene):
    picture = kaustik.render(scene, integrator="path", passes=4, samples_per_pass=2)
    assert kaustik.compare(picture, picture).mse == 0
    brighter = kaustik.render(scene.edit({"sky.radiance": 1.5}), integrator="path", passes=4, samples_per_pass=2)
    found = kaustik.compare(brighter, picture)
    assert found.mean_ratio == pytest.approx((1.5, 1.5, 1.5), rel=1e-3)
    assert found.mse == pytest.approx(0.25 ** 2, rel=0.01)  # 0.75 for 0.5
    assert found.pixel_count == 12 * 16 and found.non_finite_pixels == 0 and found.reference_noise >= 0
    colours = memoryview(kaustik.difference(brighter, picture)).tolist()
    red, green, blue = colours[6][8]
    assert red > green and red > blue
    with pytest.raises(kaustik.Error):
        kaustik.compare(picture, kaustik.render(scene.edit({"camera.film.width": 8}), integrator="path", passes=1))
    with pytest.raises(kaustik.Error, match="reference"):
        kaustik.compare(picture, 3)
    with pytest.raises(kaustik.Error, match="scale"):
        kaustik.difference(picture, picture, scale=0)


def test_figures_of_the_command_line(scene, program, tmp_path):
    for name, seed in (("a", 1), ("b", 2)):
        kaustik.render(scene, integrator="path", passes=2, samples_per_pass=1, seed=seed).write(
            tmp_path / f"{name}.exr", half=False)
    told = subprocess.run([program, "compare", tmp_path / "a.exr", tmp_path / "b.exr"], check=True, text=True,
                          capture_output=True).stdout
    found = kaustik.compare(tmp_path / "a.exr", tmp_path / "b.exr")
    for name in ("mse", "relative_mse", "relative_mse_trimmed", "reference_noise"):
        [figure] = re.findall(rf"^{name} +(\S+)", told, re.MULTILINE)
        assert float(figure) == pytest.approx(getattr(found, name), rel=1e-5, abs=1e-12), name


def test_merge_films(scene, tmp_path):
    settings = {"integrator": "path", "samples_per_pass": 2}
    films = [kaustik.render(scene, passes=2, first_pass=first, **settings).film for first in (0, 2, 4)]
    films[1].save(tmp_path / "some.kpt")
    assert kaustik.merge(films[2], tmp_path / "some.kpt", films[0]) == kaustik.render(scene, passes=6, **settings).film
    with pytest.raises(kaustik.Error):
        kaustik.merge(films[0], films[0])
    with pytest.raises(kaustik.Error, match="no parts"):
        kaustik.merge()
    with pytest.raises(kaustik.Error, match="different kinds"):
        kaustik.merge(films[0], 3)
