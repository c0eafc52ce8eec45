// What a render tells on standard error beside its progress: what auto decided, what large meshes
// will take, how far the picture is from the truth.

#include <regex>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Messages : public ProgramTest {
 protected:
  RunResult render(const std::string& scene, const std::vector<std::string>& more = {}) const {
    write("scene.xml", scene);
    std::vector<std::string> arguments = {"render", "scene.xml", "-o", "a.exr", "-D", "size=8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// The start of a header, and zeros that take no place on the disk.
  void write_sparse(const std::string& name, uint64_t size) const {
    write(name, "ply\nformat ascii 1.0\n");
    std::filesystem::resize_file(path(name), size);
  }
};

const std::string large_mesh_scene =
    scene_with({"<shape type=\"ply\"><string name=\"filename\" value=\"mesh.ply\"/></shape>"});
const std::vector<std::string> commands_that_build[] = {
    {"render", "scene.xml", "-o", "a.exr"},
    {"render", "scene.xml", "-o", "a.exr", "--checkpoint", "a.kpt"},
    {"photons", "scene.xml", "-o", "a.kpm"},
    {"info", "scene.xml"}};

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, std::regex(pattern));
}

TEST_F(Messages, AutoTellsWhatItDecided) {
  const std::vector<std::string> two_passes = {"--passes", "2", "--spp", "2"};
  const RunResult unnamed = render(small_scene(""), two_passes);
  EXPECT_EQ(unnamed.exit_code, 0) << unnamed.err;
  EXPECT_TRUE(matches(unnamed.err, "(^|\n)info: auto: .*(light paths|paths from the camera)"))
      << unnamed.err;
  const RunResult path = render(small_scene(), two_passes);
  EXPECT_EQ(path.exit_code, 0) << path.err;
  EXPECT_FALSE(contains(path.err, "auto:")) << path.err;
  const RunResult quiet = render(small_scene(""), {"--passes", "2", "--spp", "2", "-q"});
  EXPECT_EQ(quiet.err, "");
}

TEST_F(Messages, TheErrorIsInTheProgressAndAtTheEnd) {
  const std::string percent = "[0-9.]+(e[+-][0-9]+)? %";
  for (const std::string integrator : {"auto", "path"}) {
    SCOPED_TRACE(integrator);
    const RunResult result =
        render(small_scene(), {"--integrator", integrator, "--passes", "4", "--spp", "4"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(matches(result.err, "100 %  pass 4/4 .* error " + percent + "  ")) << result.err;
    EXPECT_TRUE(matches(result.err, "\nerror of the pixels: " + percent)) << result.err;
    EXPECT_TRUE(matches(result.err, "\nmean of the picture: ±" + percent)) << result.err;
  }
  // Of one pass nothing is known.
  const RunResult one = render(small_scene(), {"--passes", "1", "--spp", "4"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_FALSE(contains(one.err, "error")) << one.err;
}

TEST_F(Messages, MemoryIsToldBeforeALargeMeshIsRead) {
  const std::string note = "reading large meshes: they will take up to 0.6 GB of memory";
  const std::string error = "the header has no end";
  write("scene.xml", large_mesh_scene);
  write_sparse("mesh.ply", 80'000'000);
  for (const std::vector<std::string>& command : commands_that_build) {
    const RunResult result = run(command);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, error)) << result.err;
    EXPECT_LT(result.err.find(note), result.err.find(error)) << result.err;
    EXPECT_FALSE(contains(result.err, "this machine has")) << result.err;
  }
  write_sparse("mesh.ply", 70'000'000);
  const RunResult smaller = run(commands_that_build[0]);
  EXPECT_EQ(smaller.exit_code, 2) << smaller.err;
  EXPECT_FALSE(contains(smaller.err, "memory")) << smaller.err;
}

#ifndef KAUSTIK_SLOW_BUILD
TEST_F(Messages, MeshesThatDoNotFitAreAnErrorAfterAWarning) {
  RunOptions little_memory;
  little_memory.memory_limit = rlim_t(8) << 30;
  write("scene.xml", large_mesh_scene);
  // A file as long as it says.
  constexpr uint64_t vertices = 4'000'000'000;
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                             std::to_string(vertices) +
                             "\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  write("mesh.ply", header);
  std::filesystem::resize_file(path("mesh.ply"), header.size() + 12 * vertices);
  for (const std::vector<std::string>& command : commands_that_build) {
    const RunResult result = run(command, little_memory);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(matches(result.err,
                        "info: .* up to 336.0 GB of memory\n"
                        "warning: this machine has [0-9.]+ GB: .*\n"
                        ".*not enough memory\n *remedy: "))
        << result.err;
  }
}
#endif

}  // namespace
}  // namespace kaustik::test
