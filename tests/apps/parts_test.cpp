// Parts of a picture's passes: kaustik render --part, repeated commands, kaustik merge.

#include <filesystem>

#include "kaustik/image/image_io.h"
#include "tests/apps/arguments.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Parts : public ProgramTest {
 protected:
  Parts() { write("scene.xml", small_scene()); }
  /// Of seven passes of two samples.
  static Arguments render(const Arguments& more) {
    return Arguments{"render",  "scene.xml", "-q", "--reproducible", "-D",
                     "size=10", "--passes",  "7",  "--spp",          "14"} +
           more;
  }
  static std::string file_of(int number) { return "part_" + std::to_string(number) + ".kpt"; }
  static Arguments part(int number, int count, const Arguments& more = {}) {
    return render({"--part", std::to_string(number) + "/" + std::to_string(count), "--checkpoint",
                   file_of(number), "--resume-if-there"}) +
           more;
  }
  std::string whole_picture(const Arguments& more = {}) const {
    run_well(render(Arguments{"-o", "whole.exr"} + more));
    return contents("whole.exr");
  }
  void expect_refused(const Arguments& arguments, const std::string& message,
                      const std::string& remedy) const {
    SCOPED_TRACE(message);
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    EXPECT_TRUE(contains(result.err, remedy)) << result.err;
    EXPECT_EQ(files(), before);
  }
  void damage(const std::string& name) const {
    std::string bytes = contents(name);
    bytes[bytes.size() * 2 / 3] ^= 1;
    write(name, bytes);
  }
};

TEST_F(Parts, MakeThePictureOfOneRender) {
  for (const char* integrator : {"path", "auto"}) {
    const Arguments method = {"--integrator", integrator};
    const std::string whole = whole_picture(method);
    for (const int count : {1, 2, 3, 4, 7}) {
      SCOPED_TRACE(testing::Message() << integrator << " in " << count << " parts");
      // The last one first, and merged in another order still.
      Arguments merge = {"merge", "-o", "merged.exr"};
      for (int number = count; number >= 1; --number) {
        run_well(part(number, count, method));
        merge.push_back(file_of(1 + (number + count / 2) % count));
      }
      EXPECT_FALSE(exists("scene.exr"));
      run_well(merge);
      EXPECT_TRUE(contents("merged.exr") == whole);
      for (int number = 1; number <= count; ++number)
        std::filesystem::remove(path(file_of(number)));
    }
  }
}

TEST_F(Parts, AreMergedAsATree) {
  const std::string whole = whole_picture();
  for (int number = 1; number <= 4; ++number) run_well(part(number, 4));
  const RunResult left = run_well({"merge", "part_1.kpt", "part_2.kpt", "-o", "left.kpt"});
  EXPECT_TRUE(contains(left.err, "parts 3–4 of 4 are missing")) << left.err;
  run_well({"merge", "part_4.kpt", "part_3.kpt", "-o", "right.kpt"});
  const RunResult all = run_well({"merge", "right.kpt", "left.kpt", "-o", "tree.kpt"});
  EXPECT_FALSE(contains(all.err, "missing")) << all.err;
  run_well({"merge", "part_1.kpt", "part_2.kpt", "part_3.kpt", "part_4.kpt", "-o", "flat.kpt"});
  EXPECT_TRUE(contents("tree.kpt") == contents("flat.kpt"));
  run_well({"merge", "tree.kpt", "-o", "merged.exr"});
  EXPECT_TRUE(contents("merged.exr") == whole);
}

TEST_F(Parts, AMergeOfSomeGoesOnToTheWhole) {
  const std::string whole = whole_picture();
  run_well(part(1, 4));
  run_well(part(4, 4));
  run_well({"merge", "part_1.kpt", "part_4.kpt", "-o", "some.kpt"});
  run_well({"resume", "some.kpt", "-q", "-o", "resumed.exr"});
  EXPECT_TRUE(contents("resumed.exr") == whole);
}

TEST_F(Parts, MissingOnesAreNamed) {
  run_well(part(2, 5));
  run_well(part(5, 5));
  const Arguments merge = {"merge", "part_2.kpt", "part_5.kpt", "-o", "some.exr"};
  expect_refused(merge, "parts 1, 3–4 of 5 are missing", "--incomplete");
  const RunResult some = run_well(merge + Arguments{"--incomplete"});
  EXPECT_TRUE(contains(some.err, "the picture is of the others")) << some.err;
  EXPECT_EQ(std::get<int64_t>(*read_image(path("some.exr")).find_metadata("passes")), 3);
}

TEST_F(Parts, PassesThatComeTwiceAreRefused) {
  run_well(part(1, 2));
  run_well(part(2, 2));
  run_well(render({"--part", "2/3", "--checkpoint", "other.kpt"}));
  expect_refused({"merge", "part_1.kpt", "part_2.kpt", "part_1.kpt", "-o", "new.kpt"},
                 "part_1.kpt: of its passes 0–2 were given before: 0–2", "give each pass once");
  expect_refused({"merge", "part_1.kpt", "other.kpt", "-o", "new.kpt"}, "were given before: 2",
                 "give each pass once");
}

