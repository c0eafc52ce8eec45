// Renders that are stopped, gone on with and put together.

#include "kaustik/image/image_io.h"
#include "tests/apps/arguments.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

constexpr const char* small_photonmap =
    "<integrator type=\"photonmap\"><integer name=\"global_photons\" value=\"2000\"/>"
    "<integer name=\"caustic_photons\" value=\"2000\"/>"
    "<integer name=\"cache_samples\" value=\"16\"/></integrator>";

struct PassRange {
  int begin, end;
};

class CheckpointCommands : public ProgramTest {
 protected:
  CheckpointCommands() {
    write("path.xml", small_scene());
    write("photonmap.xml", small_scene(small_photonmap));
    write("vcm.xml", small_scene("<integrator type=\"vcm\"/>"));
  }
  /// `kaustik render` of a tiny picture.
  static Arguments render(const std::string& scene, PassRange passes, const std::string& name,
                          int samples_per_pass = 2, const std::string& seed = "7") {
    const int count = passes.end - passes.begin;
    return {"render",       scene + ".xml",
            "-q",           "--reproducible",
            "-D",           "size=10",
            "--first-pass", std::to_string(passes.begin),
            "--passes",     std::to_string(count),
            "--spp",        std::to_string(count * samples_per_pass),
            "--seed",       seed,
            "-o",           name + ".exr",
            "--force",      "--checkpoint",
            name + ".kpt"};
  }
  void expect_refused(const Arguments& arguments, const std::string& place,
                      const std::string& message, const std::string& remedy) const {
    SCOPED_TRACE(message);
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, place + ": ")) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    const size_t at = result.err.find("remedy: ");
    ASSERT_NE(at, std::string::npos) << result.err;
    EXPECT_TRUE(contains(result.err.substr(at), remedy)) << result.err;
    EXPECT_EQ(files(), before);
  }
  /// That of a picture's metadata.
  int64_t passes_of(const std::string& image) const {
    const Image read = read_image(path(image));
    const MetadataValue* passes = read.find_metadata("passes");
    return passes ? std::get<int64_t>(*passes) : -1;
  }
};

TEST_F(CheckpointCommands, ResumedAndMergedRendersAreTheSameFiles) {
  for (const std::string scene : {"path", "photonmap", "vcm"}) {
    SCOPED_TRACE(scene);
    run_well(render(scene, {0, 6}, "whole"));
    run_well(render(scene, {0, 3}, "head"));
    run_well(render(scene, {3, 6}, "tail"));
    run_well({"merge", "tail.kpt", "head.kpt", "-o", "merged.exr", "-o", "merged.kpt", "--force"});
    run_well({"resume", "head.kpt", "-q", "--passes", "6", "-o", "resumed.exr"});
    run_well({"resume", "merged.kpt", "-q", "-o", "again.exr"});
    const std::string whole = contents("whole.exr");
    EXPECT_FALSE(whole.empty());
    for (const char* other : {"merged.exr", "resumed.exr", "again.exr"})
      EXPECT_TRUE(contents(other) == whole) << other;
    EXPECT_FALSE(contents("tail.exr") == whole);
  }
}

