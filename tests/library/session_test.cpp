// Sessions of hosts: bits, threads, callbacks, and whatever order things are called and destroyed
// in.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "rooms.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::library_test {
namespace {

using test::TemporaryFolder;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Until `condition` holds; false if that takes a minute.
template <typename Condition>
bool eventually(const Condition& condition) {
  for (int i = 0; i < 12000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(LibrarySession, HasTheBitsOfTheProgram) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("room.xml");
  for (const std::string integrator : {"auto", "photonmap", "path"}) {
    std::ofstream(scene) << room_text(integrator);
    const std::string theirs = folder.path("theirs.pfm"), ours = folder.path("ours.pfm");
    const std::string command = std::string(KAUSTIK_PROGRAM) + " render " + scene + " -o " +
                                theirs + " --passes 3 --spp 6 --seed 5 --quiet >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    SessionSettings settings;
    settings.passes = 3;
    settings.samples_per_pixel = 6;
    settings.seed = 5;
    rendered(Scene::load_file(scene), settings).write(ours);
    ASSERT_GT(bytes_of(ours).size(), 1000u);
    EXPECT_EQ(bytes_of(ours), bytes_of(theirs)) << integrator;
    settings.seed = 6;
    rendered(Scene::load_file(scene), settings).write(ours);
    EXPECT_NE(bytes_of(ours), bytes_of(theirs)) << integrator;
  }
}

TEST(LibrarySession, ThreadsMakeNoDifference) {
  const Scene scene = room("auto");
  EXPECT_EQ(values(rendered(scene, passes(3, 2, 1))), values(rendered(scene, passes(3, 2, 2))));
}

/// How many threads the program has.
int thread_count() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
    ++count;
  return count;
}

/// Exits with how many threads worked at a time, building included.
[[noreturn]] void count_threads(int threads) {
  const int before = thread_count();
  const Scene scene =
      Scene::load_file(KAUSTIK_SOURCE_DIR "/scenes/cornell_spheres/cornell_spheres.xml")
          .edit({{"film.width", 32}, {"film.height", 24}});
  Session session(scene, passes(1, 1, threads));
  session.start();
  int most = 0;
  while (session.is_running()) {
    most = std::max(most, thread_count());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  session.picture().tonemap();
  session.picture().mean();
  most = std::max(most, thread_count());
  std::_Exit(most - before);
}

TEST(LibrarySession, OneThreadIsOne) {
#ifdef KAUSTIK_SLOW_BUILD
  GTEST_SKIP() << "sanitizers have threads of their own";
#endif
  // In a program of its own: others leave workers behind.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(count_threads(1), testing::ExitedWithCode(1), "");
  if (std::thread::hardware_concurrency() > 1) {
    EXPECT_EXIT(count_threads(2), testing::ExitedWithCode(2), "");
  }
}

TEST(LibrarySession, TwoAtOnceHaveTheBitsThatTheyHaveAlone) {
  const Scene one = room("auto"), other = room("photonmap");
  const auto first = values(rendered(one, passes(3))), second = values(rendered(other, passes(3)));
  Session a(one, passes(3)), b(other, passes(3)), c(one, passes(3));
  a.start();
  b.start();
  c.start();
  EXPECT_EQ(b.wait().end, End::passes);
  EXPECT_EQ(a.wait().passes, 3u);
  EXPECT_EQ(c.wait().integrator, "auto");
  EXPECT_EQ(values(a.picture()), first);
  EXPECT_EQ(values(b.picture()), second);
  EXPECT_EQ(values(c.picture()), first);
}

TEST(LibrarySession, TellsOfItsProgress) {
  std::vector<Progress> told;
  std::vector<uint32_t> done;
  std::vector<std::string> messages;
  Callbacks callbacks;
  callbacks.progress = [&](const Progress& p) { told.push_back(p); };
  callbacks.pass_done = [&](uint32_t count) { done.push_back(count); };
  callbacks.message = [&](Severity, const std::string& text) { messages.push_back(text); };
  SessionSettings settings = passes(3);
  settings.integrator = "path";
  // What the scene says of photons is of no use to paths, which is told.
  Object integrator("integrator", "photonmap");
  integrator.set("caustic_photons", 4000);
  std::vector<Object> objects = room_objects("photonmap");
  objects[0] = integrator;
  Session session(Scene(objects), settings, callbacks);
  EXPECT_EQ(session.progress().stage, Stage::idle);
  EXPECT_FALSE(session.is_running());
  EXPECT_EQ(session.snapshot(), std::nullopt);
  const Outcome outcome = session.run();
  EXPECT_EQ(done, (std::vector<uint32_t>{1, 2, 3}));
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().fraction, 1);
  EXPECT_EQ(told.back().passes_done, 3u);
  EXPECT_EQ(told.back().passes_total, 3u);
  EXPECT_TRUE(told.back().has_picture);
  EXPECT_EQ(session.progress().samples_per_pixel, 6u);
  EXPECT_EQ(session.progress().stage, Stage::idle);
  EXPECT_EQ(outcome.samples_per_pass, 2u);
  EXPECT_GT(outcome.rays, 100u);
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find("caustic_photons"), std::string::npos);
}

