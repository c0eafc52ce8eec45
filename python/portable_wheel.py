#!/usr/bin/env python3
"""Makes a wheel that carries the libraries it links, for other distributions and for machines that have only Python.

Usage: portable_wheel.py FOLDER; prints what it carries, and writes FOLDER/kaustik-….whl. Needs Debian, which tells of
each library what package it is of and what its licence is, and patchelf.

What every distribution has is not carried (`system`). The others lie in kaustik.libs, by names that have their
content's digest: modules of other wheels bring libraries of the same names, and one process takes only one of a name.
They find one another by $ORIGIN.
"""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import build_backend

#: What programs find everywhere.
system = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libgcc_s.so.1", "libstdc++.so.6",
          "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}

#: Under which licence each package's library is carried, of those that its file `copyright` offers. Whatever comes to
#: be linked has to be looked up and added here; what asks for the source of the whole, as the GPL does, cannot.
licences = {
    "libembree3-3": "Apache-2.0", "libtbb12": "Apache-2.0", "libhwy1": "Apache-2.0", "liblerc4": "Apache-2.0",
    "libopenexr-3-1-30": "BSD-3-Clause", "libimath-3-1-29": "BSD-3-Clause", "libwebp7": "BSD-3-Clause",
    "libzstd1": "BSD-3-Clause", "libjpeg62-turbo": "IJG AND BSD-3-Clause AND Zlib", "libtiff6": "libtiff",
    "libpng16-16": "libpng-2.0", "zlib1g": "Zlib", "libdeflate0": "MIT", "libfmt9": "MIT", "libpugixml1v5": "MIT",
    "liblzma5": "LicenseRef-PublicDomain",
}
#: Of libraries that are compiled in: a header of each tells the package. Boost's licence asks for no text there.
compiled_in = {"/usr/include/nlohmann/json.hpp": "MIT", "/usr/include/pybind11/pybind11.h": "BSD-3-Clause"}
#: Bytes that a wheel may have.
largest = 25_000_000
#: Versions that a wheel may ask for: glibc 2.34 and GCC 11, as of 2021.
bounds = {"GLIBC": (2, 34), "GLIBCXX": (3, 4, 29), "CXXABI": (1, 3, 13)}


def output(*command) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def needed(path) -> list:
    return output("patchelf", "--print-needed", path).split()


def found_by_linker(path) -> dict:
    """Where the libraries are that it needs, and those that they need, by their names."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", path), re.MULTILINE))
    return {name: pathlib.Path(place) for name, place in found.items() if name not in system}


def package_of(library: pathlib.Path) -> str:
    places = {str(library), os.path.realpath(library)}
    # Debian's packages name files as they were before /lib became a link to /usr/lib.
    spelled = sorted({other for place in places for other in (place, place.replace("/usr/lib/", "/lib/", 1), "/usr" + place)})
    told = subprocess.run(["dpkg-query", "-S", *spelled], capture_output=True, text=True).stdout
    if not told:
        raise SystemExit(f"{library}: no package of Debian has it, so nobody knows its licence")
    return told.split(":")[0]


def licence_of(package: str) -> str:
    if package not in licences:
        raise SystemExit(f"{package}: look up in /usr/share/doc/{package}/copyright under which licence it can be "
                         f"carried, and add it to `licences` in {__file__}")
    return licences[package]


def versions(path) -> dict:
    """The latest version of each kind that it asks for: {"GLIBC": (2, 34), …}."""
    found: dict = {}
    for kind, number in re.findall(r"\b(GLIBC|GLIBCXX|CXXABI)_([0-9.]+)\b", output("objdump", "-T", path)):
        found[kind] = max(found.get(kind, (0,)), tuple(map(int, number.split("."))))
    return found


def beyond_bounds(path) -> list:
    return [f"{kind}_{'.'.join(map(str, number))}" for kind, number in versions(path).items() if number > bounds[kind]]


def tag() -> str:
    python, _, platform = build_backend._tag().rsplit("-", 2)
    machine = platform.split("_", 1)[1]
    return f"{python}-{python}-manylinux_{bounds['GLIBC'][0]}_{bounds['GLIBC'][1]}_{machine}"


class Carried:
    """The libraries on their way into the wheel, in a folder."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        self.names: dict = {}  #: by the names that they had
        self.packages: dict = {}  #: that they are of

    def take(self, name: str, path: pathlib.Path, package: str) -> None:
        content = path.read_bytes()
        stem, _, rest = name.partition(".so")
        self.names[name] = f"{stem}-{hashlib.sha256(content).hexdigest()[:8]}.so{rest}"
        self.packages[name] = package
        (self.folder / self.names[name]).write_bytes(content)

    def lead(self, path: pathlib.Path, origin: str, own_name: str = "") -> None:
        """Lets a module or library find those that it needs."""
        changes = [["--replace-needed", name, self.names[name]] for name in needed(path) if name in self.names]
        changes.append(["--set-rpath", origin])
        if own_name:
            changes.append(["--set-soname", own_name])
        for change in changes:  # patchelf 0.14 mixes them up if it is given several at once
            output("patchelf", *change, path)

    def connect(self) -> None:
        for name in self.names.values():
            self.lead(self.folder / name, "$ORIGIN", name)


