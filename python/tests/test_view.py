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


def test_of_files(scene_file):
    with kaustik.view(scene_file) as view:
        assert json.load(asked(view, "state", cookie_of(view)))["scene"] == "scene"


def state_when(view, cookie, fits):
    until = time.monotonic() + 20
    while not fits(state := json.load(asked(view, "state", cookie))):
        assert time.monotonic() < until, state
        time.sleep(0.02)
    return state


def refused(view, cookie, command):
    with pytest.raises(urllib.error.HTTPError) as caught:
        asked(view, "command", cookie, json.dumps(command).encode())
    return caught.value.code, json.load(caught.value)


def test_views_of_sessions_show_the_session(scene_file, tmp_path):
    """The film is the session's, to the bit; nothing else is rendered."""
    session = kaustik.Session(kaustik.load_file(scene_file), integrator={"type": "path", "max_depth": 2}, passes=3,
                              samples_per_pass=2)
    with session.view(output=tmp_path) as view:
        cookie = cookie_of(view)
        assert json.load(asked(view, "state", cookie))["state"] == "idle" and not session.is_running
        picture = session.run()
        state = state_when(view, cookie, lambda state: state["state"] == "finished")
        assert state["passes"] == 3 and state["integrator"] == "path" and state["revision"] == 1
        shown = json.load(asked(view, "pixel?x=5&y=7", cookie))
        estimate = picture.pixel(5, 7)
        assert shown["luminance"] == pytest.approx(estimate.value, rel=1e-6) and shown["passes"] == 3
        assert shown["standard_error"] == pytest.approx(estimate.standard_error, rel=1e-6)
        frame = asked(view, "frame?after=0&format=f32", cookie)
        while frame.headers["X-Passes"] != "3":  # the last one comes soon
            frame = asked(view, f"frame?after={frame.headers['X-Number']}&format=f32", cookie)
        assert frame.headers["X-Kind"] == "passes"
        assert frame.read() == memoryview(picture.array).cast("B")
        # It goes on, and is edited: the view follows.
        session.run(passes=5)
        assert state_when(view, cookie, lambda state: state["passes"] == 5)["revision"] == 2
        session.edit({"sky.radiance": 3})
        bright = session.run(passes=2)
        state_when(view, cookie, lambda state: state["passes"] == 2 and state["revision"] == 3)
        assert json.load(asked(view, "pixel?x=5&y=7", cookie))["luminance"] == pytest.approx(
            bright.pixel(5, 7).value, rel=1e-6)
        # Who looks changes nothing, but saves.
        for command in ({"set": {"sky.radiance": 1}}, {"integrator": "vcm"}, {"do": "start"}, {"do": "reset"},
                        {"camera": {"origin": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0]}}):
            code, answer = refused(view, cookie, command)
            assert code == 409 and "session" in answer["remedy"], command
        assert json.load(asked(view, "parameters", cookie))["objects"] == []
        asked(view, "command", cookie, b'{"save": {"name": "a.exr"}}')
        assert (tmp_path / "a.exr").exists()
    assert session.picture is not None and not session.is_running


def test_views_pause_and_stop_sessions(scene):
    with kaustik.Session(scene, integrator="path", passes=1 << 24, samples_per_pass=1) as session:
        view = session.start().view()
        cookie = cookie_of(view)
        first = state_when(view, cookie, lambda state: state["passes"] > 1)
        assert first["state"] == "rendering"
        assert first["can_edit"] is False
        asked(view, "command", cookie, b'{"refine": {"x": 4, "y": 2, "width": 8, "height": 6, "passes": 3}}')
        state_when(view, cookie, lambda state: state["regions"] and state["regions"][0]["passes"] == 3)
        asked(view, "command", cookie, b'{"do": "pause"}')
        assert session.is_paused and json.load(asked(view, "state", cookie))["state"] == "paused"
        asked(view, "command", cookie, b'{"do": "resume"}')
        state_when(view, cookie, lambda state: state["passes"] > first["passes"])
        asked(view, "command", cookie, b'{"do": "stop"}')
        session.wait(timeout=20)
        assert not session.is_running and session.film.regions == ((4, 2, 8, 6, 3),)
        code, _ = refused(view, cookie, {"refine": {"x": 4, "y": 2, "width": 8, "height": 6, "passes": 3}})
        assert code == 409
        # A view may go first, or last.
        del view
        session.start()
        last = session.view()
    assert state_when(last, cookie_of(last), lambda state: state["state"] == "finished")
    last.stop()


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
