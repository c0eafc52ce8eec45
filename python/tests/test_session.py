"""Sessions: their course, Ctrl-C, threads, progress."""

import gc
import io
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import kaustik
from conftest import square_under_sky

#: Of renders that somebody stops.
long = {"integrator": "path", "passes": 100000, "samples_per_pass": 1}


def wait_for(condition, seconds=20):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "waited in vain"
        time.sleep(0.01)


def test_course(scene):
    with kaustik.Session(scene, **long) as session:
        assert session.picture is None and session.progress is None and not session.is_running
        session.start()
        wait_for(lambda: session.progress and session.progress.passes > 2)
        assert session.is_running and session.snapshot().shape == (12, 16, 3)
        session.pause()
        assert session.is_paused
        passes = session.progress.passes
        time.sleep(0.2)
        assert session.progress.passes <= passes + 2
        assert session.wait(0.1) is False
        session.resume()
        wait_for(lambda: session.progress.passes > passes + 2)
        with pytest.raises(kaustik.Error, match="runs"):
            session.film
        picture = session.stop()
        assert len(picture.film.passes) > passes and not session.is_running
        assert picture.report["end"] == "cancelled"


def test_regions_get_more_samples(scene, tmp_path, numpy):
    settings = {"integrator": "auto", "samples_per_pass": 2, "seed": 5}
    session = kaustik.Session(scene, **settings)
    with pytest.raises(kaustik.Error, match="no pass"):
        session.refine(4, 2, 8, 6)
    plain = session.run(passes=4)
    session.refine(4, 2, 8, 6, passes=3)
    session.refine(4, 2, 8, 6, passes=2)
    assert session.film.regions == ((4, 2, 8, 6, 5),) and session.film.passes == (0, 1, 2, 3)
    refined = session.picture
    changed = (numpy.asarray(refined) != numpy.asarray(plain)).any(axis=2)
    assert changed[2:8, 4:12].any() and not changed[:2].any() and not changed[:, 12:].any()
    errors = [numpy.asarray(picture.error)[3:7, 5:11].mean() for picture in (plain, refined)]
    assert 0 < errors[1] < errors[0]
    assert refined.metadata["regions"] == "8 x 6 pixels at (4, 2): 5 passes"
    # At once, and going on from a file.
    again = kaustik.Session(scene, **settings)
    again.run(passes=4)
    again.refine(4, 2, 8, 6, passes=5)
    assert again.film == session.film
    session.save(tmp_path / "a.kpt")
    loaded = kaustik.Session.load(tmp_path / "a.kpt", scene, integrator="auto")
    loaded.run(passes=6)
    assert loaded.film.regions == ((4, 2, 8, 6, 5),) and loaded.film.passes == tuple(range(6))
    for bad in [(0, 0, 17, 1, 1), (-1, 0, 1, 1, 1), (0, 0, 1, 1, 0), (0, 0, 1, 1, 5000), (0, 0, 1.5, 1, 1)]:
        with pytest.raises(kaustik.Error):
            session.refine(*bad)
    assert session.film.regions == ((4, 2, 8, 6, 5),), "a refused one harms nothing"
    assert session.picture is not None
    with pytest.raises(kaustik.Error, match="given before"):
        session.film + kaustik_film_of_other_passes(scene, settings)


def kaustik_film_of_other_passes(scene, settings):
    """Passes 4 and 5, and the regional passes that the other film has, too."""
    other = kaustik.Session(scene, first_pass=4, passes=2, **settings)
    other.run()
    other.refine(4, 2, 8, 6, passes=16)
    return other.film


def test_regions_of_a_running_session(scene):
    with kaustik.Session(scene, **long).start() as session:
        session.refine(4, 2, 8, 6, passes=7)  # at once
        with pytest.raises(kaustik.Error, match="does not lie in"):
            session.refine(10, 2, 8, 6)
        wait_for(lambda: session._job.regions() == [[4, 2, 8, 6, 7, 0]])
        session.stop()
        assert session.film.regions == ((4, 2, 8, 6, 7),)


