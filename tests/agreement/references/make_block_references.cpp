// make_block_references [NAME ...]: makes tests/agreement/references/NAME.exr, which the tests of
// this folder compare with; without names all. Takes minutes.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "kaustik/base/error.h"
#include "tests/agreement/pixel_tests.h"
#include "tests/agreement/scenes.h"

int main(int argc, char** argv) {
  using namespace kaustik::agreement;
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  size_t made = 0;
  try {
    for (const ReferenceRecipe& recipe : reference_recipes()) {
      if (!wanted.empty() && std::count(wanted.begin(), wanted.end(), recipe.name) == 0) continue;
      const auto start = std::chrono::steady_clock::now();
      const std::string path = reference_path(recipe.name);
      Components components;
      for (const BlockRender& part : recipe.parts)
        components.merge(recipe.is_of_pixels ? render_replicates(part).pixels
                                             : render_blocks(part));
      if (recipe.is_of_pixels)
        write_pixels(moments_of(components), path);
      else
        write_blocks(components, path);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      std::printf("%s: %.1f s\n", recipe.name.c_str(), seconds.count());
      ++made;
    }
  } catch (const kaustik::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  if (!wanted.empty() && made < wanted.size()) {
    std::fprintf(stderr, "make_block_references: of these scenes there are no recipes\n");
    return 2;
  }
  return 0;
}