TEST_F(Parts, AllDamagedOnesAreNamedAndNothingIsTouched) {
  for (int number = 1; number <= 4; ++number) run_well(part(number, 4));
  damage("part_2.kpt");
  const std::string truncated = contents("part_4.kpt");
  write("part_4.kpt", truncated.substr(0, truncated.size() / 2));
  const Arguments merge = {"merge",      "part_1.kpt", "part_2.kpt", "part_3.kpt",
                           "part_4.kpt", "-o",         "new.kpt",    "--consume"};
  expect_refused(merge, "part_2.kpt: the checkpoint is damaged", "render again");
  expect_refused(merge, "part_4.kpt: the checkpoint is damaged", "render again");
  // The same where the beginning is what has changed.
  write("part_2.kpt", truncated.substr(0, 30) + "?" + truncated.substr(31));
  expect_refused(merge, "part_2.kpt: the checkpoint is damaged: its checksum", "render again");
}

TEST_F(Parts, ConsumedOnesAreGoneWhenTheWholeIsThere) {
  for (int number = 1; number <= 3; ++number) run_well(part(number, 3));
  expect_refused({"merge", "part_1.kpt", "part_2.kpt", "part_3.kpt", "-o", "a.exr", "--consume"},
                 "nothing that is written holds what the parts hold", "-o FILE.kpt");
  const std::string first = contents("part_1.kpt");
  // One of them is replaced by the whole, and stays.
  run_well({"merge", "part_1.kpt", "part_2.kpt", "-o", "part_1.kpt", "--force", "--consume"});
  EXPECT_FALSE(exists("part_2.kpt"));
  EXPECT_FALSE(contents("part_1.kpt") == first);
  run_well({"merge", "part_1.kpt", "part_3.kpt", "-o", "whole.kpt", "-o", "a.exr", "--consume"});
  EXPECT_FALSE(exists("part_1.kpt") || exists("part_3.kpt"));
  run_well({"resume", "whole.kpt", "-q", "-o", "b.exr"});
  EXPECT_TRUE(contents("b.exr") == whole_picture());
}

TEST_F(Parts, UnfinishedOnesAreNotConsumed) {
  const Arguments unfinished = {"render",       "scene.xml", "-D",     "size=48", "--passes",
                                "100000",       "--spp",     "400000", "--part",  "1/2",
                                "--checkpoint", "long.kpt",  "--time", "0.2s"};
  EXPECT_EQ(run(unfinished).exit_code, 75);
  const Arguments merge = {"merge", "long.kpt", "-o", "new.kpt"};
  expect_refused(merge + Arguments{"--consume"}, "part 1 of 2 is unfinished", "finish them first");
  run_well(merge);
  EXPECT_TRUE(exists("long.kpt"));
}

TEST_F(Parts, ARepeatedCommandChangesNothing) {
  run_well(part(2, 3));
  const std::string there = contents("part_2.kpt");
  run_well(part(2, 3));
  EXPECT_TRUE(contents("part_2.kpt") == there);
}

TEST_F(Parts, AStoppedPartGoesOn) {
  // Large enough to be stopped in its midst.
  const Arguments command = {"render",
                             "scene.xml",
                             "--reproducible",
                             "-D",
                             "size=48",
                             "--passes",
                             "60",
                             "--spp",
                             "960",
                             "--part",
                             "2/3",
                             "--checkpoint",
                             "b.kpt",
                             "--resume-if-there",
                             "--every",
                             "0.01s"};
  RunOptions stop;
  stop.interrupt_at = "pass [1-9]";
  stop.terminal_columns = {120};
  stop.signals = {SIGTERM};
  const RunResult stopped = run(command, stop);
  ASSERT_EQ(stopped.exit_code, 75) << stopped.err;
  ASSERT_TRUE(exists("b.kpt"));
  const RunResult rest = run_well(command);
  EXPECT_TRUE(contains(rest.err, "b.kpt goes on: passes 20")) << rest.err;
  EXPECT_TRUE(contains(rest.err, "part 2 of 3: passes 20–39")) << rest.err;
  Arguments at_once = command;
  at_once[12] = "c.kpt";
  run_well(at_once);
  EXPECT_TRUE(contents("b.kpt") == contents("c.kpt"));
}

TEST_F(Parts, TimeEndsAPartEarly) {
  const Arguments command = {"render",       "scene.xml", "-D",     "size=48", "--passes",
                             "100000",       "--spp",     "400000", "--part",  "1/2",
                             "--checkpoint", "a.kpt",     "--time", "0.3s",    "--resume-if-there"};
  const RunResult first = run(command);
  EXPECT_EQ(first.exit_code, 75) << first.err;
  EXPECT_TRUE(contains(first.err, "of its 50000 passes are missing")) << first.err;
  EXPECT_TRUE(contains(first.err, "remedy: repeat the command")) << first.err;
  const auto size = contents("a.kpt");
  // Both ways to go on have the same end.
  EXPECT_EQ(run(command).exit_code, 75);
  EXPECT_EQ(run({"resume", "a.kpt", "--time", "0.2s"}).exit_code, 75);
  EXPECT_FALSE(contents("a.kpt") == size);
}

