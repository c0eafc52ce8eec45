#include "kaustik/base/to_integer.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"
#include "kaustik/material/tile_row.h"
#include "kaustik/material/wood_shade.h"

namespace kaustik {
namespace {

/// Planks that are told apart; farther out floats have lost them.
float within_cells(float x) { return std::clamp(x, -1e6f, 1e6f); }

/// Wood whose grain runs along x: year rings about the axis of the trunk, fibres and pores along
/// it; on request sawn into planks, each from another place of a trunk.
class Wood final : public Texture {
 public:
  explicit Wood(const Arguments& arguments)
      : early_(color_argument(arguments, "color0")),
        late_(color_argument(arguments, "color1")),
        ring_(float(arguments.number("ring_width"))),
        depth_(float(arguments.number("depth"))),
        plank_width_(float(arguments.number("plank_width"))),
        plank_length_(float(arguments.number("plank_length"))),
        seed_(uint32_t(arguments.integer("seed"))),
        space_(arguments.transform("to_world")),
        shade_(ring_, float(arguments.number("grain")), seed_) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    const Piece piece = piece_at(space_.point(at), space_.width(at));
    return mixed(early_.at(wavelengths), late_.at(wavelengths), shade_(piece.p, space_.width(at))) *
           piece.brightness;
  }
  float maximum() const override {
    return std::max(early_.rgb().max_lane(), late_.rgb().max_lane());
  }
  Spectrum mean() const override;
  HeightGradient height_gradient(const TextureCoordinates& at) const override;

 private:
  /// A point in the trunk that it was sawn from.
  struct Piece {
    Vec3f p;                  ///< m
    float brightness = 1;     ///< of the plank; dark in the gaps beside it
    float to_gap = infinity;  ///< distance to the plank's edge, m
  };
  Piece piece_at(const Vec3f& p, float width) const;
  float height(const Vec3f& p, float width) const;

  /// Of a plank by its uniform number, where so much of it is no gap.
  static float brightness(float tone, float wood) {
    return (1 - 0.3f * tone) * (0.25f + 0.75f * wood);
  }
  /// From the end of one on.
  static TileRow between_gaps(float period) { return {std::max(0.0f, period - gap_), period}; }

  static constexpr float gap_ = 0.0012f;  ///< between planks, m

  SpectralValue early_, late_;
  float ring_, depth_, plank_width_, plank_length_;
  uint32_t seed_;
  SpaceTransform space_;
  WoodShade shade_;
};

Wood::Piece Wood::piece_at(const Vec3f& p, float width) const {
  Piece piece{p};
  int row = 0, column = 0;
  if (plank_width_ > 0) {
    const float y = within_cells(p.y / plank_width_);
    row = lattice_cell(y);
    const float shift = cell_random(row, 0, 1, seed_);
    const float x = within_cells(p.x / plank_length_ + shift);
    column = lattice_cell(x);
    const float fy = y - float(row), fx = x - float(column);
    piece.to_gap =
        std::min(std::min(fy, 1 - fy) * plank_width_, std::min(fx, 1 - fx) * plank_length_);
    const float visible = std::max(0.0f, 1 - width / plank_width_);
    const float tone = 0.5f + visible * (cell_random(row, column, 2, seed_) - 0.5f);
    const float wood =
        between_gaps(plank_width_).coverage(fy * plank_width_ - 0.5f * gap_, width) *
        between_gaps(plank_length_).coverage(fx * plank_length_ - 0.5f * gap_, width);
    piece.brightness = brightness(tone, wood);
  }
  // The heart of the trunk lies beside the board, so that flat and standing rings both occur.
  const float across = cell_random(row, column, 3, seed_) - 0.5f;
  const float below = 3 + 14 * cell_random(row, column, 4, seed_);
  piece.p.x += 40 * cell_random(row, column, 5, seed_);
  piece.p.y +=
      (24 * across - (plank_width_ > 0 ? (float(row) + 0.5f) * plank_width_ / ring_ : 0)) * ring_;
  piece.p.z += below * ring_;
  return piece;
}

Spectrum Wood::mean() const {
  const Spectrum wood = mixed(early_.rgb(), late_.rgb(), shade_.mean());
  if (!(plank_width_ > 0)) return wood;
  const TileRow across = between_gaps(plank_width_), along = between_gaps(plank_length_);
  return wood * brightness(0.5f, across.size / across.period * (along.size / along.period));
}

float Wood::height(const Vec3f& p, float width) const {
  const Piece piece = piece_at(p, width);
  const float edge = plank_width_ > 0 ? smooth_step(0, 0.0025f, piece.to_gap) : 1.0f;
  return depth_ * shade_.fibres(piece.p, width) + 0.0008f * edge;
}

HeightGradient Wood::height_gradient(const TextureCoordinates& at) const {
  const Vec3f p = space_.point(at);
  const float width = space_.width(at);
  const float step = std::max(0.5f * width, 0.02f * ring_);
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f a = p, b = p;
    a[axis] -= step;
    b[axis] += step;
    gradient[axis] = (height(b, width) - height(a, width)) / (b[axis] - a[axis]);
  }
  return {{0, 0}, space_.gradient(gradient)};
}

const TypeInfo& wood_info() {
  static const TypeInfo info{
      "texture",
      "wood",
      "Wood with its grain along x, in one piece or as planks in the xy plane. As a bump map it "
      "has fibres and gaps.",
      {texture_color("color0", {0.48, 0.28, 0.14}, "Colour of early wood."),
       texture_color("color1", {0.20, 0.09, 0.035}, "Colour of late wood."),
       number_parameter("ring_width", 0.006, "Distance between year rings.")
           .range(1e-6, 1e6)
           .in("m"),
       number_parameter("grain", 0.35, "Strength of fibres and pores.").range(0, 1),
       number_parameter("depth", 0.00005, "Height of the fibres, in bump maps.")
           .range(0, 1e6)
           .in("m"),
       number_parameter("plank_width", 0, "Width of the planks; 0: one piece.")
           .range(0, 1e6)
           .in("m"),
       number_parameter("plank_length", 1.4, "Length of the planks, along x.")
           .range(1e-6, 1e6)
           .in("m"),
       seed_parameter(), texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_wood(const TextureInputs& in) {
  return std::make_shared<Wood>(in.arguments);
}

}  // namespace

TextureType wood_type() { return {wood_info(), create_wood}; }

}  // namespace kaustik
