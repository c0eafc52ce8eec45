#pragma once
// Scenes from text, and what is wrong with them.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/scene.h"

namespace kaustik::test {

/// The objects stand from line 2 on.
inline Description description_of(const std::string& objects) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + objects + "\n</scene>\n", "test.xml",
                           "");
}

inline std::shared_ptr<const Scene> scene_of(const std::string& objects) {
  return build_scene(description_of(objects));
}

inline constexpr const char* any_camera = "<sensor type=\"perspective\"/>";
inline constexpr const char* any_shape = "<shape type=\"sphere\"/>";

/// A scene with a camera of these properties and a sphere.
inline std::shared_ptr<const Scene> seen_by(const std::string& camera_inside) {
  return scene_of("<sensor type=\"perspective\">" + camera_inside + "</sensor>" + any_shape);
}

inline std::string film(int width, int height, const std::string& inside = "") {
  return "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) + "\"/>" + inside +
         "</film>";
}

/// What building the scene complains about; fails if it does not.
inline std::vector<Problem> problems_of(const std::string& objects) {
  try {
    scene_of(objects);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.problems();
  }
  ADD_FAILURE() << "no error in " << objects;
  return {Problem{}};
}

/// Expects one problem at "line:column" with a remedy.
inline void expect_problem(const std::string& objects, const std::string& place,
                           const std::string& message, const std::string& remedy = {}) {
  SCOPED_TRACE(objects);
  const std::vector<Problem> problems = problems_of(objects);
  ASSERT_EQ(problems.size(), 1u) << problems[1].message;
  const Problem& p = problems[0];
  EXPECT_EQ(std::to_string(p.place.line) + ":" + std::to_string(p.place.column), place)
      << p.message;
  EXPECT_NE(p.message.find(message), std::string::npos) << p.message;
  EXPECT_FALSE(p.remedy.empty()) << p.message;
  EXPECT_NE(p.remedy.find(remedy), std::string::npos) << p.remedy;
}

}  // namespace kaustik::test
