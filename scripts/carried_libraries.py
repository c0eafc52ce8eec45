"""The libraries that a wheel or a tarball carries, for other distributions: which they are, how they find one another, and
under which licences they are.

Needs Debian, which tells of each library what package it is of and what its licence is, and patchelf. What every
distribution has is not carried (`system`). The others get names that have their content's digest. So neither
LD_LIBRARY_PATH nor a module that another wheel has loaded can put a library of the same name in their place. They find
one another by $ORIGIN.
"""

import hashlib
import os
import pathlib
import re
import subprocess

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
    "liblzma5": "LicenseRef-PublicDomain", "libdraco7": "Apache-2.0",
}
#: Of libraries that are compiled into the program and the module: a header of each tells the package. Boost's licence
#: asks for no text there.
compiled_in = {"/usr/include/nlohmann/json.hpp": "MIT"}
#: Versions that they, and what carries them, may ask for: glibc 2.34 and GCC 11, as of 2021.
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


def check_bounds(paths) -> None:
    late = [f"{path.name}: {what}" for path in paths for what in beyond_bounds(path)]
    if late:
        raise SystemExit("later versions are asked for than may be: " + "; ".join(late))


class Carried:
    """The libraries on their way into a package, in a folder."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        self.names: dict = {}  #: by the names that they had
        self.packages: dict = {}  #: that they are of; "": a part of Kaustik

    def take(self, name: str, path: pathlib.Path, package: str) -> None:
        content = path.read_bytes()
        stem, _, rest = name.partition(".so")
        self.names[name] = f"{stem}-{hashlib.sha256(content).hexdigest()[:8]}.so{rest}"
        self.packages[name] = package
        (self.folder / self.names[name]).write_bytes(content)

    def lead(self, path: pathlib.Path, origin: str, own_name: str = "") -> None:
        """Lets a program, module or library find those that it needs."""
        changes = [["--replace-needed", name, self.names[name]] for name in needed(path) if name in self.names]
        changes.append(["--set-rpath", origin])
        if own_name:
            changes.append(["--set-soname", own_name])
        for change in changes:  # patchelf 0.14 mixes them up if it is given several at once
            output("patchelf", *change, path)

    def connect(self) -> None:
        for name in self.names.values():
            self.lead(self.folder / name, "$ORIGIN", name)

    def tell(self) -> None:
        for name, new in self.names.items():
            package = self.packages[name]
            tell(self.folder / new, licence_of(package) if package else "Apache-2.0")


def carried_libraries(binary: pathlib.Path, no_jbig: pathlib.Path, folder: pathlib.Path) -> Carried:
    """All that the program or module needs, and no_jbig in the place of libjbig."""
    carried = Carried(folder)
    for name, path in sorted(found_by_linker(binary).items()):
        if name == "libjbig.so.0":
            carried.take(name, no_jbig, "")
            continue
        package = package_of(path)
        licence_of(package)
        carried.take(name, path, package)
    carried.connect()
    return carried


def make_portable(binary: pathlib.Path, symbols: str, no_jbig: pathlib.Path, folder: pathlib.Path, origin: str) -> Carried:
    """Puts all that the program or module needs into the folder, where it finds it by `origin`, strips the binary of
    `symbols` ("all", "unneeded"), and prints what there is. Fails if something asks for later versions than may be."""
    carried = carried_libraries(binary, no_jbig, folder)
    subprocess.run(["strip", f"--strip-{symbols}", str(binary)], check=True)
    carried.lead(binary, origin)
    tell(binary, "Apache-2.0")
    carried.tell()
    check_bounds((binary, *folder.iterdir()))
    return carried


def no_jbig(build: pathlib.Path) -> pathlib.Path:
    """What is carried instead of libjbig; it is built if need be."""
    subprocess.run(["cmake", "--build", str(build), "--target", "kaustik_no_jbig"], check=True)
    return next(build.glob("portable/libjbig.so.0*"))


def version_of(package: str) -> str:
    """Debian's."""
    return output("dpkg-query", "-W", "-f=${db:Status-Status} ${Version}\n", package).split()[1]


def table(listed: dict) -> str:
    """One line for each package: its name, its version, its licence."""
    rows = [(package, version_of(package), licence) for package, licence in sorted(listed.items())]
    widths = [max(len(row[column]) for row in rows) for column in (0, 1)]
    return "".join(f"{name:{widths[0]}}  {version:{widths[1]}}  {licence}\n" for name, version, licence in rows)


def licence_texts(carried: Carried, also_compiled_in: dict, place: str) -> dict:
    """The files that tell the licences, by their names. also_compiled_in: as `compiled_in`; place: where the libraries
    are, in words."""
    listed = {package: licence_of(package) for package in set(carried.packages.values()) - {""}}
    listed.update({package_of(pathlib.Path(header)): licence for header, licence in (compiled_in | also_compiled_in).items()})
    head = f"The libraries {place} and what is compiled in are Debian's. Each line has a package, its version and its\n" \
           "licence; the licence's text is the file of the package's name beside this. libjbig is a part of Kaustik that\n" \
           "stands in for the library of that name.\n\n"
    texts = {"README": (head + table(listed)).encode()}
    for package in sorted(listed):
        texts[package] = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_bytes()
    for name in {name for text in texts.values() for name in re.findall(r"/usr/share/common-licenses/([\w.+-]+\w)",
                                                                        text.decode("utf-8", "replace"))}:
        # Debian's files refer to these. GPL is there where only scripts or tools of the source are under it.
        if not name.startswith(("GPL", "LGPL", "GFDL")):
            texts[f"common/{name}"] = pathlib.Path(f"/usr/share/common-licenses/{name}").read_bytes()
    return texts


def tell(path: pathlib.Path, licence: str) -> None:
    asked = ", ".join(f"{kind} {'.'.join(map(str, number))}" for kind, number in sorted(versions(path).items()))
    print(f"{path.name:56} {path.stat().st_size / 1e6:7.2f} MB  {licence:30} {asked}")
