#!/usr/bin/env python3
"""Makes a wheel that carries the libraries it links, for other distributions and for machines that have only Python.

Usage: portable_wheel.py FOLDER; prints what it carries, and writes FOLDER/kaustik-….whl. Needs Debian and patchelf
(scripts/carried_libraries.py). The libraries lie in kaustik.libs.
"""

import os
import pathlib
import shutil
import sys
import tempfile

import build_backend

sys.path.insert(0, str(build_backend.root / "scripts"))
import carried_libraries as libraries  # noqa: E402

#: Besides libraries.compiled_in.
compiled_in = {"/usr/include/pybind11/pybind11.h": "BSD-3-Clause"}
#: Bytes that a wheel may have.
largest = 25_000_000


def tag() -> str:
    python, _, platform = build_backend._tag().rsplit("-", 2)
    machine = platform.split("_", 1)[1]
    glibc = libraries.bounds["GLIBC"]
    return f"{python}-{python}-manylinux_{glibc[0]}_{glibc[1]}_{machine}"


def make(folder: str) -> pathlib.Path:
    package = build_backend._build()
    no_jbig = libraries.no_jbig(package.parent.parent)
    files = build_backend._files(package)
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        place = work / "kaustik.libs"
        place.mkdir()
        [module_name] = [key for key in files if key.endswith(".so")]
        module = work / pathlib.PurePath(module_name).name
        shutil.copy(package / module.name, module)
        carried = libraries.make_portable(module, "unneeded", no_jbig, place, "$ORIGIN/../kaustik.libs")
        files[module_name] = module.read_bytes()
        files.update({f"kaustik.libs/{path.name}": path.read_bytes() for path in sorted(place.iterdir())})
        texts = libraries.licence_texts(carried, compiled_in, "in kaustik.libs")
        files.update({f"kaustik.libs/LICENSES/{name}": text for name, text in texts.items()})
    os.makedirs(folder, exist_ok=True)
    return pathlib.Path(folder) / build_backend._write_wheel(folder, files, tag())


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        raise SystemExit(__doc__)
    wheel = make(sys.argv[1])
    if wheel.stat().st_size > largest:
        raise SystemExit(f"{wheel} has {wheel.stat().st_size} bytes, more than {largest}")
    print(f"{wheel}: {wheel.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