/// What a host throws, wherever, ends the session and comes out of wait().
TEST(LibrarySession, CallbacksMayThrow) {
  struct OfTheHost {
    int number;
  };
  for (const int place : {0, 1, 2}) {
    Callbacks callbacks;
    if (place == 0) callbacks.progress = [](const Progress&) { throw OfTheHost{7}; };
    if (place == 1)
      callbacks.pass_done = [](uint32_t count) {
        if (count == 2) throw std::runtime_error("enough");
      };
    if (place == 2) callbacks.message = [](Severity, const std::string&) { throw OfTheHost{8}; };
    Session session(place == 2 ? room("auto").edit("ball.radius", 0.5) : room("path"), passes(4),
                    callbacks);
    session.start();
    try {
      session.wait();
      EXPECT_EQ(place, 2) << "there may be no message";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::callback);
      ASSERT_NE(error.cause(), nullptr);
      if (place == 1) {
        EXPECT_NE(std::string(error.what()).find("enough"), std::string::npos);
        EXPECT_THROW(std::rethrow_exception(error.cause()), std::runtime_error);
        EXPECT_EQ(session.picture().passes(), 2u);
        EXPECT_EQ(values(session.picture()), values(rendered(room("path"), passes(2))));
      } else {
        EXPECT_THROW(std::rethrow_exception(error.cause()), OfTheHost);
      }
      EXPECT_THROW(session.wait(), Error) << "again";
    }
  }
}

TEST(LibrarySession, WhatIsWrongWithTheSceneComesOutOfWait) {
  Session session(room("path").edit("ball.radius", -1), passes(1));
  session.start();
  EXPECT_EQ(error_of([&] { session.wait(); }).kind(), ErrorKind::input);
  EXPECT_THROW(session.picture(), Error);
  EXPECT_FALSE(session.is_running());
  session.edit(room("path"));
  EXPECT_EQ(session.wait().passes, 1u);
}

TEST(LibrarySession, StopKeepsWhatIsFinished) {
  Session session(room("path"), endless());
  session.stop();  // there is nothing to stop yet
  session.start();
  ASSERT_TRUE(eventually([&] { return session.progress().passes_done >= 2; }));
  const std::optional<Picture> so_far = session.snapshot(true);
  ASSERT_TRUE(so_far);
  EXPECT_GE(so_far->passes(), 2u);
  EXPECT_GT(so_far->pixel(12, 10).standard_error, 0);
  EXPECT_THROW(session.picture(), Error);
  session.stop();
  session.stop();
  const Outcome outcome = session.wait();
  EXPECT_EQ(outcome.end, End::stopped);
  EXPECT_EQ(session.wait().passes, outcome.passes) << "again";
  const Picture picture = session.picture();
  EXPECT_EQ(picture.passes(), outcome.passes);
  EXPECT_EQ(values(picture), values(rendered(room("path"), passes(outcome.passes))));
}

