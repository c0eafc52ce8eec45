"""Wrong values in every place of a scene's dict: an Error with a place, or a scene; nothing else."""

import os
import random

import kaustik
from conftest import square_under_sky

hostile = [None, object(), "x" * 500, "", "\0", "\ud800", -1, 2 ** 70, 1e308, float("nan"), float("inf"), True, [], [[]],
           [[1, 2], [3]], (1,), (1, 2, 3), (1, float("nan"), 3), ("a", "b", "c"), {}, {"type": 3}, {"type": "rgb"},
           {"type": "rgb", "value": [1, 2]}, {"type": "spectrum", "value": [(500, 1), (400, 1)]}, {"type": "ref"},
           {"type": "ref", "id": "floor"}, {"type": "ref", "id": "victim"}, {"type": "sphere", "radius": "no"}, b"bytes",
           bytearray(9), memoryview(b"abcdef")[::2], lambda: 3, kaustik.Transform(), 1 + 2j, range(3), {1: 2}, {1, 2},
           kaustik.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), ..., float, 10 ** 400]


def cases():
    for family, types in kaustik.types.items():
        if family == "tonemap":
            continue
        for name, table in types.items():
            for parameter in [*table, "id", "type", "nothing", "bsdf", 3]:
                for value in hostile:
                    yield name, parameter, value


def test_hostile_values():
    every = list(cases())
    count = len(every) if os.environ.get("KAUSTIK_THOROUGH") else 1500
    refused = 0
    for name, parameter, value in random.Random(7).sample(every, count):
        try:
            kaustik.load_dict(square_under_sky(victim={"type": name, parameter: value}))
        except kaustik.Error as error:
            refused += 1
            assert error.problems and all(problem.message for problem in error.problems)
            assert error.file or "cannot read" in error.message, (name, parameter, value, str(error))
        except Exception as error:
            raise AssertionError((name, parameter, value)) from error
    assert refused > count / 2


def test_hostile_edits(scene):
    keys = list(scene.parameters)
    generator = random.Random(8)
    for _ in range(200):
        key, value = generator.choice(keys), generator.choice(hostile)
        try:
            scene.edit({key: value})
        except kaustik.Error as error:
            assert error.file, (key, value, str(error))
        except Exception as error:
            raise AssertionError((key, value)) from error


def test_scenes_that_nest_deep():
    deep = {"type": "diffuse"}
    for _ in range(100):
        deep = {"type": "twosided", "bsdf": deep}
    try:
        kaustik.load_dict(square_under_sky(deep=deep))
    except kaustik.Error as error:
        assert error.file
    for _ in range(100000):
        deep = {"type": "twosided", "bsdf": deep}
    try:
        kaustik.load_dict(square_under_sky(deep=deep))
        raise AssertionError("was taken")
    except kaustik.Error as error:
        assert "deep" in error.message
    while "bsdf" in deep:  # taken apart, since Python would do so by recursion
        deep = deep.pop("bsdf")
