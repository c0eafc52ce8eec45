"""Wheels that carry their libraries: what these ask for, and under which licences they are. `make wheel` makes one and
tries it; scripts/try_wheel.sh does so in a Debian that has only Python."""

import importlib.util
import pathlib
import shutil
import subprocess
import sys

import pytest

from kaustik import _native

module = pathlib.Path(_native.__file__)
folder = pathlib.Path(__file__).parent.parent


@pytest.fixture(scope="module")
def maker():
    if shutil.which("objdump") is None or shutil.which("dpkg-query") is None:
        pytest.skip("wheels that carry libraries are made on Debian")
    spec = importlib.util.spec_from_file_location("portable_wheel", folder / "portable_wheel.py")
    made = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(folder))  # where it has build_backend from
    try:
        spec.loader.exec_module(made)
    finally:
        sys.path.remove(str(folder))
    return made


@pytest.fixture(scope="module")
def libraries(maker):
    found = maker.libraries.found_by_linker(module)
    if any("kaustik.libs" in str(path) for path in found.values()):
        pytest.skip("this is such a wheel")
    return found


def test_asks_for_glibc_2_34_at_most(maker, libraries):
    for path in (module, *libraries.values()):
        print(path.name, maker.libraries.versions(path))
        assert maker.libraries.versions(path)
        if path.name != module.name or _is_debian_12():
            assert maker.libraries.beyond_bounds(path) == [], path


def _is_debian_12():
    return 'VERSION_ID="12"' in pathlib.Path("/etc/os-release").read_text()


def test_later_versions_are_found(maker, tmp_path):
    source, library = tmp_path / "late.c", tmp_path / "late.so"
    source.write_text("double hypot(double, double); double f(double x) { return hypot(x, x); }")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    found = maker.libraries.versions(library)["GLIBC"]
    if found < (2, 35):
        pytest.skip("this system's glibc has no such function")
    assert maker.libraries.beyond_bounds(library) == ["GLIBC_2.35"]


def test_licences(maker, libraries):
    for name, path in libraries.items():
        package = maker.libraries.package_of(path)
        if name == "libjbig.so.0":  # under the GPL
            with pytest.raises(SystemExit, match="look up in /usr/share/doc/libjbig0/copyright"):
                maker.libraries.licence_of(package)
        else:
            assert "GPL" not in maker.libraries.licence_of(package)
            assert pathlib.Path(f"/usr/share/doc/{package}/copyright").exists()
    for header in maker.compiled_in:
        assert pathlib.Path(f"/usr/share/doc/{maker.libraries.package_of(pathlib.Path(header))}/copyright").exists()
    assert "libembree3.so.3" in libraries or "libembree4.so.4" in libraries
    assert not any(name in libraries for name in ("libc.so.6", "libstdc++.so.6"))
    with pytest.raises(SystemExit, match="no package"):
        maker.libraries.package_of(pathlib.Path(__file__))


def test_the_stand_in_has_all_that_libtiff_asks_for(maker, libraries):
    """Of libjbig: see no_jbig.cpp."""
    tiff = libraries["libtiff.so.6"]
    told = subprocess.run(["objdump", "-T", tiff], check=True, capture_output=True, text=True).stdout
    asked = {line.split()[-1] for line in told.splitlines() if "*UND*" in line and "jbg_" in line}
    source = (folder.parent / "cmake" / "portable" / "no_jbig.cpp").read_text()
    assert asked and all(f" {name}(" in source or f"*{name}(" in source or f"* {name}(" in source for name in asked)
