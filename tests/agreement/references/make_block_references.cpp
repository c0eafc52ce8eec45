// make_block_references [NAME ...]: makes tests/agreement/references/NAME.exr, which the tests of
// this folder compare with; without names all. Takes minutes. "gallery" or "gallery/bsdf_phong": of
// all scenes of the gallery or of one.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "kaustik/base/error.h"
#include "tests/agreement/gallery.h"
#include "tests/agreement/pixel_tests.h"
#include "tests/agreement/scenes.h"

int main(int argc, char** argv) {
  using namespace kaustik::agreement;
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  const auto is_wanted = [&](const std::string& name) {
    return wanted.empty() || std::count(wanted.begin(), wanted.end(), name) > 0;
  };
  size_t made = 0;
  try {
    bool is_gallery_made = false;
    for (const std::string& scene : gallery_scenes()) {
      const bool by_itself = is_wanted("gallery/" + scene);
      if (!by_itself && !is_wanted("gallery")) continue;
      write_blocks(render_blocks(gallery_reference(scene)), gallery_path(scene));
      std::printf("gallery/%s\n", scene.c_str());
      if (by_itself || !is_gallery_made) ++made;
      is_gallery_made = true;
    }
    for (const ReferenceRecipe& recipe : reference_recipes()) {
      if (!is_wanted(recipe.name)) continue;
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
