// Checkpoints of another version of the program: their passes may differ from those of this one.

#include <cstring>

#include "kaustik/base/checksum.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class CheckpointsOfAnotherProgram : public ProgramTest {
 protected:
  CheckpointsOfAnotherProgram() {
    write("scene.xml", small_scene());
    run_well(render(0, "a"));
    run_well(render(2, "b"));
  }
  static std::vector<std::string> render(int first_pass, const std::string& name) {
    return {"render",
            "scene.xml",
            "-q",
            "-D",
            "size=8",
            "--first-pass",
            std::to_string(first_pass),
            "--passes",
            "2",
            "--spp",
            "2",
            "-o",
            name + ".exr",
            "--checkpoint",
            name + ".kpt"};
  }
  /// The version is the first text behind magic, byte order and the format's version: its length in
  /// 8 bytes, then the letters. The file ends with its checksum.
  void write_as_of(const std::string& name, const std::string& old, const std::string& version) {
    std::string bytes = contents(old);
    constexpr size_t at = 16;
    uint64_t length = 0;
    ASSERT_GT(bytes.size(), at + 2 * sizeof length);
    std::memcpy(&length, bytes.data() + at, sizeof length);
    const std::string present = bytes.substr(at + sizeof length, length);
    ASSERT_TRUE(contains(run_well({"--version"}).out, present)) << present;
    const uint64_t new_length = version.size();
    std::string text(sizeof new_length, '\0');
    std::memcpy(text.data(), &new_length, sizeof new_length);
    bytes.replace(at, sizeof length + length, text + version);
    bytes.resize(bytes.size() - sizeof(uint64_t));
    const uint64_t sum = checksum({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    write(name, bytes);
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& file) const {
    SCOPED_TRACE(arguments[0] + " " + file);
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(
        contains(result.err, file + ": this file was written by Kaustik 0.0.9, this program is"))
        << result.err;
    EXPECT_TRUE(contains(result.err, "remedy: use that version, or write the file again"))
        << result.err;
    EXPECT_EQ(files(), before);
  }
};

TEST_F(CheckpointsOfAnotherProgram, AreRefused) {
  const std::string whole = contents("a.kpt");
  write_as_of("old.kpt", "b.kpt", "0.0.9");
  const std::string old = contents("old.kpt");
  expect_refused({"resume", "old.kpt", "--passes", "4", "-o", "new.exr"}, "old.kpt");
  expect_refused({"merge", "a.kpt", "old.kpt", "-o", "new.exr"}, "old.kpt");
  expect_refused({"merge", "old.kpt", "a.kpt", "-o", "new.kpt"}, "old.kpt");
  EXPECT_TRUE(contents("old.kpt") == old && contents("a.kpt") == whole);
}

TEST_F(CheckpointsOfAnotherProgram, AreTakenByThatProgram) {
  const std::string version = run_well({"--version"}).out;
  write_as_of("same.kpt", "b.kpt", version.substr(0, version.find('\n')));
  EXPECT_TRUE(contents("same.kpt") == contents("b.kpt"));
  run_well({"merge", "a.kpt", "same.kpt", "-o", "new.kpt"});
  run_well({"resume", "new.kpt", "-q", "--passes", "5", "-o", "new.exr"});
}

}  // namespace
}  // namespace kaustik::test
