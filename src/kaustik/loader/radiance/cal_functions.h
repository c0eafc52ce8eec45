#pragma once
// What Radiance's function files know without defining it.

#include <cstddef>
#include <string_view>

namespace kaustik::radiance {

/// A function of numbers.
struct CalFunction {
  std::string_view name;
  size_t arguments;
  double (*function)(const double* arguments);
};

/// Null: there is none of that name.
const CalFunction* find_cal_function(std::string_view name);

/// Noise over space between −1 and 1, with zeros at whole numbers (Perlin, "An Image Synthesizer",
/// SIGGRAPH 1985): as smooth as Radiance's, but with other hills. Component 0 is the value, 1 to 3
/// are its derivatives.
double cal_noise(int component, double x, double y, double z);

/// Definitions that all function files see: constants, A1 to A10, U and V of planes.
std::string_view cal_start();
/// A file of Radiance's library that is built in ("picture.cal"); "" for others.
std::string_view cal_library_file(std::string_view name);

}  // namespace kaustik::radiance
