#include "kaustik/base/error.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace kaustik {
namespace {

TEST(error, tells_place_message_and_remedy) {
  const Error error(ErrorKind::input, "'alpha' is 7", "make it smaller",
                    place_in("nowhere.xml", 12, 3));
  EXPECT_STREQ(error.what(), "nowhere.xml:12:3: 'alpha' is 7\n  remedy: make it smaller");
  EXPECT_EQ(error.kind(), ErrorKind::input);
  ASSERT_EQ(error.problems().size(), 1u);
}

TEST(error, leaves_out_what_is_unknown) {
  EXPECT_STREQ(Error(ErrorKind::system, "disk full").what(), "disk full");
  EXPECT_STREQ(Error(ErrorKind::input, "empty", {}, place_in("a.xml")).what(), "a.xml: empty");
  EXPECT_STREQ(Error(ErrorKind::input, "bad", {}, place_in("command line", 0, 4)).what(),
               "command line:4: bad");
}

TEST(error, tells_where_the_first_of_two_is) {
  EXPECT_EQ(text_of(place_in("a.xml", 2, 8)), "a.xml:2:8");
  EXPECT_EQ(keep_one(place_in("a.xml", 2, 8)), "keep one; the first is here: a.xml:2:8");
  EXPECT_EQ(keep_one(place_in("a program")), "keep one; the first is here: a program");
  EXPECT_EQ(keep_one({}), "keep one");
}

TEST(error, shows_the_line_with_a_caret) {
  const std::string path = testing::TempDir() + "kaustik_error_test.xml";
  std::ofstream(path) << "<scene>\n\t<bsdf type=\"difuse\"/>\n</scene>\n";
  const Error error(ErrorKind::input, "no bsdf 'difuse'", "did you mean 'diffuse'?",
                    place_in(path, 2, 8));
  EXPECT_EQ(std::string(error.what()), path +
                                           ":2:8: no bsdf 'difuse'\n"
                                           "    \t<bsdf type=\"difuse\"/>\n"
                                           "    \t      ^\n"
                                           "  remedy: did you mean 'diffuse'?");
  std::remove(path.c_str());
}

TEST(problems, are_told_together) {
  Problems problems;
  EXPECT_TRUE(problems.empty());
  EXPECT_NO_THROW(problems.throw_if_any());
  problems.add("first");
  problems.add("second", "do this");
  EXPECT_FALSE(problems.empty());
  try {
    problems.throw_if_any();
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "first\nsecond\n  remedy: do this");
    EXPECT_EQ(error.problems().size(), 2u);
  }
}

TEST(problems, give_up_when_there_are_too_many) {
  Problems problems;
  for (size_t i = 0; i + 1 < Problems::maximum; ++i) problems.add("again");
  EXPECT_THROW(problems.add("the last one"), Error);
}

TEST(nearest_name, finds_slips_and_refuses_guesses) {
  const std::vector<std::string> names = {"reflectance", "roughness", "radius", "to_world"};
  EXPECT_EQ(nearest_name("reflectnce", names), "reflectance");
  EXPECT_EQ(nearest_name("Reflectance", names), "reflectance");
  EXPECT_EQ(nearest_name("toworld", names), "to_world");
  EXPECT_EQ(nearest_name("colour_of_money", names), "");
  EXPECT_EQ(nearest_name("x", {}), "");
  // Of three letters two may not be others.
  EXPECT_EQ(nearest_name("prb", {"ppm", "path"}), "");
  EXPECT_EQ(nearest_name("pmm", {"ppm", "path"}), "ppm");
  // A search that gives up early finds what a full one finds.
  EXPECT_EQ(nearest_name("abcdefghijkl", {"zzzzzzzzzzzz", "abXdefghYjklm", "abcdeghijkl", "a"}),
            "abcdeghijkl");
  EXPECT_EQ(nearest_name("abcdefghijkl", {"cdefghijklmn"}), "cdefghijklmn");  // 4 of 12
  EXPECT_EQ(nearest_name("abcdefghijkl", {"defghijklmno"}), "");              // 6
}

TEST(nearest_name, becomes_a_remedy) {
  EXPECT_EQ(suggest("radios", {"radius", "center"}),
            "did you mean 'radius'? Valid: radius, center");
  EXPECT_EQ(suggest("zzzzzz", {"radius", "center"}), "Valid: radius, center");
  EXPECT_EQ(suggest("radios", {}), "there are none to choose from");
}

}  // namespace
}  // namespace kaustik
