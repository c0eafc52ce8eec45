#pragma once
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace kaustik::test {

/// Of the rows of a registry: each is of that family, is told of in a sentence, and has a name that
/// no other has; so have its parameters.
template <typename Rows>
void expect_rows_of(const std::string& family, const Rows& rows) {
  std::set<std::string> names;
  for (const auto& row : rows) {
    SCOPED_TRACE(row.info.name);
    EXPECT_EQ(row.info.family, family);
    EXPECT_FALSE(row.info.name.empty());
    EXPECT_FALSE(row.info.sentence.empty());
    EXPECT_TRUE(names.insert(row.info.name).second) << "there are two rows of this name";
    std::set<std::string> parameters;
    for (const auto& parameter : row.info.parameters)
      EXPECT_TRUE(parameters.insert(parameter.name).second) << parameter.name << " stands twice";
  }
  EXPECT_FALSE(names.empty());
}

}  // namespace kaustik::test
