#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// The weights of what a mixture mixes.
struct MixtureWeights {
  std::vector<double> numbers;  ///< one for each part, from 0 to a million, not all of them 0
  std::string problem, remedy;  ///< "": the numbers are right; otherwise there are none
};

/// Reads the parameter `weights` of a mixture of `count` parts: a text, or one number. `parts`
/// names these in problems: "nested bsdfs".
MixtureWeights mixture_weights(const Value& weights, size_t count, std::string_view parts);

}  // namespace kaustik
