// pbrt's words and lists of parameters.

#include "kaustik/loader/pbrt/parameters.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

SourceText source_of(std::string_view text) {
  return {std::make_shared<const std::string>("t.pbrt"), text, nullptr};
}

TEST(PbrtTokens, WordsStringsBracketsAndComments) {
  const SourceText text = source_of("Shape\"sphere\" # a [comment]\n [1 .5]\t\"a \\\"b\\n\"");
  Tokenizer tokens(text);
  const auto next = [&] { return tokens.next(); };
  Token token = next();
  EXPECT_EQ(token.kind, TokenKind::word);
  EXPECT_EQ(token.text, "Shape");
  token = next();
  EXPECT_EQ(token.kind, TokenKind::quoted);
  EXPECT_EQ(token.text, "sphere");
  EXPECT_EQ(token.column, 6);
  EXPECT_EQ(tokens.peek().kind, TokenKind::open);
  token = next();
  EXPECT_EQ(token.line, 2);
  EXPECT_EQ(token.column, 2);
  EXPECT_EQ(next().text, "1");
  EXPECT_EQ(next().text, ".5");
  EXPECT_EQ(next().kind, TokenKind::close);
  EXPECT_EQ(unescaped(next().text), "a \"b\n");
  EXPECT_EQ(next().kind, TokenKind::end);
  EXPECT_EQ(next().kind, TokenKind::end);
}

TEST(PbrtTokens, NumbersOfAllSpellings) {
  const SourceText text =
      source_of("1 -2.5 .5 -.25 3. +4 1e3 -1.5e-2 12345678901 0.1#5\n6 \"end\"");
  Tokenizer tokens(text);
  std::vector<double> numbers;
  tokens.take_numbers(numbers);
  EXPECT_EQ(numbers,
            (std::vector<double>{1, -2.5, .5, -.25, 3, 4, 1000, -.015, 12345678901, .1, 6}));
  EXPECT_EQ(tokens.next().text, "end");
  const SourceText integers = source_of("1 -2 3.0 99999999999 ]");
  Tokenizer more(integers);
  more.peek();
  std::vector<int32_t> whole;
  more.take_numbers(whole);
  EXPECT_EQ(whole, (std::vector<int32_t>{1, -2, 3, std::numeric_limits<int32_t>::max()}));
}

TEST(PbrtTokens, WhatIsNoNumberIsTold) {
  for (const char* text : {"1x", "1 -", "2..3", "1e999", "+-1", "0x10"}) {
    const SourceText source = source_of(text);
    Tokenizer tokens(source);
    std::vector<double> numbers;
    EXPECT_THROW(tokens.take_numbers(numbers), Error) << text;
  }
  const SourceText open = source_of("\"abc\n\"");
  Tokenizer tokens(open);
  expect_problem(problems_of([&] { tokens.next(); }), "t.pbrt:1:1", "does not end", "close it");
}

ParameterList list_of(const SourceText& text) {
  Tokenizer tokens(text);
  return ParameterList::read(tokens, place_in("t.pbrt", 1, 1));
}

TEST(PbrtParameters, AllTypes) {
  const SourceText text = source_of(
      "\"float a\" 1.5 \"integer  n\" [2 3] \"bool\tyes\" true \"bool no\" [\"false\"]"
      "\"string s\" [\"x\" \"y\"] \"point P\" [1 2 3 4 5 6] \"rgb L\" [.1 .2 .3] \"float many\" 1 "
      "2 3");
  const ParameterList list = list_of(text);
  EXPECT_EQ(list.number("A"), 1.5);  // whatever the case
  EXPECT_EQ(list.integer("n", 0), 2);
  EXPECT_TRUE(list.flag("yes", false));
  EXPECT_FALSE(list.flag("no", true));
  EXPECT_EQ(list.text("s"), "x");
  EXPECT_EQ(list.point("P"), Vec3d(1, 2, 3));
  EXPECT_EQ(list.numbers("L"), (std::vector<double>{.1, .2, .3}));
  EXPECT_EQ(list.numbers("many").size(), 3u);
  EXPECT_EQ(list.number("absent"), std::nullopt);
  EXPECT_EQ(list.find("L", {"float"}), nullptr);
}

TEST(PbrtParameters, TellsWhatNobodyAskedFor) {
  const SourceText text = source_of("\"float a\" 1 \"float b\" 2"),
                   more = source_of("\"float b\" 5 \"float c\" 3");
  ParameterList list = list_of(text);
  list.add_defaults(list_of(more));
  EXPECT_EQ(list.number("b"), 2);
  EXPECT_EQ(list.number("c"), 3);
  Deviations told;
  list.tell_unused("ball", told);
  Description description;
  told.finish(description, false);
  ASSERT_EQ(description.deviations.size(), 1u);
  EXPECT_EQ(description.deviations[0].object, "ball");
  EXPECT_EQ(description.deviations[0].what, "parameter 'a' has no effect");
}

TEST(PbrtParameters, MistakesHavePlaceAndRemedy) {
  const auto told = [](const char* text, const std::string& place, const std::string& message,
                       const std::string& remedy) {
    const SourceText source = source_of(text);
    expect_problem(problems_of([&] { list_of(source); }), place, message, remedy);
  };
  told("\"float\" 1", "t.pbrt:1:1", "no type and name", "float radius");
  told("\"flaot a\" 1", "t.pbrt:1:1", "'flaot' is no type", "did you mean 'float'");
  told("\"float a\" 1 \"float a\" 2", "t.pbrt:1:13", "'a' is given twice", "t.pbrt:1:1");
  told("\"float a\" [1 2", "t.pbrt:1:11", "does not end", "bracket");
  told("\"float a\" [1 [2]]", "t.pbrt:1:14", "'[' is no value", "write numbers");
  told("\"float a\"", "t.pbrt:1:10", "'a' has no value", "write a number");
  told("\"float a\" \"x\"", "t.pbrt:1:1", "of another type", "without quotes");
  told("\"string a\" 1", "t.pbrt:1:1", "of another type", "into quotes");
  told("\"bool a\" 1", "t.pbrt:1:1", "of another type", "true or false");
  std::string many;
  for (int i = 0; i < 600; ++i) many += "\"float a" + std::to_string(i) + "\" 1 ";
  const SourceText source = source_of(many);
  EXPECT_NE(problems_of([&] { list_of(source); })[0].message.find("more than 500"),
            std::string::npos);
}

}  // namespace
}  // namespace kaustik::pbrt