def test_regions_that_wait_at_the_end_are_not_lost(scene):
    session = kaustik.Session(scene, **long).start()
    wait_for(lambda: session.progress and session.progress.passes > 0)
    session.pause()
    session.refine(4, 2, 8, 6, passes=7)
    session.stop()
    left = 7 - sum(region[4] for region in session.film.regions)
    assert left > 0, "the pause came too late"
    session.start()
    wait_for(lambda: session._job.regions() and session._job.regions()[0][5] == 0)
    session.stop()
    assert session.film.regions == ((4, 2, 8, 6, 7),)


def test_stopped_while_it_is_paused(scene):
    session = kaustik.Session(scene, **long).start()
    wait_for(lambda: session.progress and session.progress.passes > 0)
    session.pause()
    assert session.stop() is not None


def test_goes_on_with_the_same_bits(scene_file, tmp_path):
    scene = kaustik.load_file(scene_file)
    settings = {"integrator": "auto", "samples_per_pass": 2, "seed": 5}
    session = kaustik.Session(scene, **settings)
    assert session.run(passes=3).film.passes == (0, 1, 2)
    whole = kaustik.render(scene, passes=6, **settings).film
    assert session.run(passes=6).film == whole
    # The same from a file, with the scene that it names, and with one that is given.
    session = kaustik.Session(scene, **settings)
    session.run(passes=3)
    session.save(tmp_path / "some.kpt")
    for given in (None, scene):
        again = kaustik.Session.load(tmp_path / "some.kpt", given)
        assert again.picture.film.passes == (0, 1, 2)
        assert again.run(passes=6).film == whole
    with pytest.raises(kaustik.Error, match="not what it was"):
        kaustik.Session.load(tmp_path / "some.kpt", scene.edit({"sky.radiance": 3})).run(passes=6)


def test_the_command_line_goes_on_with_it(scene_file, program, tmp_path):
    scene = kaustik.load_file(scene_file)
    session = kaustik.Session(scene, integrator="path", samples_per_pass=2)
    session.run(passes=2)
    session.save(tmp_path / "some.kpt")
    subprocess.run([program, "resume", tmp_path / "some.kpt", "--passes", "4", "-q", "-o", tmp_path / "a.exr"],
                   check=True)
    assert kaustik.Film.load(tmp_path / "some.kpt") == session.run(passes=4).film


def test_edits(scene):
    session = kaustik.Session(scene, **long).start()
    wait_for(lambda: session.progress and session.progress.passes > 0)
    with pytest.raises(kaustik.Error, match="sky.radiance"):
        session.edit({"sky.radiance": "bright"})
    assert session.is_running  # as it was
    session.edit({"sky.radiance": 3})
    assert session.is_running and session.scene.parameters["sky.radiance"] == 3
    wait_for(lambda: session.progress and session.progress.passes > 0)
    assert session.stop().mean().value > 1
    session.edit({"sky.radiance": 1})
    assert not session.is_running and session.picture is None
    assert session.start().is_running
    session.stop()


def test_errors_come_with_wait(scene):
    session = kaustik.Session(scene, integrator="nothing").start()
    with pytest.raises(kaustik.Error, match="nothing"):
        session.wait()
    assert session.picture is None
    with pytest.raises(kaustik.Error, match="not started"):
        kaustik.Session(scene).wait()


def test_the_scene_may_go_while_its_session_runs():
    session = kaustik.Session(kaustik.load_dict(square_under_sky(
        lens=kaustik.Mesh([[0, 0, .1], [1, 0, .1], [0, 1, .1]], [[0, 1, 2]]))), **long)
    session.start()
    session._scene = None
    gc.collect()
    wait_for(lambda: session.progress and session.progress.passes > 1)
    assert session.stop() is not None


def test_a_session_may_go_while_it_runs(scene):
    session = kaustik.Session(scene, **long).start()
    wait_for(lambda: session.progress)
    del session
    gc.collect()


def test_many_sessions_at_once(scene):
    alone = kaustik.render(scene, integrator="path", passes=4, samples_per_pass=2).film
    sessions = [kaustik.Session(scene, integrator="path", passes=4, samples_per_pass=2).start() for _ in range(4)]
    for session in sessions:
        assert session.wait() and session.film == alone


def test_other_threads_run_meanwhile(scene):
    """The GIL is free: a thread counts while another renders."""
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    kaustik.render(scene, integrator="path", time=0.5)
    done.set()
    thread.join()
    assert counted[0] > 50


