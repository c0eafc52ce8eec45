#pragma once
// Which scenes are rendered by what: references by the methods that find a component best without
// bias, and the methods that are compared with them.

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/agreement/block_samples.h"

namespace kaustik::agreement {

/// Renders whose components together are the reference of a scene. No component is in two of them.
struct ReferenceRecipe {
  std::string name;  ///< of the file: the scene, or the scene and its size
  std::vector<BlockRender> parts;
};
const std::vector<ReferenceRecipe>& reference_recipes();

/// A method that is compared with a reference.
struct Contender {
  std::string reference;  ///< ReferenceRecipe::name
  BlockRender render;
  /// How far each of 4 × 4 parts of the picture may be from the reference, for methods that are
  /// consistent but have a bias at a finite number of passes; 0: has no bias at all.
  double tolerance = 0;
};
const std::vector<Contender>& contenders();
/// For messages of gtest.
void PrintTo(const Contender& contender, std::ostream* out);

std::string reference_path(const std::string& name);

}  // namespace kaustik::agreement
