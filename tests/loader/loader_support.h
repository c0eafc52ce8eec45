#pragma once
// What the loader's tests share: parsing text, finding things in the result, catching problems.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {

inline Description parse(const std::string& text, const LoadOptions& options = {}) {
  return parse_mitsuba_xml(text, "test.xml", "", options);
}

/// The text as the inside of a scene; it starts at test.xml:2:1.
inline std::string in_scene(const std::string& inside, const std::string& version = "3.0.0") {
  return "<scene version=\"" + version + "\">\n" + inside + "\n</scene>\n";
}

inline Description parse_inside(const std::string& inside, const LoadOptions& options = {}) {
  return parse(in_scene(inside), options);
}

/// A property of an object, which must exist.
inline const Property& property(const Object& object, const std::string& name) {
  for (const Property& p : object.properties)
    if (p.name == name) return p;
  throw std::runtime_error("no property " + name);
}

template <typename T>
const T& value(const Object& object, const std::string& name) {
  return std::get<T>(property(object, name).value);
}

/// The only object of a scene, written with this inside; for tests of one value.
template <typename T>
T value_in_shape(const std::string& element, const std::string& version = "3.0.0",
                 const std::string& name = "x") {
  const auto scene =
      parse(in_scene("<shape type=\"sphere\">" + element + "</shape>", version)).scene;
  return value<T>(*scene->children.at(0).object, name);
}

/// What `load` complains about; fails if it does not.
template <typename Load>
std::vector<Problem> problems_of(const Load& load) {
  try {
    load();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.problems();
  }
  ADD_FAILURE() << "no error";
  return {Problem{}};
}

inline std::vector<Problem> problems_in(const std::string& text, const LoadOptions& options = {}) {
  return problems_of([&] { parse(text, options); });
}

/// Expects one problem at a place, whose message and remedy hold these texts.
inline void expect_problem(const std::vector<Problem>& problems, const std::string& place,
                           const std::string& message, const std::string& remedy) {
  ASSERT_EQ(problems.size(), 1u);
  const Problem& problem = problems[0];
  EXPECT_EQ(text_of(problem.place), place) << problem.message;
  EXPECT_NE(problem.message.find(message), std::string::npos) << problem.message;
  EXPECT_NE(problem.remedy.find(remedy), std::string::npos) << problem.remedy;
}

/// The only warning of a scene, which is an error where it is read strictly.
inline std::string lenient_warning(const std::string& text) {
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_FALSE(problems_in(text, strict).empty());
  const Description description = parse(text);
  EXPECT_EQ(description.warnings.size(), 1u);
  return description.warnings.empty() ? "" : description.warnings[0];
}

using test::TemporaryFolder;

}  // namespace kaustik
