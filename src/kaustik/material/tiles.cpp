#include "kaustik/base/to_integer.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/noise.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"
#include "kaustik/material/tile_row.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// Where a point lies in the pattern.
struct Place {
  Vec2f at;      ///< m, from the corner of tile (0, 0), rows shifted
  Vec2f width;   ///< of the footprint, m
  int axis = 2;  ///< that the plane of the tiles is at right angles to
};

/// Tiles with joints between them. In space the pattern lies on the planes of the axes, each point
/// in the one that its normal is nearest to, so that floors and walls fit together.
class Tiles final : public Texture {
 public:
  explicit Tiles(const Arguments& arguments)
      : color_(color_argument(arguments, "color")),
        joint_color_(color_argument(arguments, "joint_color")),
        joint_(float(arguments.number("joint"))),
        rows_{
            {float(arguments.number("tile_width")), float(arguments.number("tile_width")) + joint_},
            {float(arguments.number("tile_height")),
             float(arguments.number("tile_height")) + joint_}},
        offset_(float(arguments.number("offset"))),
        variation_(float(arguments.number("variation"))),
        bevel_(float(arguments.number("bevel"))),
        depth_(float(arguments.number("depth"))),
        tilt_(float(arguments.number("tilt"))),
        seed_(uint32_t(arguments.integer("seed"))),
        in_space_(arguments.text("projection") == "box"),
        space_(arguments.transform("to_world")),
        to_uv_(arguments.transform("to_uv")) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override;
  float maximum() const override {
    return std::max(color_.rgb().max_lane(), joint_color_.rgb().max_lane());
  }
  /// Exact where all of the pattern is seen.
  Spectrum mean() const override {
    const float tile = rows_[0].size * rows_[1].size / (rows_[0].period * rows_[1].period);
    return color_.rgb() * (tile * (1 - 0.5f * variation_)) + joint_color_.rgb() * (1 - tile);
  }
  HeightGradient height_gradient(const TextureCoordinates& at) const override;

 private:
  Place place(const TextureCoordinates& at) const;
  float random(const Place& place, uint32_t which) const {
    return cell_random(lattice_cell(place.at.x / rows_[0].period),
                       lattice_cell(place.at.y / rows_[1].period), place.axis, seed_ * 8 + which);
  }
  /// How much of what differs from tile to tile is left in the mean over a footprint.
  float tile_visibility(const Place& place) const {
    return std::max(0.0f,
                    1 - std::max(place.width.x / rows_[0].period, place.width.y / rows_[1].period));
  }

  SpectralValue color_, joint_color_;
  float joint_;
  TileRow rows_[2];
  float offset_, variation_, bevel_, depth_, tilt_;
  uint32_t seed_;
  bool in_space_;
  SpaceTransform space_;
  UvTransform to_uv_;
};