def test_renders_in_a_thread(scene):
    found = []
    thread = threading.Thread(target=lambda: found.append(kaustik.render(scene, integrator="path", passes=1)))
    thread.start()
    thread.join()
    assert found[0].shape == (12, 16, 3)


def test_progress_is_called_in_this_thread(scene):
    seen = []
    kaustik.render(scene, integrator="path", time=0.4,
                   progress=lambda now: seen.append((threading.get_ident(), now.fraction)))
    assert seen and {thread for thread, _ in seen} == {threading.get_ident()}
    assert all(0 <= fraction <= 1 for _, fraction in seen)


def test_what_progress_raises_ends_the_render(scene):
    class Enough(Exception):
        pass

    def enough(_):
        raise Enough

    session = kaustik.Session(scene, progress=enough, **long)
    with pytest.raises(Enough):
        session.run()
    assert not session.is_running


def test_progress_on_terminals(scene, monkeypatch, capsys):
    kaustik.render(scene, integrator="path", passes=2)
    assert capsys.readouterr() == ("", "")  # no terminal

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    kaustik.render(scene, integrator="path", passes=2)
    assert "2/2 passes" in terminal.getvalue() and terminal.getvalue().endswith("\n")
    shown = terminal.getvalue()
    kaustik.render(scene, integrator="path", passes=2, progress=False)
    assert terminal.getvalue() == shown


def run_python(text, **more):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*sys.path, os.path.dirname(__file__)])}
    return subprocess.Popen([sys.executable, "-c", textwrap.dedent(text)], env=environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)


def test_ctrl_c_keeps_what_is_finished():
    process = run_python("""
        import signal, kaustik
        from conftest import square_under_sky
        # Tests that run in the background may have inherited that it is ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        session = kaustik.Session(kaustik.load_dict(square_under_sky()), integrator="path", passes=100000,
                                  samples_per_pass=1, progress=lambda now: print(now.passes, flush=True))
        try:
            session.run()
        except KeyboardInterrupt:
            print("kept", len(session.picture.film.passes), flush=True)
        try:
            kaustik.render(session.scene, integrator="path", passes=100000, samples_per_pass=1,
                           progress=lambda now: print(now.passes, flush=True))
        except KeyboardInterrupt as interrupted:
            print("kept", len(interrupted.picture.film.passes), flush=True)
        """)
    for _ in range(2):
        for line in process.stdout:
            if int(line) > 3:
                break
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        for line in process.stdout:
            if line.startswith("kept"):
                break
        assert int(line.split()[1]) > 3
        assert time.monotonic() - begin < 5
    assert process.wait(20) == 0, process.stderr.read()


def test_fork_after_threads_is_told():
    process = run_python("""
        import os, sys, kaustik
        from conftest import square_under_sky
        scene = kaustik.load_dict(square_under_sky())
        session = kaustik.Session(scene, integrator="path", passes=1, samples_per_pass=1)
        session.run()
        child = os.fork()
        if child == 0:
            try:
                kaustik.render(scene, integrator="path", passes=1)
            except kaustik.Error as error:
                del session
                os._exit(7 if "spawn" in error.remedy else 8)
            os._exit(9)
        sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        """)
    assert process.wait(30) == 7, process.stderr.read()


def test_fork_before_threads_works():
    process = run_python("""
        import os, sys, kaustik
        from conftest import square_under_sky
        child = os.fork()
        if child == 0:
            kaustik.render(kaustik.load_dict(square_under_sky()), integrator="path", passes=1)
            os._exit(7)
        sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        """)
    assert process.wait(30) == 7, process.stderr.read()


def test_exit_while_a_session_runs():
    process = run_python("""
        import kaustik
        from conftest import square_under_sky
        session = kaustik.Session(kaustik.load_dict(square_under_sky()), integrator="path", passes=100000).start()
        """)
    assert process.wait(30) == 0, process.stderr.read()


def test_processes_make_the_same_bits():
    example = os.path.join(os.path.dirname(__file__), "..", "examples", "processes.py")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    told = subprocess.run([sys.executable, example], env=environment, text=True, capture_output=True, timeout=60)
    assert told.returncode == 0, told.stderr
    assert "the same bits: True" in told.stdout