TEST(LibrarySession, PauseHoldsAndKeepsTheBits) {
  const Scene scene = room("path");
  std::atomic<uint32_t> done = 0;
  Session* running = nullptr;
  Callbacks callbacks;
  callbacks.pass_done = [&](uint32_t count) {
    done = count;
    if (count == 2) running->pause();
  };
  Session session(scene, passes(4), callbacks);
  running = &session;
  session.start();
  ASSERT_TRUE(eventually([&] { return session.is_paused(); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(done, 2u);
  EXPECT_TRUE(session.is_running());
  EXPECT_EQ(session.snapshot()->passes(), 2u);
  session.resume();
  EXPECT_EQ(session.wait().passes, 4u);
  EXPECT_EQ(values(session.picture()), values(rendered(scene, passes(4))));
}

TEST(LibrarySession, AnEditTakesThePlaceOfTheScene) {
  Session session(room("path"), passes(2));
  session.edit(half_sky(6, 5));  // before it is started
  session.start();
  session.wait();
  EXPECT_EQ(session.picture().width(), 6);
  session.edit(room("path", 12, 10));  // after it has ended: it renders again
  EXPECT_EQ(session.wait().passes, 2u);
  EXPECT_EQ(values(session.picture()), values(rendered(room("path", 12, 10), passes(2))));
  Session running(room("path"), endless());
  running.start();
  ASSERT_TRUE(eventually([&] { return running.progress().passes_done >= 1; }));
  for (const double radius : {0.5, 0.4, 0.3})
    running.edit(room("path").edit("ball.radius", radius));
  EXPECT_TRUE(running.is_running());
  running.stop();
  running.wait();
}

TEST(LibrarySession, GoesOnFromAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.path("passes.kpt");
  const Scene scene = room("auto");
  SessionSettings settings = passes(2);
  settings.seed = 3;
  Session lazy(scene, settings);
  lazy.run();
  EXPECT_EQ(error_of([&] { lazy.save(path); }).kind(), ErrorKind::misuse);
  settings.keeps_passes = true;
  Session first(scene, settings);
  EXPECT_THROW(first.save(path), Error);
  first.run();
  first.save(path);
  settings.passes = 5;
  SessionSettings further;
  further.passes = 5;
  further.threads = 1;
  Session second = Session::load(path, scene, further);
  EXPECT_EQ(second.run().passes, 5u);
  EXPECT_EQ(values(second.picture()), values(rendered(scene, settings)));
  // Another scene has others.
  Session wrong = Session::load(path, scene.edit("lamp.radiance", 8), further);
  EXPECT_NE(std::string(error_of([&] { wrong.run(); }).what()).find(path), std::string::npos);
  further.seed = 4;
  EXPECT_THROW(Session::load(path, scene, further), Error);
  std::ofstream(path) << "no passes";
  EXPECT_THROW(Session::load(path, scene), Error);
  EXPECT_THROW(Session::load(folder.path("none.kpt"), scene), Error);
}

TEST(LibrarySession, KeepsACheckpoint) {
  const TemporaryFolder folder;
  SessionSettings settings = passes(2);
  settings.checkpoint = folder.path("kept.kpt");
  Session session(room("path"), settings);
  session.run();
  EXPECT_EQ(error_of([&] { session.edit(room("path")); }).kind(), ErrorKind::misuse);
  Session more = Session::load(settings.checkpoint, room("path"));
  EXPECT_EQ(more.run().passes, 2u) << "it is as far as it was told to go";
  // What cannot be written is told, and the picture is there.
  settings.checkpoint = folder.path("no folder/kept.kpt");
  Session lost(room("path"), settings);
  EXPECT_THROW(lost.run(), Error);
  EXPECT_EQ(lost.picture().passes(), 2u);
}

TEST(LibrarySession, MisuseIsTold) {
  const auto is_misuse = [](const auto& body) {
    return error_of(body).kind() == ErrorKind::misuse;
  };
  Session session(room("path"), passes(1));
  EXPECT_TRUE(is_misuse([&] { session.wait(); }));
  EXPECT_TRUE(is_misuse([&] { session.picture(); }));
  session.start();
  EXPECT_TRUE(is_misuse([&] { session.start(); }));
  session.wait();
  EXPECT_TRUE(is_misuse([&] { session.run(); }));
  Session moved = std::move(session);
  EXPECT_EQ(moved.wait().passes, 1u);
  EXPECT_TRUE(is_misuse([&] { session.progress(); }));
  session.stop();
  EXPECT_FALSE(session.is_running());
  for (const auto change : std::initializer_list<void (*)(SessionSettings&)>{
           [](SessionSettings& s) { s.threads = -1; }, [](SessionSettings& s) { s.seconds = -1; },
           [](SessionSettings& s) { s.error = std::nan(""); },
           [](SessionSettings& s) { s.passes = UINT32_MAX; }}) {
    SessionSettings settings;
    change(settings);
    EXPECT_EQ(error_of([&] { Session(room("path"), settings); }).kind(), ErrorKind::input);
  }
}

TEST(LibrarySession, OneThreadAtATimeOwnsIt) {
  Session session(room("path"), endless());
  session.start();
  std::atomic<bool> waits = false;
  std::thread other([&] {
    waits = true;
    EXPECT_EQ(session.wait().end, End::stopped);
  });
  ASSERT_TRUE(eventually([&] { return waits && session.progress().passes_done > 0; }));
  EXPECT_TRUE(eventually([&] {
    try {
      session.save("nowhere.kpt");
    } catch (const Error& error) {
      return std::string(error.what()).find("another thread") != std::string::npos;
    }
    return false;
  }));
  session.stop();
  other.join();
}

TEST(LibrarySession, CallbacksMayLookAndStopButNotWait) {
  std::vector<ErrorKind> kinds;
  Session* running = nullptr;
  Callbacks callbacks;
  callbacks.pass_done = [&](uint32_t) {
    for (const auto forbidden : std::initializer_list<void (*)(Session&)>{
             [](Session& s) { s.wait(); }, [](Session& s) { s.edit(room("path")); },
             [](Session& s) { s.picture(); }, [](Session& s) { s.save("nowhere.kpt"); },
             [](Session& s) { s.start(); }})
      kinds.push_back(error_of([&] { forbidden(*running); }).kind());
    EXPECT_TRUE(running->snapshot(true));
    EXPECT_NE(running->progress().stage, Stage::idle);
    running->stop();
  };
  Session session(room("auto"), endless(), callbacks);
  running = &session;
  session.start();
  EXPECT_EQ(session.wait().end, End::stopped);
  EXPECT_EQ(kinds, std::vector<ErrorKind>(kinds.size(), ErrorKind::misuse));
  EXPECT_GE(kinds.size(), 5u);
}

TEST(LibrarySession, ThingsAreDestroyedInAnyOrder) {
  std::optional<Picture> picture, snapshot;
  std::vector<float> expected;
  {
    auto scene = std::make_unique<Scene>(room("path"));
    auto session = std::make_unique<Session>(*scene, passes(2));
    scene.reset();
    session->run();
    picture = session->picture();
    snapshot = session->snapshot(true);
    expected = values(*picture);
  }
  EXPECT_EQ(values(*picture), expected);
  EXPECT_EQ(picture->pixel(3, 4).value, snapshot->pixel(3, 4).value);
  const std::span<const float> plane = Picture(*picture).plane("R");
  EXPECT_EQ(plane[5], expected[5]) << "a copy is gone, the pixels are not";
  // Not started; running; paused; being built.
  { Session unused(room("path")); }
  {
    Session running(room("auto"), endless());
    running.start();
    ASSERT_TRUE(eventually([&] { return running.progress().passes_done > 0; }));
  }
  {
    Session paused(room("path"), endless());
    paused.pause();
    paused.start();
  }
  {
    Session a(room("path"), endless()), b(room("path"), endless());
    a.start();
    b.start();
    a = std::move(b);
    EXPECT_TRUE(a.is_running());
    b = Session(room("path"), passes(1));
    EXPECT_EQ(b.run().passes, 1u);
  }
}

TEST(LibrarySession, ACallbackMayDestroyItsSession) {
  for (const bool in_this_thread : {false, true}) {
    const auto alive = std::make_shared<int>(0);
    std::optional<Session> session;
    Callbacks callbacks;
    std::atomic<bool> is_gone = false;
    callbacks.pass_done = [&, alive](uint32_t) {
      session.reset();
      is_gone = true;
    };
    session.emplace(room("path"), endless(), std::move(callbacks));
    if (in_this_thread)
      EXPECT_EQ(session->run().end, End::stopped);
    else
      session->start();
    EXPECT_TRUE(eventually([&] { return bool(is_gone); }));
    EXPECT_TRUE(eventually([&] { return alive.use_count() == 1; })) << "its thread has ended";
  }
}

TEST(LibrarySession, AFirstLookIsNoPictureYet) {
  SessionSettings settings = passes(1, 1u << 20);
  settings.previews = true;
  Session session(room("auto", 64, 48), settings);
  session.start();
  ASSERT_TRUE(eventually([&] { return session.snapshot().has_value(); }));
  const Picture look = session.snapshot().value();
  EXPECT_TRUE(look.is_incomplete());
  EXPECT_EQ(look.passes(), 0u);
  EXPECT_EQ(look.width(), 64);
  session.stop();
  session.wait();
}

TEST(LibrarySession, TakesTheCameraThatItIsTold) {
  std::vector<Object> objects = room_objects("path");
  Object second("sensor", "perspective", "second");
  second.set("to_world", Transform::look_at({0, -3, 1}, {0, 0, 0}, {0, 0, 1})).add(film(10, 6));
  objects.push_back(second);
  SessionSettings settings = passes(1, 1);
  EXPECT_EQ(rendered(Scene(objects), settings).width(), 24);
  settings.camera = "second";
  EXPECT_EQ(rendered(Scene(objects), settings).width(), 10);
  settings.camera = "third";
  EXPECT_THROW(rendered(Scene(objects), settings), Error);
}

TEST(LibrarySession, TimeEndsIt) {
  SessionSettings settings;
  settings.seconds = 0.2;
  settings.integrator = "path";
  Session session(room("path", 8, 8), settings);
  EXPECT_EQ(session.run().end, End::time);
  EXPECT_EQ(session.picture().width(), 8);
}

TEST(LibraryVersion, IsThatOfTheHeaders) {
  EXPECT_STREQ(version(), header_version);
  EXPECT_EQ(std::string(version()), std::to_string(header_version_major) + "." +
                                        std::to_string(header_version_minor) + "." +
                                        std::to_string(header_version_patch));
}

}  // namespace
}  // namespace kaustik::library_test
