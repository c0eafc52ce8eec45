"""Photon maps as arrays: a closed form, the bits of the command line, parts."""

import math
import pathlib
import subprocess
import time

import pytest

import kaustik
from test_session import run_python

spheres = str(pathlib.Path(__file__).parent.parent.parent / "scenes/cornell_spheres/cornell_spheres.xml")
#: A point lamp 1 m above the middle of a mirror of 2 m x 2 m, which throws light at a ceiling of 3 m.
intensity = 2.0
solid_angle = 4 * math.asin(0.5)  # of the mirror, seen from the lamp: 2 pi / 3


def mirror_below_a_lamp():
    return kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective", "film": {"type": "hdrfilm", "width": 8, "height": 8}},
        "lamp": {"type": "point", "position": (0, 0, 1), "intensity": intensity},
        "mirror": {"type": "rectangle", "bsdf": {"type": "conductor", "material": "none"}},
        "ceiling": {"type": "rectangle", "bsdf": {"type": "diffuse"},
                    "to_world": kaustik.Transform().translate((0, 0, 3)).rotate((1, 0, 0), 180).scale(50)},
    })


wanted = {"type": "photonmap", "caustic_photons": 20000, "global_photons": 2000}


def total_and_its_error(powers):
    """Of a sum of photons that arrive by themselves."""
    return math.fsum(powers), math.sqrt(math.fsum(power * power for power in powers))


def test_power_of_a_mirror_image():
    """What the mirror sends on is the lamp's intensity times the mirror's solid angle."""
    caustic = kaustik.trace_photons(mirror_below_a_lamp(), integrator=wanted)["caustic"]
    rows = memoryview(caustic.powers).tolist()
    for channel in range(3):
        total, error = total_and_its_error([row[channel] for row in rows])
        assert abs(total - intensity * solid_angle) < 5 * error
        # It can fail: a tenth more is not within that.
        assert abs(total - 1.1 * intensity * solid_angle) > 5 * error
    assert caustic.counts.stored == len(caustic) > 1000
    assert caustic.counts.stored_flux == pytest.approx(total, rel=1e-4)


def test_arrays_of_a_mirror_image():
    caustic = kaustik.trace_photons(mirror_below_a_lamp(), integrator=wanted)["caustic"]
    positions, directions, normals = (memoryview(rows).tolist()
                                      for rows in (caustic.positions, caustic.directions, caustic.normals))
    assert 1000 < len(positions) == len(directions) == len(normals) == caustic.paths.shape[0] == len(caustic)
    for position, direction, normal in zip(positions, directions, normals):
        assert position[2] == pytest.approx(3, abs=1e-4)
        # Away from the lamp's image, 1 m below the mirror.
        along = [position[0], position[1], position[2] + 1]
        length = math.hypot(*along)
        assert direction == pytest.approx([x / length for x in along], abs=1e-3)
        assert normal == pytest.approx([0, 0, -1], abs=0.02)
    assert caustic.positions is caustic.positions and caustic.positions.dtype == "float32"


def test_shown(numpy):
    photons = kaustik.trace_photons(mirror_below_a_lamp(), integrator=wanted)
    assert list(photons) == ["caustic", "global"] and len(photons) == 2 and photons.is_whole
    assert numpy.asarray(photons["caustic"].positions).shape == (len(photons["caustic"]), 3)
    assert f"{len(photons['caustic'])} caustic" in repr(photons) and "caustic" in repr(photons["caustic"])
    with pytest.raises(KeyError):
        photons["volume"]


def lamp_by_position(photons):
    """Files and merges have their own order."""
    positions = memoryview(photons["caustic"].positions).tolist()
    return dict(zip(map(tuple, positions), memoryview(photons["caustic"].lamps).tolist()))


def test_lamps(tmp_path):
    """Two lamps above the mirror: each photon leaves the image of the one that it is told to come from."""
    scene = mirror_below_a_lamp().to_dict()
    where = {"lamp": (0, 0, 1), "other": (0.6, 0.2, 1.5)}
    scene["other"] = {"type": "point", "position": where["other"], "intensity": 3.0}
    traced = kaustik.trace_photons(kaustik.load_dict(scene), integrator=wanted)
    assert sorted(traced.lamp_names) == ["lamp", "other"]
    caustic = traced["caustic"]
    lamps = memoryview(caustic.lamps).tolist()
    assert min(lamps.count(0), lamps.count(1)) > 500 and len(lamps) == len(caustic)
    for position, direction, lamp in zip(memoryview(caustic.positions).tolist(),
                                         memoryview(caustic.directions).tolist(), lamps):
        x, y, z = where[traced.lamp_names[lamp]]
        along = [position[0] - x, position[1] - y, position[2] + z]
        length = math.hypot(*along)
        assert direction == pytest.approx([a / length for a in along], abs=1e-3)
    assert 0 < len(traced["global"]) == traced["global"].lamps.shape[0]
    # Files keep what tells the lamps, but no names; parts tell them once they are together.
    traced.save(tmp_path / "a.kpm")
    again = kaustik.Photons.load(tmp_path / "a.kpm")
    assert lamp_by_position(again) == lamp_by_position(traced) and again.lamp_names == ()
    parts = [kaustik.trace_photons(kaustik.load_dict(scene), integrator=wanted, part=(part, 2)) for part in (1, 2)]
    with pytest.raises(kaustik.Error, match="part"):
        parts[0]["caustic"].lamps
    merged = kaustik.merge(*parts)
    assert lamp_by_position(merged) == lamp_by_position(traced) and merged.lamp_names == traced.lamp_names


