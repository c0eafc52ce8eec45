#pragma once
#include <memory>
#include <string>

namespace kaustik {

/// Where something stands in its file; line and column count from 1, 0 means unknown. For values
/// that come from the command line or from Python `file` names the origin instead.
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;
};

inline Place place_in(std::string file, int line = 0, int column = 0) {
  return {std::make_shared<const std::string>(std::move(file)), line, column};
}

}  // namespace kaustik
