// Views of what a program renders: they show its film, and render nothing themselves.

#include <atomic>
#include <mutex>

#include "kaustik/live/watched_jobs.h"
#include "kaustik/render/film.h"
#include "tests/view/shown_scene.h"

namespace kaustik::test {
namespace {

using nlohmann::json;

/// A program's job, and a view of it.
class SessionOfProgram {
 public:
  SessionOfProgram()
      : watched_(std::make_shared<WatchedJobs>()),
        shown_({watched_,
                {[this] { note("pause "); }, [this] { note("resume "); }, [this] { note("stop "); },
                 [this](const RegionRequest& request) { return refine(request); }}}) {}

  /// Another job, to its end.
  const Job& render() {
    JobSettings settings;
    settings.session = shown_session();
    JobListener listener;
    listener.progress = [this](const Progress& progress) {
      const std::lock_guard lock(mutex_);
      progress_ = progress;
    };
    job_ = std::make_shared<Job>(shown_scene(), std::move(settings), std::move(listener));
    has_ended_ = false;
    const uint64_t revision = watched_->show(job_, [this] {
      const std::lock_guard lock(mutex_);
      JobCourse course;
      course.progress = progress_;
      course.has_ended = has_ended_;
      return course;
    });
    shown_.server().session_renders(revision, shown_scene());
    job_->run();
    has_ended_ = true;
    return *job_;
  }
  ShownScene& shown() { return shown_; }
  std::string did() const {
    const std::lock_guard lock(mutex_);
    return did_;
  }

 private:
  /// From the server's thread.
  void note(const char* what) {
    const std::lock_guard lock(mutex_);
    did_ += what;
  }

  bool refine(const RegionRequest& request) {
    note("refine ");
    return request.passes < 10;
  }

  std::atomic<bool> has_ended_ = false;
  mutable std::mutex mutex_;
  std::string did_;
  Progress progress_;
  std::shared_ptr<Job> job_;
  std::shared_ptr<WatchedJobs> watched_;
  ShownScene shown_;
};

TEST(ViewSessions, ShowTheFilmOfTheSession) {
  SessionOfProgram program;
  ShownScene& shown = program.shown();
  EXPECT_EQ(shown.get("/state")["state"], "idle");
  const Job& job = program.render();
  json state = shown.get("/state");
  EXPECT_EQ(state["state"], "finished");
  EXPECT_EQ(state["passes"], 4);
  EXPECT_EQ(state["revision"], 1);
  EXPECT_EQ(state["integrator"], "path");
  // Nothing else has rendered it.
  EXPECT_EQ(shown.server().engine().status().revision, 0u);
  const json pixel = shown.get("/pixel?x=7&y=5");
  const size_t place = size_t(5) * size_t(shown_width) + 7;
  EXPECT_EQ(pixel["value"][1].get<float>(), float(job.film().total(place, 1) / 4));
  // The last picture comes soon.
  std::string after = "0";
  ClientResponse frame;
  do {
    frame = shown.ask("GET", "/frame?format=f32&after=" + after);
    ASSERT_EQ(frame.status, 200);
    after = frame.header("x-number");
  } while (frame.header("x-passes") != "4");
  EXPECT_EQ(frame.header("x-kind"), "passes");
  program.render();
  EXPECT_EQ(shown.get("/state")["revision"], 2);
}

TEST(ViewSessions, WhoLooksChangesNothing) {
  SessionOfProgram program;
  program.render();
  ShownScene& shown = program.shown();
  const json camera = {{"origin", {1, 1, 1}}, {"target", {0, 0, 0}}, {"up", {0, 0, 1}}};
  for (const json& command :
       {json{{"set", {{"ball.radius", 0.5}}}}, json{{"camera", camera}},
        json{{"integrator", "vcm"}}, json{{"do", "start"}}, json{{"do", "reset"}}})
    EXPECT_EQ(shown.command(command).status, 409) << command;
  EXPECT_EQ(shown.command({{"do", "dance"}}).status, 400);
  EXPECT_TRUE(shown.get("/parameters")["objects"].empty());
  EXPECT_EQ(shown.get("/state")["passes"], 4);
  for (const char* what : {"pause", "resume", "stop"})
    EXPECT_EQ(shown.command({{"do", what}}).status, 200) << what;
  EXPECT_FALSE(shown.get("/state")["can_edit"].get<bool>());
  // Regions are the program's to render, or not.
  json region = {{"x", 0}, {"y", 0}, {"width", 4}, {"height", 4}, {"passes", 3}};
  EXPECT_EQ(shown.command({{"refine", region}}).status, 200);
  region["passes"] = 20;
  EXPECT_EQ(shown.command({{"refine", region}}).status, 409);
  EXPECT_EQ(program.did(), "pause resume stop refine refine ");
}

}  // namespace
}  // namespace kaustik::test
