"""Makes a wheel of Kaustik for pip (PEP 517) with CMake and what Debian has: no other packages.

What the build needs is in scripts/install_packages.sh (groups build and python). It goes to build/release,
as `make` does, so that what is there already is not built again; KAUSTIK_BUILD names another folder.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

root = pathlib.Path(__file__).resolve().parent.parent


def _version() -> str:
    text = (root / "CMakeLists.txt").read_text()
    return re.search(r"project\(kaustik VERSION ([0-9.]+)", text).group(1)


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _metadata() -> str:
    return "\n".join([
        "Metadata-Version: 2.1", "Name: kaustik", f"Version: {_version()}",
        "Summary: Photon mapping renderer", "License: Apache-2.0", "Requires-Python: >=3.9",
        "Provides-Extra: notebook",
        *(f'Requires-Dist: {name}; extra == "notebook"' for name in ("numpy", "matplotlib")), "", ""])


def _interpreter() -> str:
    """The one that the environment is made of: that is still there when the environment is not."""
    return os.path.realpath(getattr(sys, "_base_executable", sys.executable))


def _build() -> pathlib.Path:
    """The folder of the package, as CMake makes it."""
    folder = pathlib.Path(os.environ.get("KAUSTIK_BUILD", root / "build" / "release"))
    together = [] if (folder / "CMakeCache.txt").exists() else ["-D", "KAUSTIK_UNITY=ON", "-D",
                                                               "KAUSTIK_PRECOMPILED_HEADERS=ON"]
    subprocess.run(["cmake", "--preset", "release", "-B", str(folder), "-D", "KAUSTIK_PYTHON=ON",
                    "-D", f"Python_EXECUTABLE={_interpreter()}", *together], cwd=root, check=True)
    subprocess.run(["cmake", "--build", str(folder), "--target", "kaustik_package"], cwd=root, check=True)
    return folder / "python" / "kaustik"


def _files(package: pathlib.Path) -> dict:
    """Those of the wheel, by their names in it."""
    files = {}
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    for path in sorted(package.iterdir()):
        if path.suffix in (".py", ".pyi") or path.name in ("py.typed", f"_native{suffix}"):
            files[f"kaustik/{path.name}"] = path.read_bytes()
    if f"kaustik/_native{suffix}" not in files:
        raise SystemExit(f"{package} has no _native{suffix}: it was built for another Python; remove "
                         f"{package.parent.parent}/CMakeCache.txt and install again")
    return files


def _write_wheel(folder: str, files: dict, tag: str) -> str:
    info = f"kaustik-{_version()}.dist-info"
    files = {**files, f"{info}/METADATA": _metadata().encode(),
             f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: kaustik\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(),
             f"{info}/LICENSE": (root / "LICENSE").read_bytes()}
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(content)}")
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    wheel = f"kaustik-{_version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(folder, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            # Alike whenever it is made.
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if ".so" in name else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return _write_wheel(wheel_directory, _files(_build()), _tag())


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("there are no source packages: install from a clone of the repository")


def get_requires_for_build_wheel(config_settings=None):
    return []
