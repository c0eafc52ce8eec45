#include "kaustik/scene/named_in.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

Problem problem_at(const Place& place) { return {"it is wrong", "mend it", place}; }

TEST(NamedIn, AFileOfItsOwn) {
  const Problem problem = named_in(problem_at(place_in("far.obj", 4)), place_in("scene.xml", 3, 2));
  EXPECT_EQ(problem.message, "it is wrong (named in scene.xml:3:2)");
  EXPECT_EQ(text_of(problem.place), "far.obj:4");
  // Of a program's object that names it: no line, and no column 0.
  EXPECT_EQ(named_in(problem_at(place_in("far.obj", 4)), place_in("ball.filename")).message,
            "it is wrong (named in ball.filename)");
}

TEST(NamedIn, TheSameFileOrObject) {
  const auto stays = [](const Place& place, const Place& other) {
    EXPECT_EQ(named_in(problem_at(place), other).message, "it is wrong") << text_of(place);
  };
  stays(place_in("scene.xml", 5), place_in("scene.xml", 3, 2));
  stays(place_in("floor.bsdf"), place_in("floor"));
  stays(place_in("points"), {});
  // Names alone may begin alike.
  EXPECT_NE(named_in(problem_at(place_in("floors")), place_in("floor")).message, "it is wrong");
  EXPECT_NE(named_in(problem_at(place_in("scene.xml.obj")), place_in("scene.xml", 1)).message,
            "it is wrong");
}

TEST(NamedIn, WithoutAPlaceItGetsThisOne) {
  EXPECT_EQ(text_of(named_in(problem_at({}), place_in("floor")).place), "floor");
}

}  // namespace
}  // namespace kaustik