Place Tiles::place(const TextureCoordinates& at) const {
  Place place;
  if (in_space_) {
    const Vec3f p = space_.point(at), n = space_.normal(at);
    const Vec3f size(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
    place.axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    place.at = place.axis == 0   ? Vec2f(p.y, p.z)
               : place.axis == 1 ? Vec2f(p.x, p.z)
                                 : Vec2f(p.x, p.y);
    place.width = Vec2f(1, 1) * space_.width(at);
  } else {
    place.at = to_uv_(at.uv);
    place.width = to_uv_.width(at.uv_width);
  }
  // Half a joint before the first tile: the joints' middles lie on the axes.
  place.at -= Vec2f(0.5f, 0.5f) * joint_;
  // Beyond a million tiles floats have no room for one.
  for (int i = 0; i < 2; ++i)
    place.at[i] = std::clamp(place.at[i], -1e6f * rows_[i].period, 1e6f * rows_[i].period);
  place.at.x -= offset_ * rows_[0].period * std::floor(place.at.y / rows_[1].period);
  return place;
}

Spectrum Tiles::eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const {
  const Place p = place(at);
  const float tile = rows_[0].coverage(p.at.x, p.width.x) * rows_[1].coverage(p.at.y, p.width.y);
  const float visible = tile_visibility(p);
  const float darker = variation_ * (0.5f + visible * (random(p, 0) - 0.5f));
  return mixed(joint_color_.at(wavelengths), color_.at(wavelengths) * (1 - darker), tile);
}

HeightGradient Tiles::height_gradient(const TextureCoordinates& at) const {
  const Place p = place(at);
  Vec2f gradient(0, 0);
  float to_edge = infinity;
  int nearest = 0;
  Vec2f side(1, 1);
  for (int i = 0; i < 2; ++i) {
    const float rest = p.at[i] - std::floor(p.at[i] / rows_[i].period) * rows_[i].period;
    const float to_start = rest, to_end = rows_[i].size - rest;
    side[i] = to_start < to_end ? 1.0f : -1.0f;
    if (std::min(to_start, to_end) < to_edge) to_edge = std::min(to_start, to_end), nearest = i;
  }
  const float width = std::max(p.width.x, p.width.y);
  if (to_edge > 0 && to_edge < bevel_) {
    // A quarter round: the height d(2 − d) of the distance d from the edge in bevels.
    const float slope = depth_ * 2 * (1 - to_edge / bevel_) / bevel_;
    gradient[nearest] = side[nearest] * slope / (1 + sqr(width / bevel_));
  } else if (to_edge >= bevel_) {
    gradient = Vec2f(random(p, 1) - 0.5f, random(p, 2) - 0.5f) * (2 * tilt_ * tile_visibility(p));
  }
  if (!in_space_) return {to_uv_.gradient(gradient), {0, 0, 0}};
  const Vec3f g = p.axis == 0   ? Vec3f(0, gradient.x, gradient.y)
                  : p.axis == 1 ? Vec3f(gradient.x, 0, gradient.y)
                                : Vec3f(gradient.x, gradient.y, 0);
  return {{0, 0}, space_.gradient(g)};
}

const TypeInfo& tiles_info() {
  static const TypeInfo info{
      "texture",
      "tiles",
      "Tiles and joints, each tile a little different. As a bump map it has rounded edges and "
      "slightly tilted tiles.",
      {texture_color("color", {0.70, 0.72, 0.72}, "Colour of the brightest tiles."),
       texture_color("joint_color", {0.40, 0.39, 0.37}, "Colour of the joints."),
       number_parameter("tile_width", 0.2, "Width of a tile, along x (u).")
           .range(1e-6, 1e6)
           .in("m"),
       number_parameter("tile_height", 0.2, "Height of a tile, along y (v), or along z on walls.")
           .range(1e-6, 1e6)
           .in("m"),
       number_parameter("joint", 0.004, "Width of the joints.").range(0, 1e6).in("m"),
       number_parameter("offset", 0,
                        "Shift of each row against the one below, in tiles; 0.5: bricks.")
           .range(0, 1),
       number_parameter("variation", 0.12, "Largest fraction by which a tile is darker.")
           .range(0, 1),
       number_parameter("bevel", 0.002, "Width of the rounded edge, in bump maps.")
           .range(0, 1e6)
           .in("m"),
       number_parameter("depth", 0.001, "Height of the edge, in bump maps.").range(0, 1e6).in("m"),
       number_parameter("tilt", 0.002, "Largest slope of the tiles, in bump maps.").range(0, 10),
       choice_parameter(
           "projection", "box", {"box", "uv"},
           "Projection on the planes of the texture's space, or by texture coordinates in metres."),
       transform_parameter("to_uv", "Transform of texture coordinates before the lookup."),
       seed_parameter(), texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_tiles(const TextureInputs& in) {
  return std::make_shared<Tiles>(in.arguments);
}

}  // namespace

TextureType tiles_type() { return {tiles_info(), create_tiles}; }

}  // namespace kaustik