TEST_F(Parts, WithoutPartsTimeIsOfAllTriesTogether) {
  const Arguments command = {"render", "scene.xml", "--passes",         "100000",
                             "--time", "0.3s",      "--checkpoint",     "a.kpt",
                             "-o",     "a.exr",     "--resume-if-there"};
  run_well(command);
  const auto passes = [&] {
    return std::get<int64_t>(*read_image(path("a.exr")).find_metadata("passes"));
  };
  const int64_t first = passes();
  ASSERT_GT(first, 0);
  run_well(command);
  EXPECT_LE(passes(), first + 1);  // what the first try had left may be enough for one
  Arguments longer = command;
  longer[5] = "1s";
  run_well(longer);
  EXPECT_GT(passes(), first);
}

TEST_F(Parts, AnotherCommandDoesNotGoOn) {
  run_well(part(2, 3));
  const auto differs = [&](const Arguments& more, const std::string& message) {
    expect_refused(part(2, 3, more), message, "remedy: ");
  };
  differs({"--seed", "3"}, "part_2.kpt: it is not of this command: its seed is 0, not 3");
  differs({"--first-pass", "7"}, "it is of the part from pass 2 on of 7 passes in 3 parts, not");
  differs({"--set", "metal.radius=0.4"}, "is not what it was when the passes 2–3 were rendered");
  expect_refused({"render", "scene.xml", "-q", "-D", "size=10", "--passes", "7", "--spp", "21",
                  "--part", "2/3", "--checkpoint", "part_2.kpt", "--resume-if-there"},
                 "its passes have 2 samples per pixel, those that are asked for have 3",
                 "the same passes and samples");
  expect_refused(render({"--checkpoint", "part_2.kpt", "--resume-if-there", "-o", "a.exr"}),
                 "it is one of several parts", "another checkpoint");
  expect_refused(render({"--part", "2/3", "--checkpoint", "part_2.kpt"}),
                 "'part_2.kpt' is there already", "--resume-if-there");
}

TEST_F(Parts, ARenderWithoutPartsIsRepeatedToo) {
  const Arguments two = {"render",
                         "scene.xml",
                         "-q",
                         "--reproducible",
                         "-D",
                         "size=10",
                         "--integrator",
                         "path",
                         "--passes",
                         "2",
                         "--spp",
                         "4",
                         "-o",
                         "a.exr",
                         "--checkpoint",
                         "a.kpt",
                         "--resume-if-there"};
  run_well(two);
  Arguments seven = two;
  seven[9] = "7";
  seven[11] = "14";
  run_well(seven);
  EXPECT_TRUE(contents("a.exr") == whole_picture({"--integrator", "path"}));
}

TEST_F(Parts, ShareLessons) {
  write("scene.xml", small_scene("<integrator type=\"auto\"/>"));
  run_well(
      {"learn", "scene.xml", "-q", "-D", "size=10", "-o", "a.kln", "--passes", "4", "--spp", "8"});
  const Arguments learned = {"--learned", "a.kln"};
  const std::string whole = whole_picture(learned);
  const RunResult alone = run({"render", "scene.xml", "-D", "size=10", "--passes", "2", "--part",
                               "1/2", "--checkpoint", "alone.kpt"});
  EXPECT_TRUE(contains(alone.err, "auto: each part learns for itself")) << alone.err;
  for (const int number : {1, 2}) run_well(part(number, 2, learned));
  run_well(part(2, 2, learned));
  expect_refused(part(2, 2), "its passes were rendered with --learned", "repeat the command");
  run_well({"merge", "part_1.kpt", "part_2.kpt", "-o", "merged.exr"});
  EXPECT_TRUE(contents("merged.exr") == whole);
}

TEST_F(Parts, NonsenseIsRefused) {
  for (const char* text : {"0/3", "4/3", "1", "1/", "/3", "1/0", "1/3x", "1/1000001", "a/b"})
    expect_refused(render({"--part", text, "--checkpoint", "a.kpt"}),
                   std::string("command line: --part: cannot read the part '") + text + "'",
                   "--part 2/4");
  expect_refused(render({"--part", "1/8", "--checkpoint", "a.kpt"}),
                 "7 passes cannot be divided into 8 parts", "ask for fewer parts");
  EXPECT_EQ(run(render({"--part", "1/2"})).exit_code, 2);
  EXPECT_EQ(run(render({"--part", "1/2", "--checkpoint", "a.kpt", "--error", "1%"})).exit_code, 2);
  EXPECT_EQ(run(render({"--resume-if-there"})).exit_code, 2);
}

}  // namespace
}  // namespace kaustik::test