def carried_libraries(module: pathlib.Path, no_jbig: pathlib.Path, folder: pathlib.Path) -> Carried:
    carried = Carried(folder)
    for name, path in sorted(found_by_linker(module).items()):
        if name == "libjbig.so.0":
            carried.take(name, no_jbig, "")
            continue
        package = package_of(path)
        licence_of(package)
        carried.take(name, path, package)
    carried.connect()
    return carried


def licence_texts(carried: Carried) -> dict:
    """The files of the wheel that tell the licences."""
    listed = {package: licence_of(package) for package in set(carried.packages.values()) - {""}}
    listed.update({package_of(pathlib.Path(header)): licence for header, licence in compiled_in.items()})
    packages = sorted(listed)
    table = "".join(f"{package}: {listed[package]}\n" for package in packages)
    head = "The libraries in this folder and what is compiled in are Debian's, by package, under these licences; their\n" \
           "texts are beside this. libjbig is a part of Kaustik that stands in for the library of that name.\n\n"
    texts = {"kaustik.libs/LICENSES/README": (head + table).encode()}
    for package in packages:
        texts[f"kaustik.libs/LICENSES/{package}"] = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_bytes()
    for name in {name for text in texts.values() for name in re.findall(r"/usr/share/common-licenses/([\w.+-]+\w)",
                                                                        text.decode("utf-8", "replace"))}:
        # Debian's files refer to these. GPL is there where only scripts or tools of the source are under it.
        if not name.startswith(("GPL", "LGPL", "GFDL")):
            texts[f"kaustik.libs/LICENSES/common/{name}"] = pathlib.Path(f"/usr/share/common-licenses/{name}").read_bytes()
    return texts


def tell(path: pathlib.Path, licence: str) -> None:
    asked = ", ".join(f"{kind} {'.'.join(map(str, number))}" for kind, number in sorted(versions(path).items()))
    print(f"{path.name:56} {path.stat().st_size / 1e6:7.2f} MB  {licence:30} {asked}")


def make(folder: str) -> pathlib.Path:
    package = build_backend._build()
    build = package.parent.parent
    subprocess.run(["cmake", "--build", str(build), "--target", "kaustik_no_jbig"], check=True)
    files = build_backend._files(package)
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        libraries = work / "kaustik.libs"
        libraries.mkdir()
        [module_name] = [key for key in files if key.endswith(".so")]
        module = work / pathlib.PurePath(module_name).name
        shutil.copy(package / module.name, module)
        carried = carried_libraries(module, next((build / "python").glob("libjbig.so.0*")), libraries)
        subprocess.run(["strip", "--strip-unneeded", str(module)], check=True)
        carried.lead(module, "$ORIGIN/../kaustik.libs")
        tell(module, "Apache-2.0")
        for own, new in carried.names.items():
            package_name = carried.packages[own]
            tell(libraries / new, licence_of(package_name) if package_name else "Apache-2.0")
        late = [f"{path.name}: {what}" for path in (module, *libraries.iterdir()) for what in beyond_bounds(path)]
        if late:
            raise SystemExit("later versions are asked for than the wheel may: " + "; ".join(late))
        files[module_name] = module.read_bytes()
        files.update({f"kaustik.libs/{path.name}": path.read_bytes() for path in sorted(libraries.iterdir())})
        files.update(licence_texts(carried))
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
