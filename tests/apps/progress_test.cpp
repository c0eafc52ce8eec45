// Progress for programs: lines of JSON on standard error, in a file, on a descriptor; read by a
// parser that is not the program's.

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

using Event = nlohmann::json;

/// Every line is an object; fails for what is none.
std::vector<Event> events_of(const std::string& text) {
  std::vector<Event> events;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const Event event = Event::parse(line, nullptr, false);
    EXPECT_TRUE(event.is_object() && event.contains("event")) << line;
    if (event.is_object() && event.contains("event")) events.push_back(event);
  }
  return events;
}

std::vector<Event> of_kind(const std::vector<Event>& events, const std::string& kind) {
  std::vector<Event> chosen;
  for (const Event& event : events)
    if (event["event"] == kind) chosen.push_back(event);
  return chosen;
}

class ProgressEvents : public ProgramTest {
 protected:
  ProgressEvents() { write("scene.xml", small_scene()); }
  RunResult render(const std::vector<std::string>& more, RunOptions how = {}) const {
    std::vector<std::string> words = {"render", "scene.xml", "-o", "a.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, std::move(how));
  }
};

TEST_F(ProgressEvents, OnStandardErrorAreAllThatIsThere) {
  const RunResult result =
      render({"--passes", "3", "--spp", "12", "-o", "b.png", "--progress", "json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<Event> events = events_of(result.err);
  ASSERT_GE(events.size(), 5u);
  const Event& start = events.front();
  EXPECT_EQ(start["event"], "start");
  EXPECT_EQ(start["command"], "render");
  EXPECT_EQ(start["scene"], "scene.xml");
  EXPECT_TRUE(start["version"].is_string());
  const auto progress = of_kind(events, "progress");
  ASSERT_FALSE(progress.empty());
  const Event& last = progress.back();
  EXPECT_EQ(last["pass"], 3);
  EXPECT_EQ(last["passes"], 3);
  EXPECT_EQ(last["samples_per_pixel"], 12);
  EXPECT_EQ(last["fraction"], 1);
  EXPECT_EQ(last["remaining_s"], 0);
  EXPECT_GT(last["error"].get<double>(), 0);
  EXPECT_GT(last["elapsed_s"].get<double>(), 0);
  EXPECT_GT(last["memory_bytes"].get<double>(), 1e6);
  // Of less than two passes nothing is known.
  EXPECT_TRUE(progress.front()["pass"] != 0 || progress.front()["error"].is_null());
  const auto written = of_kind(events, "written");
  ASSERT_EQ(written.size(), 2u);
  EXPECT_EQ(written[0]["file"], "a.exr");
  EXPECT_EQ(written[1]["file"], "b.png");
  EXPECT_EQ(written[0]["state"], "finished");
  EXPECT_EQ(written[0]["passes"], 3);
  EXPECT_EQ(written[0]["width"], 24);
  const auto messages = of_kind(events, "message");
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages.front()["level"], "info");
  const Event& end = events.back();
  EXPECT_EQ(end["event"], "end");
  EXPECT_EQ(end["exit_code"], 0);
  EXPECT_EQ(end["reason"], "passes");
  EXPECT_EQ(end["integrator"], "path");
  EXPECT_EQ(end["passes"], 3);
}

TEST_F(ProgressEvents, TellWhichGoalWasReached) {
  const auto reason = [&](const std::vector<std::string>& limits) {
    std::vector<std::string> more = limits;
    more.insert(more.end(), {"--progress", "json", "-q"});
    const RunResult result = render(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return events_of(result.err).back()["reason"].get<std::string>();
  };
  EXPECT_EQ(reason({"--passes", "2", "--spp", "2"}), "passes");
  EXPECT_EQ(reason({"--spp", "4"}), "samples");
  EXPECT_EQ(reason({"--time", "0.3s"}), "time");
  EXPECT_EQ(reason({"--error", "400%", "--time", "60s"}), "error");
}

TEST_F(ProgressEvents, GoToAFileBesideWhatPeopleSee) {
  const RunResult plain = render({"--passes", "2", "--spp", "2", "--progress-file", "p.jsonl"});
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_TRUE(contains(plain.err, "100 %  pass 2/2")) << plain.err;
  EXPECT_TRUE(contains(plain.err, "wrote a.exr")) << plain.err;
  EXPECT_FALSE(contains(plain.err, "{\"")) << plain.err;
  const auto events = events_of(contents("p.jsonl"));
  ASSERT_GE(events.size(), 4u);
  EXPECT_TRUE(of_kind(events, "message").empty());
  // Its own kind is replaced; --progress json shows nothing else.
  const RunResult json =
      render({"--passes", "1", "--progress", "json", "--progress-file", "p.jsonl"});
  EXPECT_EQ(json.exit_code, 0) << json.err;
  EXPECT_FALSE(contains(json.err, "%  pass")) << json.err;
  EXPECT_TRUE(contains(json.err, "wrote a.exr")) << json.err;
  EXPECT_EQ(of_kind(events_of(contents("p.jsonl")), "start").size(), 1u);
}

TEST_F(ProgressEvents, GoToADescriptor) {
  RunOptions how;
  how.descriptor_3 = path("three.jsonl");
  const RunResult result = render({"--passes", "2", "-q", "--progress-file", "fd:3"}, how);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(events_of(contents("three.jsonl")).back()["event"], "end");
}

// Whatever name standard error has, nothing else goes between the lines.
TEST_F(ProgressEvents, AreNotMixedUpWithMessages) {
  for (const std::string target : {"fd:2", "/dev/stderr"}) {
    const RunResult result = render({"--passes", "2", "--progress-file", target});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(of_kind(events_of(result.err), "message").empty()) << target;
  }
  const RunResult both = render({"-o", "-", "--progress-file", "fd:1"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_TRUE(contains(both.err, "remedy: ")) << both.err;
}

TEST_F(ProgressEvents, EndWithWhatWentWrong) {
  const RunResult none = run({"render", "none.xml", "-o", "a.exr", "--progress", "json"});
  EXPECT_EQ(none.exit_code, 2);
  const auto events = events_of(none.err);
  ASSERT_EQ(of_kind(events, "message").size(), 1u);
  EXPECT_EQ(of_kind(events, "message")[0]["level"], "error");
  EXPECT_EQ(events.back()["reason"], "failed");
  EXPECT_EQ(events.back()["exit_code"], 2);
  EXPECT_TRUE(contains(events.back()["message"].get<std::string>(), "none.xml"));
  RunOptions stopped;
  stopped.interrupt_at = "\"pass\":[1-9]";
  stopped.signals = {SIGTERM};
  const RunResult result =
      render({"--passes", "1000000", "--spp", "1000000", "--progress", "json"}, stopped);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  const auto told = events_of(result.err);
  EXPECT_EQ(told.back()["reason"], "signal");
  EXPECT_EQ(told.back()["signal"], "SIGTERM");
  EXPECT_EQ(told.back()["exit_code"], 75);
  const auto written = of_kind(told, "written");
  ASSERT_EQ(written.size(), 1u);
  EXPECT_EQ(written[0]["state"], "ended early");
  EXPECT_EQ(written[0]["passes"], told.back()["passes"]);
}

TEST_F(ProgressEvents, TellNamesThatAreNoText) {
  std::filesystem::create_directory(path("b\xFF\"\n"));
  const RunResult result =
      run({"render", "scene.xml", "-o", "b\xFF\"\n/c.exr", "--passes", "1", "--progress", "json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(of_kind(events_of(result.err), "written")[0]["file"], "b\uFFFD\"\n/c.exr");
}

TEST_F(ProgressEvents, ComeFromOtherCommandsToo) {
  const RunResult learned = run({"learn", "scene.xml", "--integrator", "auto", "-o", "l.kln",
                                 "--passes", "2", "--progress", "json"});
  EXPECT_EQ(learned.exit_code, 0) << learned.err;
  EXPECT_EQ(of_kind(events_of(learned.err), "written")[0]["file"], "l.kln");
  const RunResult photons =
      run({"photons", "scene.xml", "-o", "m.kpm", "--set", "integrator.global_photons=100", "--set",
           "integrator.caustic_photons=100", "--progress", "json"});
  EXPECT_EQ(photons.exit_code, 0) << photons.err;
  EXPECT_EQ(events_of(photons.err).back()["reason"], "done");
  run_well({"render", "scene.xml", "-q", "--passes", "1", "-o", "a.exr", "--checkpoint", "a.kpt"});
  const RunResult resumed = run({"resume", "a.kpt", "--passes", "2", "--progress", "json"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(events_of(resumed.err).front()["command"], "resume");
  EXPECT_EQ(events_of(resumed.err).back()["passes"], 2);
}

TEST_F(ProgressEvents, BadTargetsAreErrorsBeforeTheRender) {
  write("notes.txt", "mine");
  const std::string scene = contents("scene.xml");
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--progress", "jsn"},
                                             {"--progress-file", "fd:9"},
                                             {"--progress-file", "fd:x"},
                                             {"--progress-file", "fd:-1"},
                                             {"--progress-file", "fd:99999999999"},
                                             {"--progress-file", "none/p.jsonl"},
                                             {"--progress-file", "."},
                                             {"--progress-file", "notes.txt"},
                                             {"--progress-file", "scene.xml"},
                                             {"--progress-file", "a.exr"}}) {
    SCOPED_TRACE(options[0] + " " + options[1]);
    const RunResult result = render(options);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "remedy: ")) << result.err;
    EXPECT_FALSE(exists("a.exr"));
  }
  EXPECT_EQ(contents("notes.txt"), "mine");
  EXPECT_EQ(contents("scene.xml"), scene);
}

// Whoever does not read does not stop the render.
TEST_F(ProgressEvents, AreLeftOutWhereTheyCannotBeWritten) {
  const RunResult full = render({"--passes", "4", "--spp", "4", "--progress-file", "/dev/full"});
  EXPECT_EQ(full.exit_code, 0) << full.err;
  EXPECT_TRUE(contains(full.err, "warning: no more progress in '/dev/full': ")) << full.err;
  EXPECT_TRUE(exists("a.exr"));
}

TEST_F(ProgressEvents, StylesAreWhatTheyAreCalled) {
  const auto shown = [&](const std::string& style, std::vector<int> columns) {
    RunOptions how;
    how.terminal_columns = std::move(columns);
    const RunResult result = render({"--passes", "2", "--spp", "2", "--progress", style}, how);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  EXPECT_TRUE(contains(shown("bar", {}), "\r["));
  EXPECT_TRUE(contains(shown("auto", {100}), "\r["));
  EXPECT_FALSE(contains(shown("plain", {100}), "\r["));
  EXPECT_TRUE(contains(shown("plain", {100}), "100 %  pass 2/2"));
  EXPECT_FALSE(contains(shown("none", {100}), " %  pass"));
  EXPECT_TRUE(contains(shown("none", {100}), "wrote a.exr"));
}

}  // namespace
}  // namespace kaustik::test
