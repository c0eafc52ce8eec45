#include "kaustik/base/parameters.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace kaustik {
namespace {

const TypeInfo& table() {
  static const TypeInfo info{
      "shape",
      "ball",
      "A ball.",
      {boolean_parameter("hollow", false, "Whether it is empty."),
       integer_parameter("rings", 16, "Rings of its mesh.").range(3, 1000),
       number_parameter("radius", 1, "Its radius.").range(0, 10).in("m"),
       text_parameter("label", "none", "What is written on it."),
       choice_parameter("side", "outer", {"outer", "inner"}, "Which side is seen."),
       point_parameter("center", {0, 1, 2}, "Its centre."),
       color_parameter("tint", 0.5, "Its colour.").range(0, 1),
       transform_parameter("to_world", "Where it stands."),
       optional(number_parameter("weight", 0, "Its weight.")),
       number_or_name_parameter("ior", Value(std::string("glass")), {"glass", "water"},
                                "What it is made of.")
           .range(1, 3),
       ignored_parameter("flip", ParameterKind::boolean)}};
  return info;
}

struct Checked {
  Arguments arguments;
  std::string text;  ///< of the error; empty if there was none
};

Checked check(const std::vector<Property>& properties, const TypeInfo& info = table()) {
  Problems problems;
  Arguments arguments(info, properties, place_in("s.xml", 2, 1), problems);
  std::string text;
  try {
    problems.throw_if_any();
  } catch (const Error& error) {
    text = error.what();
  }
  return {std::move(arguments), text};
}

Property given(const std::string& name, Value value) {
  return {name, std::move(value), place_in("s.xml", 5, 3)};
}

TEST(arguments, have_their_defaults) {
  const Checked c = check({});
  EXPECT_EQ(c.text, "");
  EXPECT_FALSE(c.arguments.boolean("hollow"));
  EXPECT_EQ(c.arguments.integer("rings"), 16);
  EXPECT_EQ(c.arguments.number("radius"), 1);
  EXPECT_EQ(c.arguments.text("label"), "none");
  EXPECT_EQ(c.arguments.text("side"), "outer");
  EXPECT_EQ(c.arguments.point("center"), Vec3d(0, 1, 2));
  EXPECT_EQ(std::get<Rgb>(c.arguments.color("tint")), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(c.arguments.transform("to_world"), Transform());
  EXPECT_EQ(std::get<std::string>(c.arguments.number_or_name("ior")), "glass");
  EXPECT_TRUE(c.arguments.has("radius"));
  EXPECT_FALSE(c.arguments.given("radius"));
  EXPECT_FALSE(c.arguments.has("weight"));
  EXPECT_EQ(c.arguments.place_of("radius").line, 2);
}

TEST(arguments, take_what_is_given) {
  const Transform moved = Transform::translate({1, 2, 3});
  const Checked c = check({given("hollow", true), given("rings", int64_t{8}),
                           given("radius", int64_t{2}), given("label", std::string("Ball")),
                           given("side", std::string("INNER")), given("center", Vec3d(4, 5, 6)),
                           given("tint", Rgb{0.1, 0.2, 0.3}), given("to_world", moved),
                           given("weight", 3.5), given("ior", 1.7), given("flip", true)});
  EXPECT_EQ(c.text, "");
  EXPECT_TRUE(c.arguments.boolean("hollow"));
  EXPECT_EQ(c.arguments.integer("rings"), 8);
  EXPECT_EQ(c.arguments.number("radius"), 2);
  EXPECT_EQ(c.arguments.text("label"), "Ball");
  EXPECT_EQ(c.arguments.text("side"), "inner");
  EXPECT_EQ(c.arguments.point("center"), Vec3d(4, 5, 6));
  EXPECT_EQ(std::get<Rgb>(c.arguments.color("tint")), (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(c.arguments.transform("to_world"), moved);
  EXPECT_EQ(c.arguments.number("weight"), 3.5);
  EXPECT_EQ(std::get<double>(c.arguments.number_or_name("ior")), 1.7);
  ASSERT_EQ(c.arguments.ignored().size(), 1u);
  EXPECT_EQ(c.arguments.ignored()[0].name, "flip");
  EXPECT_TRUE(c.arguments.given("radius"));
  EXPECT_EQ(c.arguments.place_of("radius").line, 5);
}

TEST(arguments, of_the_command_line_are_typed_by_the_table) {
  const auto untyped = [](const std::string& name, const std::string& text) {
    return Property{name, Untyped{text}, place_in("--set")};
  };
  const Checked c =
      check({untyped("hollow", "true"), untyped("rings", "7"), untyped("radius", "2.5"),
             untyped("center", "1, 2 3"), untyped("tint", "0.25"), untyped("ior", "water")});
  EXPECT_EQ(c.text, "");
  EXPECT_TRUE(c.arguments.boolean("hollow"));
  EXPECT_EQ(c.arguments.integer("rings"), 7);
  EXPECT_EQ(c.arguments.number("radius"), 2.5);
  EXPECT_EQ(c.arguments.point("center"), Vec3d(1, 2, 3));
  EXPECT_EQ(std::get<Rgb>(c.arguments.color("tint")), (Rgb{0.25, 0.25, 0.25}));
  EXPECT_EQ(std::get<std::string>(c.arguments.number_or_name("ior")), "water");
  EXPECT_EQ(std::get<double>(check({untyped("ior", "1.25")}).arguments.number_or_name("ior")),
            1.25);
  EXPECT_EQ(check({untyped("rings", "7x")}).text,
            "--set: 'rings' has the wrong type\n  remedy: give it as integer: Rings of its mesh.");
}

TEST(arguments, unknown_name) {
  const Checked c = check({given("radios", 1.0)});
  EXPECT_EQ(c.text.substr(0, c.text.find(" Valid")),
            "s.xml:5:3: shape 'ball' has no parameter 'radios'\n  remedy: did you mean 'radius'?");
}

TEST(arguments, wrong_type) {
  EXPECT_EQ(check({given("radius", std::string("big"))}).text,
            "s.xml:5:3: 'radius' has the wrong type\n  remedy: give it as float: Its radius.");
  EXPECT_EQ(check({given("rings", 2.5)}).text,
            "s.xml:5:3: 'rings' has the wrong type\n  remedy: give it as integer: Rings of its "
            "mesh.");
  EXPECT_EQ(check({given("ior", true)}).text,
            "s.xml:5:3: 'ior' has the wrong type\n  remedy: give it as float or name (string): "
            "What it is made of.");
}

TEST(arguments, of_a_type_without_parameters) {
  static const TypeInfo bare{"bsdf", "bare", "Takes nothing.", {}};
  Problems problems;
  const Arguments arguments(bare, {{"tint", 1.0, {}}}, {}, problems);
  try {
    problems.throw_if_any();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems()[0].remedy, "remove it: it takes none");
  }
}

TEST(arguments, ranges_without_an_end) {
  static const TypeInfo info{
      "light", "lamp", "Shines.", {color_parameter("intensity", 1, "Its light.")}};
  Problems problems;
  const Arguments arguments(info, {{"intensity", -1.0, {}}}, {}, problems);
  try {
    problems.throw_if_any();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems()[0].remedy, "give a value of at least 0");
  }
}

TEST(arguments, out_of_range) {
  const Checked c = check({given("radius", 12.0)});
  EXPECT_EQ(c.text,
            "s.xml:5:3: 'radius' is 12, outside its range\n  remedy: give a value from 0 to 10 m");
  EXPECT_EQ(c.arguments.number("radius"), 1) << "a wrong value reads as the default";
  EXPECT_NE(check({given("rings", int64_t{2})}).text, "");
  EXPECT_NE(check({given("tint", Rgb{0, 0, 1.5})}).text, "");
  EXPECT_NE(check({given("tint", SpectralCurve{{{400, 0.5}, {500, -0.1}}})}).text, "");
  EXPECT_NE(check({given("ior", 0.5)}).text, "");
  EXPECT_EQ(check({given("radius", 10.0)}).text, "");
}

TEST(arguments, not_finite) {
  EXPECT_EQ(check({given("weight", std::numeric_limits<double>::quiet_NaN())}).text.substr(0, 40),
            "s.xml:5:3: 'weight' must be finite, foun");
  EXPECT_NE(check({given("center", Vec3d(0, std::numeric_limits<double>::infinity(), 0))}).text,
            "");
}

TEST(arguments, unknown_choice) {
  EXPECT_EQ(check({given("side", std::string("iner"))}).text,
            "s.xml:5:3: 'side' cannot be 'iner'\n  remedy: did you mean 'inner'? Valid: outer, "
            "inner");
  EXPECT_EQ(check({given("ior", std::string("Watr"))}).text,
            "s.xml:5:3: 'ior' cannot be 'watr'\n  remedy: did you mean 'water'? Valid: glass, "
            "water");
}

TEST(arguments, given_twice) {
  EXPECT_EQ(check({given("radius", 2.0), given("radius", 3.0)}).text,
            "s.xml:5:3: 'radius' is given twice\n  remedy: keep one; the first is here: s.xml:5:3");
}

TEST(arguments, missing) {
  const TypeInfo info{"shape", "obj", "A mesh.", {file_parameter("filename", "The mesh file.")}};
  EXPECT_EQ(check({}, info).text,
            "s.xml:2:1: shape 'obj' needs 'filename'\n  remedy: The mesh file.");
}

TEST(arguments, several_problems_at_once) {
  const Checked c = check({given("radius", 12.0), given("rings", true), given("nothing", 1.0)});
  EXPECT_NE(c.text.find("'radius' is 12"), std::string::npos);
  EXPECT_NE(c.text.find("'rings' has"), std::string::npos);
  EXPECT_NE(c.text.find("no parameter 'nothing'"), std::string::npos);
}

TEST(arguments, a_row_that_the_table_lacks_is_a_mistake_of_the_program) {
  EXPECT_THROW(check({}).arguments.number("diameter"), std::logic_error);
}

TEST(parameters, show_their_defaults) {
  const auto text = [](const std::string& name) { return default_text(*table().find(name)); };
  EXPECT_EQ(text("hollow"), "false");
  EXPECT_EQ(text("rings"), "16");
  EXPECT_EQ(text("radius"), "1");
  EXPECT_EQ(text("center"), "0, 1, 2");
  EXPECT_EQ(text("tint"), "0.5");
  EXPECT_EQ(text("to_world"), "identity");
  EXPECT_EQ(text("weight"), "");
  EXPECT_EQ(text("ior"), "glass");
  EXPECT_EQ(table().find("diameter"), nullptr);
}

}  // namespace
}  // namespace kaustik