TEST_F(CheckpointCommands, SettingsAndOutputsAreKept) {
  const auto rendered = [&](int passes) {
    RunOptions options;
    options.environment = {"photonMap.totalCaustic=3000"};
    const RunResult result =
        run(render("path", {0, passes}, "a") +
                Arguments{"--set", "metal.radius=0.3", "--integrator", "photonmap", "-e", "2", "-o",
                          "a.png", "--float", "--tonemap", "linear", "--exposure", "1"},
            options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  rendered(2);
  const std::string part = contents("a.exr");
  // The environment of the first run counts, not that of the second.
  run_well({"resume", "a.kpt", "-q", "--spp", "8"});
  const std::string resumed = contents("a.exr"), shown = contents("a.png");
  rendered(4);
  EXPECT_TRUE(resumed == contents("a.exr"));
  EXPECT_TRUE(shown == contents("a.png"));
  EXPECT_FALSE(resumed == part);
}

TEST_F(CheckpointCommands, CtrlCKeepsACheckpointThatGoesOn) {
  RunOptions interrupt;
  interrupt.interrupt_at = "pass 0";
  interrupt.interrupt_delay_s = 0.7;
  const RunResult cancelled = run({"render", "path.xml", "--passes", "100000", "--spp", "200000",
                                   "--reproducible", "-o", "a.exr", "--checkpoint", "a.kpt"},
                                  interrupt);
  EXPECT_EQ(cancelled.exit_code, 75) << cancelled.err;
  const int64_t passes = passes_of("a.exr");
  ASSERT_GT(passes, 0);
  const std::string picture = contents("a.exr");
  run_well({"resume", "a.kpt", "-q", "--passes", std::to_string(passes)});
  EXPECT_TRUE(contents("a.exr") == picture);
  const RunResult resumed = run_well({"resume", "a.kpt", "--time", "0.2s"});
  EXPECT_TRUE(contains(resumed.err, "path.xml goes on: passes 0–")) << resumed.err;
  EXPECT_TRUE(contains(resumed.err, "wrote a.exr")) << resumed.err;
  EXPECT_GT(passes_of("a.exr"), passes);
}

TEST_F(CheckpointCommands, AKilledRenderGoesOn) {
  RunOptions killed;
  killed.folder = path("");
  killed.timeout_s = 0.02 * patience_s;
  run_kaustik({"render", "path.xml", "-q", "--passes", "100000", "--spp", "200000", "-o", "a.exr",
               "--checkpoint", "a.kpt", "--every", "0.05s"},
              killed);
  EXPECT_FALSE(exists("a.exr"));
  ASSERT_TRUE(exists("a.kpt"));
  run_well({"resume", "a.kpt", "-q", "--passes", "1"});
  EXPECT_GT(passes_of("a.exr"), 0);
}

TEST_F(CheckpointCommands, AFullDiskCostsTheCheckpointNotThePicture) {
  RunOptions small_files;
  small_files.file_size_limit = 20000;
  const RunResult result = run({"render", "path.xml", "--passes", "50", "--spp", "100", "-o",
                                "a.png", "--checkpoint", "a.kpt", "--every", "0.0001s"},
                               small_files);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(contains(result.err, "could not be written, the render goes on")) << result.err;
  EXPECT_TRUE(contains(result.err, "cannot write 'a.kpt'")) << result.err;
  EXPECT_TRUE(exists("a.png"));
  EXPECT_FALSE(exists("a.kpt"));
}

TEST_F(CheckpointCommands, NoFinishedPassIsNoCheckpoint) {
  RunOptions interrupt;
  interrupt.interrupt_at = "pass 0";
  interrupt.interrupt_delay_s = 0.3;
  const RunResult result = run({"render", "path.xml", "--passes", "1", "--spp", "100000000", "-o",
                                "a.exr", "--checkpoint", "a.kpt"},
                               interrupt);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_TRUE(contains(result.err, "there is no checkpoint")) << result.err;
  EXPECT_FALSE(exists("a.kpt"));
}

TEST_F(CheckpointCommands, ResumeRefusesAnotherScene) {
  run_well(render("path", {0, 2}, "a"));
  const Arguments resume = {"resume", "a.kpt", "--passes", "3", "-o", "new.exr"};
  const std::string scene = contents("path.xml");
  write("path.xml", scene + "<!-- the same -->");
  run_well({"resume", "a.kpt", "-q"});
  std::string changed = scene;
  changed.replace(changed.find("0.6,0.5,0.4"), 11, "0.6,0.5,0.3");
  write("path.xml", changed);
  expect_refused(resume, "a.kpt", "is not what it was when the passes 0–1 were rendered",
                 "bring back the scene");
  std::filesystem::remove(path("path.xml"));
  expect_refused(resume, "a.kpt", "its scene 'path.xml' is not there", "--scene FILE");
  write("moved/path.xml", scene);
  run_well({"resume", "a.kpt", "-q", "--scene", "moved/path.xml"});
}

TEST_F(CheckpointCommands, ResumeRefusesAChangedMesh) {
  write("mesh.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
  write("path.xml",
        scene_with({"<integrator type=\"path\"/><shape type=\"obj\"><string name=\"filename\" "
                    "value=\"mesh.obj\"/></shape>"}));
  run_well({"render", "path.xml", "-q", "--passes", "2", "--checkpoint", "a.kpt"});
  write("mesh.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0.001\nf 1 2 3\n");
  expect_refused({"resume", "a.kpt", "--passes", "3"}, "a.kpt", "or a file that it names",
                 "bring back the scene");
}

TEST_F(CheckpointCommands, MergeRefusesWhatDoesNotBelongTogether) {
  run_well(render("path", {0, 2}, "a"));
  const auto refused = [&](const Arguments& other, const std::string& message,
                           const std::string& remedy) {
    run_well(other);
    expect_refused({"merge", "a.kpt", "b.kpt", "-o", "new.exr"}, "b.kpt", message, remedy);
  };
  refused(render("path", {1, 3}, "b"), "of its passes 1–2 were given before: 1",
          "parts have passes of their own");
  refused(render("path", {2, 4}, "b") + Arguments{"--set", "metal.radius=0.4"}, "another scene",
          "of one scene file");
  refused(render("path", {2, 4}, "b") + Arguments{"--set", "integrator.max_depth=4"},
          "other parameters", "by the same integrator");
  refused(render("photonmap", {2, 4}, "b"), "another integrator", "by the same integrator");
  refused(render("path", {2, 4}, "b", 2, "8"), "seed 8 instead of 7", "the same seed");
  refused(render("path", {2, 4}, "b", 3), "3 samples per pass instead of 2",
          "the same number of samples");
}

TEST_F(CheckpointCommands, FilesThatAreNoCheckpoints) {
  run_well(render("path", {0, 2}, "a"));
  run_well({"photons", "path.xml", "-o", "map.kpm", "--set", "integrator.global_photons=100",
            "--set", "integrator.caustic_photons=100"});
  const std::string whole = contents("a.kpt");
  write("short.kpt", whole.substr(0, whole.size() / 2));
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  write("flipped.kpt", flipped);
  for (const char* damaged : {"short.kpt", "flipped.kpt"}) {
    expect_refused({"resume", damaged}, damaged, "the checkpoint is damaged", "render again");
    expect_refused({"merge", "a.kpt", damaged, "-o", "new.exr"}, damaged,
                   "the checkpoint is damaged", "render again");
  }
  expect_refused({"resume", "path.xml"}, "path.xml", "not a checkpoint",
                 "that a render has written");
  expect_refused({"merge", "path.xml", "a.kpt", "-o", "new.exr"}, "path.xml",
                 "neither a checkpoint nor a photon map", "--part");
  expect_refused({"merge", "a.kpt", "map.kpm", "-o", "new.exr"}, "map.kpm", "not a checkpoint",
                 "that a render has written");
  expect_refused({"merge", "map.kpm", "a.kpt", "-o", "new.kpm"}, "a.kpt", "not a photon map",
                 "give a .kpm file");
  EXPECT_EQ(run({"resume", "missing.kpt"}).exit_code, 2);
}

}  // namespace
}  // namespace kaustik::test
