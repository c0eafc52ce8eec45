"""Arrays of any kind: right, or refused with the name of the argument."""

import array
import pickle

import pytest

import kaustik

vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]
faces = [[0, 1, 2], [1, 3, 2]]


def values(buffer):
    view = memoryview(buffer)
    return view.tolist()


def test_lists_and_buffers_are_the_same():
    flat = array.array("f", [x for row in vertices for x in row])
    view = memoryview(flat).cast("B").cast("f", shape=(4, 3))
    assert values(kaustik.Mesh(view, faces).vertices) == values(kaustik.Mesh(vertices, faces).vertices) == vertices


@pytest.mark.parametrize("dtype", ["float32", "float64", "uint8", "int32", "int64"])
def test_dtypes(numpy, dtype):
    mesh = kaustik.Mesh(numpy.array(vertices, dtype), numpy.array(faces, "uint32"))
    assert values(mesh.vertices) == vertices
    assert mesh.vertices.dtype == dtype


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32", "uint64", "int32", "int64"])
def test_dtypes_of_faces(numpy, dtype):
    assert values(kaustik.Mesh(vertices, numpy.array(faces, dtype)).faces) == faces


@pytest.mark.parametrize("dtype", ["float16", "complex64", "bool", "int8", ">f4", "object"])
def test_other_dtypes_are_refused(numpy, dtype):
    with pytest.raises(kaustik.Error, match="^vertices: "):
        kaustik.Mesh(numpy.array(vertices).astype(dtype), faces)


def test_strides(numpy):
    plain = numpy.array(vertices, "float32")
    wide = numpy.zeros((8, 6), "float32")
    wide[::2, ::2] = plain
    for strided in (wide[::2, ::2], plain[::-1][::-1], numpy.asfortranarray(plain), plain.T.copy().T):
        assert values(kaustik.Mesh(strided, faces).vertices) == vertices
    backwards = kaustik.Mesh(plain[::-1], faces)
    assert values(backwards.vertices) == vertices[::-1]


def test_read_only_and_copied_once(numpy):
    given = numpy.array(vertices)
    given.flags.writeable = False
    assert values(kaustik.Mesh(given, faces).vertices) == vertices
    given = numpy.array(vertices)
    mesh = kaustik.Mesh(given, faces)
    given[:] = 7
    assert values(mesh.vertices) == vertices
    shown = numpy.asarray(mesh.vertices)
    assert not shown.flags.writeable
    with pytest.raises(ValueError):
        shown[0, 0] = 1


@pytest.mark.parametrize("bad, what", [
    ([[0, 0, 0], [1, 0, 0], [0, 1, float("nan")]], "vertices: row 2 holds nan"),
    ([[0, 0, 0], [1, float("inf"), 0], [0, 1, 0]], "vertices: row 1 holds inf"),
    ([[0, 0], [1, 0], [0, 1]], r"vertices: its shape is \(3, 2\)"),
    ([0.0, 1.0, 2.0], r"vertices: its shape is \(3,\)"),
    ([[0, 0, 0], [1, 0], [0, 1, 0]], "vertices: its rows are not of one length"),
    ([["a", "b", "c"]], "vertices: it holds what is no number"),
    ([], "vertices: its shape"),
    ("text", "vertices: str is no array"),
    (3.5, "vertices: float is no array"),
])
def test_wrong_vertices(bad, what):
    with pytest.raises(kaustik.Error, match=what) as caught:
        kaustik.Mesh(bad, faces)
    assert caught.value.remedy


@pytest.mark.parametrize("bad, what", [
    ([[0, 1, 4]], "faces: row 0 refers to vertex 4"),
    ([[0, 1, 2], [0, -1, 2]], "faces: row 1 refers to vertex -1"),
    ([[0.0, 1.0, 2.0]], "faces: its elements are float64, not integers"),
    ([[0, 1, 2, 3]], r"faces: its shape is \(1, 4\)"),
])
def test_wrong_faces(bad, what):
    with pytest.raises(kaustik.Error, match=what):
        kaustik.Mesh(vertices, bad)


def test_huge_unsigned_index(numpy):
    with pytest.raises(kaustik.Error, match="faces: it holds 18446744073709551615"):
        kaustik.Mesh(vertices, numpy.array([[0, 1, 2 ** 64 - 1]], "uint64"))


def test_normals_and_uvs_need_a_row_for_each_vertex():
    with pytest.raises(kaustik.Error, match="normals: 1 rows for 4 vertices"):
        kaustik.Mesh(vertices, faces, normals=[[0, 0, 1]])
    with pytest.raises(kaustik.Error, match=r"uvs: its shape is \(4, 3\)"):
        kaustik.Mesh(vertices, faces, uvs=vertices)


def test_array_interface_alone(numpy):
    class Foreign:
        def __init__(self, values):
            self.values = values
            self.__array_interface__ = values.__array_interface__

    assert values(kaustik.Mesh(Foreign(numpy.array(vertices)), faces).vertices) == vertices
    with pytest.raises(kaustik.Error, match="vertices: .*gaps"):
        kaustik.Mesh(Foreign(numpy.array(vertices).T.copy().T), faces)


def test_buffers_show_themselves_to_numpy(numpy):
    mesh = kaustik.Mesh(vertices, faces, uvs=[[0, 0], [1, 0], [0, 1], [1, 1]])
    assert numpy.asarray(mesh.faces).dtype == numpy.int64
    assert numpy.array_equal(numpy.asarray(mesh.uvs), [[0, 0], [1, 0], [0, 1], [1, 1]])
    assert numpy.array_equal(numpy.frombuffer(mesh.vertices), numpy.array(vertices).ravel())


def test_meshes_pickle():
    mesh = pickle.loads(pickle.dumps(kaustik.Mesh(vertices, faces, normals=[[0, 0, 1]] * 4)))
    assert values(mesh.vertices) == vertices and values(mesh.faces) == faces
    assert repr(mesh) == "<kaustik.Mesh: 4 vertices, 2 faces, normals>"


def test_transforms(numpy):
    move = kaustik.Transform().translate((1, 2, 3)).rotate((0, 0, 1), 90)
    assert numpy.allclose(numpy.asarray(move) @ [1, 0, 0, 1], [1, 3, 3, 1])
    assert numpy.allclose(numpy.asarray(move.matrix) @ numpy.asarray(move.inverse().matrix), numpy.eye(4))
    assert kaustik.Transform(numpy.asarray(move)).matrix.tobytes() == move.matrix.tobytes()
    assert pickle.loads(pickle.dumps(move)) == move
    assert kaustik.Transform().scale(2) == kaustik.Transform().scale((2, 2, 2))
    camera = kaustik.Transform().look_at(origin=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0))
    assert numpy.allclose(numpy.asarray(camera)[:, 2], [0, 0, -1, 0])
    for wrong in (lambda: kaustik.Transform([[1, 0], [0, 1]]), lambda: kaustik.Transform(numpy.zeros((4, 4))),
                  lambda: kaustik.Transform().scale((1, 0, 1)), lambda: kaustik.Transform().translate((1, 2)),
                  lambda: kaustik.Transform().rotate((0, 0, 0), 3),
                  lambda: kaustik.Transform().look_at((0, 0, 0), (0, 0, 0), (0, 1, 0)),
                  lambda: kaustik.Transform(numpy.full((4, 4), numpy.nan))):
        with pytest.raises(kaustik.Error):
            wrong()
