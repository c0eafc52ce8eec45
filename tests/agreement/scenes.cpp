#include "tests/agreement/scenes.h"

#include <ostream>

namespace kaustik::agreement {

std::string reference_path(const std::string& name) {
  return std::string(KAUSTIK_SOURCE_DIR) + "/tests/agreement/references/" + name + ".exr";
}

namespace {

BlockRender by(const std::string& integrator, const std::string& components, uint32_t passes,
               uint32_t samples) {
  BlockRender render;
  render.integrator = integrator;
  render.components = components;
  render.passes = passes;
  render.samples = samples;
  return render;
}

ReferenceRecipe recipe(const std::string& name, const std::string& scene, int size,
                       std::vector<BlockRender> parts) {
  for (BlockRender& part : parts) {
    part.scene = scene;
    part.size = size;
    part.first_seed = 1'000'000;
  }
  return {name, std::move(parts)};
}

/// Merges in disks of so small a part of the scene that the bias is below the tolerance: what is
/// left of it is light at edges that are nearer than a radius.
constexpr double narrow_radius_share = 2e-4, narrow_tolerance = 0.01;
/// With radii of their own, about a pixel wide and more at the first passes: a sixteenth of the
/// picture has 64 × 64 pixels, of which about one in sixteen is so near to its border that light is
/// taken from beyond, and lights differ by up to their own size there.
constexpr double own_tolerance = 0.05;

/// Seeds are those of no other render of the scene.
Contender contender(const std::string& reference, uint64_t first_seed, BlockRender render) {
  const bool is_small = reference.ends_with("_64");
  render.scene = is_small ? reference.substr(0, reference.size() - 3) : reference;
  render.size = is_small ? 64 : 256;
  render.first_seed = first_seed;
  return {reference, std::move(render)};
}

Contender narrow(Contender of) {
  of.render.radius_share = narrow_radius_share;
  of.tolerance = narrow_tolerance;
  return of;
}

Contender with_own_radii(Contender of) {
  of.tolerance = own_tolerance;
  return of;
}

}  // namespace

const std::vector<ReferenceRecipe>& reference_recipes() {
  static const std::vector<ReferenceRecipe> recipes = {
      recipe("cornell_box_64", "cornell_box", 64, {by("path", "direct,indirect", 1, 32)}),
      recipe("cornell_box", "cornell_box", 256, {by("path", "direct,indirect", 1, 16)}),
      recipe("cornell_spheres", "cornell_spheres", 256,
             {by("path", "direct", 1, 8), by("lighttracer", "caustic,indirect", 1, 16)}),
      recipe("metal_ring", "metal_ring", 256, {by("lighttracer", "caustic", 1, 8)}),
      recipe("museum", "museum", 256, {by("path", "direct", 1, 8)}),
  };
  return recipes;
}

void PrintTo(const Contender& contender, std::ostream* out) {
  *out << contender.render.integrator << " in " << contender.reference;
}

// Paths from the camera alone find focused light by rare chance: no sum of so few is normal.
const std::vector<Contender>& contenders() {
  const std::string lit = "direct,indirect", all = "direct,caustic,indirect";
  static const std::vector<Contender> table = {
      contender("cornell_box_64", 1000, by("path", lit, 1, 8)),
      contender("cornell_box_64", 2000, by("lighttracer", lit, 1, 8)),
      contender("cornell_box_64", 3000, by("bdpt", lit, 1, 4)),
      narrow(contender("cornell_box_64", 4000, by("vcm", lit, 1, 4))),
      contender("cornell_box", 5000, by("path", lit, 1, 8)),
      contender("cornell_box", 6000, by("lighttracer", lit, 1, 8)),
      contender("cornell_box", 7000, by("bdpt", lit, 1, 4)),
      narrow(contender("cornell_box", 8000, by("vcm", lit, 1, 4))),
      with_own_radii(contender("cornell_box", 9000, by("ppm", lit, 2, 4))),
      with_own_radii(contender("cornell_box", 10000, by("auto", lit, 2, 4))),
      with_own_radii(contender("cornell_box", 11000, by("photonmap", lit, 1, 4))),
      contender("cornell_spheres", 12000, by("path", "direct", 1, 8)),
      contender("cornell_spheres", 13000, by("lighttracer", all, 1, 8)),
      contender("cornell_spheres", 14000, by("bdpt", all, 1, 4)),
      narrow(contender("cornell_spheres", 15000, by("vcm", all, 1, 4))),
      contender("metal_ring", 19000, by("lighttracer", "caustic", 1, 8)),
      contender("metal_ring", 20000, by("bdpt", "caustic", 1, 4)),
      narrow(contender("metal_ring", 21000, by("vcm", "caustic", 1, 4))),
      contender("museum", 31000, by("path", "direct", 1, 8)),
      contender("museum", 33000, by("bdpt", "direct", 1, 4)),
  };
  return table;
}

}  // namespace kaustik::agreement
