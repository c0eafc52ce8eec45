#pragma once
// Which scenes are rendered by what: references by the methods that find a component best without
// bias, and the methods that are compared with them.

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/agreement/block_samples.h"

namespace kaustik::agreement {

/// Renders whose components together are a reference. No component is in two of them.
struct ReferenceRecipe {
  std::string name;  ///< of the file: the scene, and what sets it apart
  std::vector<BlockRender> parts;
  /// Kept as pixels, their means and errors (pixel_tests.h), instead of all renders' blocks.
  bool is_of_pixels = false;
};
const std::vector<ReferenceRecipe>& reference_recipes();
/// Throws std::invalid_argument if there is none.
const ReferenceRecipe& recipe_of(const std::string& name);

/// A method that is compared with a reference.
struct Contender {
  std::string reference;  ///< ReferenceRecipe::name
  BlockRender render;
  /// How far each of 4 × 4 parts of the picture may be from the reference, for methods that are
  /// consistent but have a bias at a finite number of passes; 0: has no bias at all.
  double tolerance = 0;
  /// Merged light of each of these parts may be away by what the method tells of its own bias, and
  /// no more; direct light has none.
  bool tells_bias = false;
  std::string note = {};  ///< tells rows of one method in one scene apart
};
const std::vector<Contender>& contenders();
/// For messages of gtest.
void PrintTo(const Contender& contender, std::ostream* out);

std::string reference_path(const std::string& name);

}  // namespace kaustik::agreement
