#pragma once
#include <string>
#include <vector>

namespace kaustik {

/// What lights are beside that are made of a file of measurements: they can say what is in it.
class MeasuredLight {
 public:
  virtual ~MeasuredLight() = default;
  /// For reports, such as "1494 lm in its file, …"; "": nothing.
  virtual const std::string& report() const = 0;
  /// What is odd in the file and how it was taken, a sentence each.
  virtual const std::vector<std::string>& remarks() const = 0;
};

}  // namespace kaustik
