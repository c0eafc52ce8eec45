"""Views in browsers: that they serve, to whom, and that they end."""

import json
import time
import urllib.error
import urllib.request

import pytest

import kaustik
from conftest import square_under_sky


def asked(view, path, cookie="", body=None):
    request = urllib.request.Request(f"http://127.0.0.1:{view.port}/{path}", data=body,
                                     headers={"Cookie": cookie, "Content-Type": "application/json"})
    return urllib.request.urlopen(request, timeout=10)


def cookie_of(view):
    answer = asked(view, "session", body=json.dumps({"token": view.url.partition("#")[2].split("=")[-1]}).encode())
    return answer.headers["Set-Cookie"].split(";")[0]


def test_serves_the_scene(scene):
    with kaustik.view(scene, integrator="path") as view:
        assert view.is_running and view.url.startswith(f"http://127.0.0.1:{view.port}/")
        assert b"<html" in asked(view, "").read().lower()
        with pytest.raises(urllib.error.HTTPError):
            asked(view, "state")  # a stranger
        cookie = cookie_of(view)
        until = time.monotonic() + 20
        while json.load(asked(view, "state", cookie))["passes"] < 1:
            assert time.monotonic() < until
            time.sleep(0.05)
        assert view.url in repr(view) and "href" in view._repr_html_()
    assert not view.is_running and view._repr_html_() is None and "stopped" in repr(view)
    with pytest.raises(OSError):
        asked(view, "")
    view.stop()


def test_of_files_and_sessions(scene_file):
    with kaustik.view(scene_file) as view:
        assert json.load(asked(view, "state", cookie_of(view)))["scene"] == "scene"
    session = kaustik.Session(kaustik.load_file(scene_file), integrator={"type": "path", "max_depth": 2})
    with session.view() as view:
        assert view.is_running
    assert not session.is_running


def test_a_view_may_go(scene):
    view = kaustik.view(scene)
    port = view.port
    del view
    with kaustik.view(scene, port=port) as again:  # the port is free
        assert again.port == port
        with pytest.raises(kaustik.Error):
            kaustik.view(scene, port=port)


def test_what_is_no_view(scene, tmp_path):
    for more, what in (({"port": -1}, "port"), ({"port": 70000}, "port"), ({"threads": -1}, "threads"),
                       ({"output": tmp_path / "nowhere"}, "output"), ({"integrator": "pth"}, "integrator")):
        with pytest.raises(kaustik.Error, match=what):
            kaustik.view(scene, **more)
    with pytest.raises(kaustik.Error, match="scene"):
        kaustik.View(square_under_sky())
