"""The tables, what editors see of them, and what is seen of the compiled part."""

import inspect
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import textwrap

import pytest

import kaustik
from conftest import square_under_sky

package = pathlib.Path(kaustik.__file__).parent


def test_tables():
    ior = kaustik.types["bsdf"]["dielectric"]["int_ior"]
    assert (ior.kind, ior.default, ior.maximum) == ("number or name", "bk7", 100)
    assert "water" in ior.choices and ior.sentence
    assert {"integrator", "shape", "bsdf", "emitter", "sensor", "film", "tonemap"} <= set(kaustik.types)
    assert kaustik.types["shape"]["sphere"]["center"].default == (0.0, 0.0, 0.0)
    assert kaustik.types["shape"]["mesh"]["positions"].shape == (0, 3)
    assert kaustik.types.find("bsdf", "nothing") is None
    for shown in (kaustik.types, kaustik.types.bsdf, kaustik.types.bsdf.diffuse):
        assert "diffuse" in repr(shown) and shown._ipython_key_completions_()


def test_types_make_dicts():
    assert kaustik.types.bsdf.dielectric(int_ior=1.5) == {"type": "dielectric", "int_ior": 1.5}
    bsdf = kaustik.types.bsdf
    scene = kaustik.load_dict(square_under_sky(ball=kaustik.types.shape.sphere(
        radius=0.2, bsdf=bsdf.twosided(id="metal", bsdf=bsdf.conductor(material="Au")))))
    assert scene.parameters["ball.radius"] == 0.2 and "metal" in repr(scene)
    with pytest.raises(kaustik.Error, match="int_iro") as caught:
        kaustik.types.bsdf.dielectric(int_iro=1.5)
    assert "int_ior" in caught.value.remedy
    with pytest.raises(AttributeError, match="did you mean 'dielectric'"):
        kaustik.types.bsdf.dielektric
    assert "int_ior" in inspect.signature(kaustik.types.bsdf.dielectric).parameters
    assert "dielectric" in dir(kaustik.types.bsdf) and "bsdf" in dir(kaustik.types)


def test_stubs_know_every_type():
    stubs = (package / "_types.pyi").read_text()
    for family, members in kaustik.types.items():
        for name in members:
            if name.isidentifier():
                assert f"class _{family}_{name}(Type)" in stubs
    compile(stubs, "_types.pyi", "exec")


def test_mypy(tmp_path):
    program = shutil.which("mypy")
    if program is None:
        pytest.skip("mypy is not installed")
    right, wrong = tmp_path / "right.py", tmp_path / "wrong.py"
    right.write_text(textwrap.dedent("""
        import kaustik
        scene = kaustik.load_dict({"type": "scene", "ball": kaustik.types.shape.sphere(
            radius=0.2, bsdf=kaustik.types.bsdf.dielectric(int_ior="water"))})
        picture: kaustik.Picture = kaustik.render(scene, passes=3)
        low: float = picture.mean().interval().low
        """))
    # It can fail.
    wrong.write_text(right.read_text().replace('"water"', '"watr"').replace("passes=3", 'passes="3"'))
    environment = dict(os.environ)
    if "site-packages" not in package.parts:  # mypy finds those by itself
        environment["MYPYPATH"] = str(package.parent)
    # The package itself, too.
    told = subprocess.run([program, "--python-executable", sys.executable, "--cache-dir", os.devnull, right, wrong,
                           package], env=environment, text=True, capture_output=True).stdout
    errors = [line for line in told.splitlines() if "error:" in line]
    assert len(errors) == 2 and all("wrong.py" in line for line in errors), told
    assert "int_ior" in told and "passes" in told


def test_nothing_but_the_module_is_exported():
    nm = shutil.which("nm")
    if nm is None:
        pytest.skip("nm is not installed")
    library = next(package.glob("_native*.so"))
    told = subprocess.run([nm, "-D", "--defined-only", library], text=True, capture_output=True, check=True)
    assert [line.split()[-1] for line in told.stdout.splitlines()] == ["PyInit__native"]


def test_neither_numpy_nor_anything_else_is_imported():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    told = subprocess.run([sys.executable, "-c", "import sys, kaustik; print('numpy' in sys.modules)"],
                          env=environment, text=True, capture_output=True, check=True)
    assert told.stdout == "False\n"


def test_problems_pickle():
    problem = kaustik.Problem("wrong", "mend it", "floor")
    assert pickle.loads(pickle.dumps(problem)) == problem
    assert str(problem) == "floor: wrong\n  mend it"
