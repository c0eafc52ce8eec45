#pragma once
#include <string>
#include <vector>

namespace kaustik::test {

/// Of a command line, without the program's name.
using Arguments = std::vector<std::string>;

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace kaustik::test