def test_same_bits_as_the_command_line(program, tmp_path):
    path, maps = spheres, tmp_path / "maps.kpm"
    subprocess.run([program, "photons", path, "-o", maps, "--seed", "3", "-q", "--set", "integrator.global_photons=3000",
                    "--set", "integrator.caustic_photons=2000"], check=True, stdout=subprocess.DEVNULL)
    scene = kaustik.load_file(path)
    settings = {"type": "photonmap", "global_photons": 3000, "caustic_photons": 2000}
    photons = kaustik.trace_photons(scene, integrator=settings, seed=3)
    photons.save(tmp_path / "own.kpm")
    assert (tmp_path / "own.kpm").read_bytes() == maps.read_bytes()
    again = kaustik.Photons.load(maps)
    assert len(again["global"]) == len(photons["global"]) > 100 and len(again["caustic"]) > 100
    for one, other in ((again["global"], photons["global"]), (again["caustic"], photons["caustic"])):
        assert sorted(memoryview(one.powers).tolist()) == sorted(memoryview(other.powers).tolist())
    # It can fail: another seed has other photons.
    kaustik.trace_photons(scene, integrator=settings, seed=4).save(tmp_path / "own.kpm")
    assert (tmp_path / "own.kpm").read_bytes() != maps.read_bytes()


def test_empty_maps_are_told(scene):
    photons = kaustik.trace_photons(scene)
    assert len(photons["caustic"]) == 0 and any("caustic" in warning for warning in photons.warnings)
    assert photons["caustic"].positions.shape == (0, 3)


def test_parts_make_the_whole(tmp_path):
    scene = mirror_below_a_lamp()
    kaustik.trace_photons(scene, integrator=wanted).save(tmp_path / "whole.kpm")
    parts = [kaustik.trace_photons(scene, integrator=wanted, part=(part, 3)) for part in (1, 2, 3)]
    assert not parts[0].is_whole and "a part" in repr(parts[0])
    parts[1].save(tmp_path / "second.kpm")
    merged = kaustik.merge(parts[2], tmp_path / "second.kpm", parts[0])
    merged.save(tmp_path / "merged.kpm")
    assert (tmp_path / "merged.kpm").read_bytes() == (tmp_path / "whole.kpm").read_bytes()
    for wrong in (parts[:2], [parts[0], parts[0], parts[2]]):
        with pytest.raises(kaustik.Error):
            kaustik.merge(*wrong)


def test_what_cannot_be_traced(scene, tmp_path):
    for more, what in (({"part": (0, 2)}, "part"), ({"part": (3, 2)}, "part"), ({"part": 2}, "part"),
                       ({"part": (1, 1 << 40)}, "part"), ({"part": (1.5, 2)}, "part"), ({"seed": -1}, "seed"),
                       ({"integrator": "path"}, "integrator"), ({"integrator": {"type": "path"}}, "integrator")):
        with pytest.raises(kaustik.Error, match=what):
            kaustik.trace_photons(scene, **more)
    with pytest.raises(kaustik.Error, match="scene"):
        kaustik.trace_photons({"type": "scene"})
    (tmp_path / "a.kpm").write_bytes(b"no photons")
    with pytest.raises(kaustik.Error):
        kaustik.Photons.load(tmp_path / "a.kpm")
    with pytest.raises(TypeError):
        kaustik.Photons()


def test_ctrl_c():
    process = run_python("""
        import signal, kaustik, threading, time
        from test_photons import mirror_below_a_lamp
        signal.signal(signal.SIGINT, signal.default_int_handler)
        scene = mirror_below_a_lamp()
        print("ready", flush=True)
        try:
            kaustik.trace_photons(scene, integrator={"type": "photonmap", "caustic_photons": 100_000_000})
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        """)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(2)
    assert process.stdout.readline() == "interrupted\n", process.stderr.read()
    assert process.wait(30) == 0
