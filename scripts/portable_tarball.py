#!/usr/bin/env python3
"""Makes a tarball of the program with the libraries that it links: it runs where it is unpacked, and needs no installation.

Usage: portable_tarball.py BUILD FOLDER; BUILD has the program, built. Prints what the tarball carries, and writes
FOLDER/kaustik-VERSION-linux-MACHINE.tar.xz. Needs Debian and patchelf (scripts/carried_libraries.py).

In it, bin/kaustik finds its libraries in lib/kaustik, all else lies as `make install` puts it. The same build gives the
same bytes: names are sorted, owners fixed, and times those of SOURCE_DATE_EPOCH, or else of the last commit.
"""

import io
import os
import pathlib
import platform
import subprocess
import sys
import tarfile
import tempfile

import carried_libraries as libraries

root = pathlib.Path(__file__).resolve().parent.parent

#: Besides libraries.compiled_in.
compiled_in = {"/usr/include/CLI/CLI.hpp": "BSD-3-Clause"}

readme = """\
Kaustik {version}, a photon mapping renderer. This folder may lie anywhere; nothing has to be installed. Licence: Apache 2.0 (LICENSE).
Begin with: bin/kaustik render scenes/cornell_box/cornell_box.xml --time 10s -o box.png   (scenes/… lies in share/kaustik, and is found from everywhere)
All commands: bin/kaustik --help; man pages: man -M share/man kaustik; for shells: share/bash-completion, share/zsh, share/fish; manual: share/doc/kaustik.
It needs {needs}: Debian 12, Ubuntu 22.04, RHEL 9. AVX, AVX2 and AVX-512 are used where there are.
The libraries in lib/kaustik are Debian's: share/doc/kaustik/LICENSES/README lists their versions and licences, and has their texts.
"""
#: What the processor has to have: cmake/compiler.cmake, apps/kaustik/processor_check.cpp.
processors = {"x86_64": "an x86-64 processor with SSE4.2 and POPCNT (x86-64-v2; since about 2009), "}


def time_of_sources() -> int:
    if "SOURCE_DATE_EPOCH" in os.environ:
        return int(os.environ["SOURCE_DATE_EPOCH"])
    told = subprocess.run(["git", "-C", str(root), "log", "-1", "--format=%ct"], capture_output=True, text=True).stdout
    if not told:
        raise SystemExit("there is no commit here whose time the files could have: set SOURCE_DATE_EPOCH, in seconds")
    return int(told)


def readme_text(version: str, machine: str) -> str:
    glibc = ".".join(map(str, libraries.bounds["GLIBC"]))
    needs = f"{processors.get(machine, '')}glibc {glibc} and the libstdc++ of GCC 11, or later ones"
    return readme.format(version=version, needs=needs)


def fill(folder: pathlib.Path, build: pathlib.Path, version: str, machine: str) -> None:
    no_jbig = libraries.no_jbig(build)
    subprocess.run(["cmake", "--install", str(build), "--prefix", str(folder), "--component", "program"],
                   check=True, stdout=subprocess.DEVNULL)
    program = folder / "bin" / "kaustik"
    place = folder / "lib" / "kaustik"
    place.mkdir(parents=True)
    carried = libraries.make_portable(program, "all", no_jbig, place, "$ORIGIN/../lib/kaustik")
    for name, text in libraries.licence_texts(carried, compiled_in, "in lib/kaustik").items():
        path = folder / "share" / "doc" / "kaustik" / "LICENSES" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)
    (folder / "README").write_text(readme_text(version, machine))
    (folder / "LICENSE").write_bytes((root / "LICENSE").read_bytes())


def write(tarball: pathlib.Path, folder: pathlib.Path, time: int) -> None:
    """The files of the folder, below its name."""
    with tarfile.open(tarball, "w:xz", format=tarfile.GNU_FORMAT, preset=9) as archive:
        for path in (folder, *sorted(folder.rglob("*"))):
            entry = tarfile.TarInfo(str(path.relative_to(folder.parent)))
            entry.mtime, entry.uname, entry.gname = time, "root", "root"
            if path.is_dir():
                entry.type, entry.mode = tarfile.DIRTYPE, 0o755
                archive.addfile(entry)
                continue
            content = path.read_bytes()
            entry.size, entry.mode = len(content), 0o755 if path.parent.name == "bin" else 0o644
            archive.addfile(entry, io.BytesIO(content))


def main() -> None:
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        raise SystemExit(__doc__)
    build, target = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    version, machine = libraries.output(build / "kaustik", "--version").strip(), platform.machine()
    name = f"kaustik-{version}-linux-{machine}"
    tarball = target / f"{name}.tar.xz"
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work) / name
        fill(folder, build, version, machine)
        write(tarball, folder, time_of_sources())
        size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    print(f"{tarball}: {tarball.stat().st_size / 1e6:.1f} MB, {size / 1e6:.1f} MB unpacked")


if __name__ == "__main__":
    main()
