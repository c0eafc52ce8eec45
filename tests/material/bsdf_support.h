#pragma once
// Builds bsdfs as a scene file would, and the table of instances that every property is tested on.

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kaustik/material/bsdf.h"
#include "kaustik/material/direction_grid.h"

namespace kaustik::test {

/// Throws Error as build_scene() would.
std::shared_ptr<const Bsdf> make_bsdf(
    const std::string& type, const std::vector<Property>& properties = {},
    std::vector<std::shared_ptr<const Bsdf>> nested = {},
    std::map<std::string, std::shared_ptr<const Texture>> textures = {},
    const std::function<void(const std::string&)>& warn = [](const std::string&) {});
/// With the values that a scene need not give, around matt bsdfs if it is made of others.
std::shared_ptr<const Bsdf> make_usual_bsdf(const BsdfType& type);
/// Throws Error as build_scene() would, with places in scene.xml. The surface that it lies on has
/// the attribute "vertex_color", a SlantedAttribute.
std::shared_ptr<const Texture> make_texture(
    const std::string& type, std::vector<Property> properties = {},
    std::map<std::string, std::shared_ptr<const Texture>> textures = {},
    std::map<std::string, std::shared_ptr<const Volume>> volumes = {});
/// A grid of colours over a cube with edges of 4 m, again and again.
std::shared_ptr<const Volume> repeated_volume();
/// With the values that a scene need not give; what it must have is given: `picture` is a file, and
/// a volume is the repeated one.
std::shared_ptr<const Texture> make_usual_texture(const TextureType& type,
                                                  const std::string& picture,
                                                  std::vector<Property> properties = {});

/// Grey that changes with x, the same for all primitives: 0.5 in the mean over places that lie
/// evenly about the origin.
class SlantedAttribute final : public SurfaceAttribute {
 public:
  Vec3f at(uint32_t, const Vec3f& position) const override {
    return Vec3f(0.5f + 0.4f * std::sin(position.x));
  }
  Vec3f gradient(uint32_t, const Vec3f& weights) const override {
    return {weights.x + weights.y + weights.z, 0, 0};
  }
  Vec3f mean() const override { return Vec3f(0.5f); }
  float maximum() const override { return 0.9f; }
};
Property property(const std::string& name, Value value);

/// Of a point; a new one for each question, since it remembers what textures gave.
inline BsdfContext radiance() { return {{}, TransportMode::radiance, {}}; }
inline BsdfContext flux() { return {{}, TransportMode::flux, {}}; }

struct BsdfInstance {
  std::string name;
  std::shared_ptr<const Bsdf> bsdf;
  double albedo_error = 0.03;  ///< what share the albedo of glossy lobes may be off by
};
/// One at least of every registered type that has lobes: where none is listed, the usual one.
const std::vector<BsdfInstance>& bsdf_instances();

/// From the normal to grazing, on several azimuths; unit, all with z > 0.
const std::vector<Vec3f>& outgoing_directions();

/// The sets of lobes that this one can be asked for: each of its own and all.
std::vector<Lobes> lobe_sets(const Bsdf& bsdf);

/// How much is drawn, and which error so many samples still find: their number goes with its
/// inverse square.
struct Effort {
  int samples;
  double planted_error;
};
inline constexpr Effort at_length = {110000, 0.03};
#ifdef KAUSTIK_SLOW_BUILD
inline constexpr Effort quick = {5000, 0.145};
#else
inline constexpr Effort quick = {40000, 0.055};
#endif

}  // namespace kaustik::test
