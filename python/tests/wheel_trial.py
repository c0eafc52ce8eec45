"""What scripts/try_wheel.sh runs where there is nothing but python3: renders, writes and reads every kind of picture,
and tells which libraries it took from where. Exits by 1 if that is not as it should be."""

import ctypes
import math
import os
import struct
import sys
import tempfile

import kaustik

#: What the module is linked to besides, which every system has.
of_the_system = ("libc.", "libm.", "libstdc++.", "libgcc_s.", "libpthread.", "libdl.", "librt.", "ld-linux")


def scene():
    return kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective", "fov": 40, "film": {"type": "hdrfilm", "width": 48, "height": 32},
                   "to_world": kaustik.Transform().look_at(origin=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0))},
        "sky": {"type": "constant", "radiance": 1.0},
        "floor": {"type": "rectangle", "bsdf": {"type": "diffuse", "reflectance": 0.5}},
    })


def tiff_of_jbig() -> bytes:
    """One pixel, compressed by what the wheel's libtiff cannot read."""
    fields = [(256, 1), (257, 1), (258, 8), (259, 34661), (262, 1), (273, 8), (278, 1), (279, 4)]
    head = struct.pack("<2sHI", b"II", 42, 12) + b"\0\0\0\0"
    rows = b"".join(struct.pack("<HHII", tag, 4 if tag in (273, 279) else 3, 1, value) for tag, value in fields)
    return head + struct.pack("<H", len(fields)) + rows + b"\0\0\0\0"


def check_pictures() -> None:
    picture = kaustik.render(scene(), integrator="auto", passes=2, spp=8)
    value = picture.mean().value
    assert math.isclose(value, 0.5, rel_tol=1e-3), value
    with tempfile.TemporaryDirectory() as folder:
        for extension in ("exr", "tif", "png", "jpg", "hdr", "pfm", "ppm"):
            path = os.path.join(folder, "a." + extension)
            picture.write(path)
            assert kaustik.read(path).width == 48, extension
        jbig = os.path.join(folder, "jbig.tif")
        with open(jbig, "wb") as file:
            file.write(tiff_of_jbig())
        try:
            kaustik.read(jbig)
        except kaustik.Error as error:
            print("JBIG:", error.message)
        else:
            raise AssertionError("a picture that cannot be read was read")


class LoadedObject(ctypes.Structure):
    """The beginning of what dl_iterate_phdr shows."""

    _fields_ = [("address", ctypes.c_void_p), ("name", ctypes.c_char_p)]


def loaded_libraries() -> set:
    """By their paths; /proc is not there in a bare chroot."""
    paths = set()

    @ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(LoadedObject), ctypes.c_size_t, ctypes.c_void_p)
    def look(loaded, _size, _data):
        paths.add((loaded.contents.name or b"").decode())
        return 0

    ctypes.CDLL(None).dl_iterate_phdr(look, None)
    return {path for path in paths if ".so" in path}


def check_libraries() -> None:
    home = os.path.dirname(os.path.dirname(os.path.abspath(kaustik.__file__)))
    own = {path for path in loaded_libraries() if os.path.realpath(path).startswith(home)}
    assert len(own) > 10, own
    carried = set(os.listdir(os.path.join(home, "kaustik.libs"))) - {"LICENSES"}
    assert {os.path.basename(path) for path in own} >= carried, "some are not used"
    # Those of the same kinds that are not its own: Python's are there, such as zlib.
    for path in loaded_libraries() - own:
        kind = os.path.basename(path).split(".so")[0]
        assert not any(name.split("-")[0] == kind and kind != "libz" and kind != "liblzma" for name in carried), path
    print(len(own), "of its own; of the system:",
          *sorted(name for name in map(os.path.basename, loaded_libraries() - own) if name.startswith(of_the_system)))


if __name__ == "__main__":
    check_pictures()
    check_libraries()
    print("kaustik", kaustik.__version__, "renders with Python", sys.version.split()[0])
