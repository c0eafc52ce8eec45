#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kaustik/base/exact_sum.h"
#include "kaustik/image/image.h"
#include "kaustik/render/packed_tile.h"
#include "kaustik/render/pass_set.h"
#include "kaustik/render/pass_tiles.h"
#include "kaustik/render/pixel_region.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

class BinaryReader;
class BinaryWriter;
struct FilmRegion;

/// Estimates of the bias are summed apart for even and for odd replicates.
inline constexpr uint32_t bias_halves = 2;

/// Of these components the luminance is summed apart for odd replicates.
constexpr std::array<Component, 5> halved_components() {
  return {Component::direct, Component::caustic, Component::indirect, Component::specular,
          Component::volume};
}

/// What a film holds beside what all of them do.
struct FilmLayers {
  ComponentSet components;
  bool bias = false;  ///< estimates of the bias
  /// What images with layers hold beside the picture: its components, what is seen, errors and
  /// noise of pixels. Without, the film takes less memory.
  bool in_images = true;
  bool pixels_are_apart = false;  ///< each is a measurement of its own: its
                                  ///< error is told by it alone
  /// With what images with layers hold: the luminances of odd replicates apart, by component. Films
  /// of files from before there were such lack them.
  bool halves = true;
  bool holds_halves() const { return in_images && halves; }
  static FilmLayers of(const Integrator& integrator, bool in_images = true,
                       bool pixels_are_apart = false) {
    return {integrator.traits().components, integrator.traits().estimates_bias, in_images,
            pixels_are_apart};
  }
  friend bool operator==(const FilmLayers&, const FilmLayers&) = default;
};

/// Which numbers a film sums up of each pixel, in their order.
struct FilmNumbers {
  static constexpr size_t lanes = 3, first_hit_lanes = 8;

  explicit FilmNumbers(const FilmLayers& layers);

  /// [component][lane]; [lane] of all components together where images have no layers, and then of
  /// what follows up to the luminances of replicates only what shows lamps.
  size_t radiance = 0;
  size_t emission = 0;           ///< [lane], of that component; among those if images have layers
  size_t lamps = 0;              ///< FirstHit::lamps; in the same way
  size_t squares = 0;            ///< [lane], of the whole
  size_t first_hit = 0;          ///< [albedo 3, normal 3, depth 1, lamps 1]
  size_t sample_squares = 0;     ///< [kind of light]
  size_t inverse_samples = 0;    ///< one over the samples of a pass: passes count alike
  size_t luminance_squares = 0;  ///< of the passes
  size_t replicate_luminances = 0;  ///< [replicate]
  size_t bias = 0;                  ///< [half][lane], if held
  /// [component but emission], of odd replicates, if held; what emission has is left of
  /// `replicate_luminances`.
  size_t odd_luminances = 0;
  size_t count = 0;
};

/// What a file tells of a film before its sums.
struct FilmHead {
  Vec2i size{0, 0};
  FilmLayers layers;
  bool has_regions = false;
  uint64_t samples_per_pixel = 0;
  PassSet passes;
};

/// What a film holds beside the sums of its pixels.
struct FilmFacts {
  PassSet passes;
  uint64_t samples_per_pixel = 0;  ///< on average
  std::array<Fixed, replicate_count> mean_luminances{};
};

/// The picture as the sum of its finished passes and of their squares, in exact arithmetic: the
/// same bits in whatever order the passes come, and whether they come one by one or as another
/// film's sums. What only errors are computed from is rounded in each pass before it is summed:
/// round_line().
///
/// Regions of it may have passes of their own beside. A pixel is the mean of all passes that it
/// has: those of the picture and those of the regions that it lies in.
class Film {
 public:
  /// Throws Error(input) when the picture does not fit into memory, with what its passes take:
  /// check_film_memory().
  Film(const FilmSettings& settings, const FilmLayers& layers, bool splats = false);

  /// Adds a finished pass of so many samples per pixel on average, which must not be there yet. Not
  /// thread-safe.
  void add_pass(const PassTiles& pass, uint32_t pass_index, uint32_t samples = 1);
  /// Adds the passes of another film of this size and these layers; none may be in both, as
  /// `passes` and twice_in_regions() tell.
  void add(const Film& other);
  bool is_like(const Film& other) const { return is_for(other.size_, other.layers_); }
  /// Whether it holds pictures of this size and these layers.
  bool is_for(Vec2i size, const FilmLayers& layers) const {
    return size_ == size && layers_ == layers;
  }
  /// Of all of the picture.
  const PassSet& passes() const { return passes_; }
  uint32_t pass_count() const { return passes_.count(); }
  /// Of those passes, on average.
  uint64_t samples_per_pixel() const { return sample_count_; }

  /// In ascending order; no rectangle comes twice.
  const std::vector<FilmRegion>& regions() const { return regions_; }
  /// Of all regions together.
  uint32_t regional_pass_count() const;
  /// The pass of a region that comes next, with the plans and radii of pass `stage`; without seed
  /// and samples. It goes on with the region's last order where that has the same stage and is the
  /// last of all regions' orders. Else it begins an order, in that replicate of which the region's
  /// pixels have fewest passes: its number may leave some out.
  Pass next_regional_pass(const PixelRegion& pixels, uint32_t stage) const;
  /// Adds that pass: `of_region` are the region's pixels alone.
  void add_regional_pass(const PixelRegion& pixels, const PassTiles& of_region, const Pass& pass);
  /// Passes that some pixel has in both films, by their numbers.
  PassSet twice_in_regions(const Film& other) const;
  /// That a pixel has, regional ones included.
  uint32_t pass_count(size_t pixel) const;
  int width() const { return size_.x; }
  int height() const { return size_.y; }
  size_t pixel_count() const { return size_t(size_.x) * size_t(size_.y); }
  bool holds_bias() const { return layers_.bias; }
  const FilmLayers& layers() const { return layers_; }
  const FilmNumbers& numbers() const { return numbers_; }
  const PictureTiles& tiles() const { return tiles_; }
  /// That it takes; grows with the passes, slowly.
  size_t bytes() const;

  /// The mean of the passes: "R" "G" "B", a layer per component, "albedo", "N", "depth",
  /// "emission.A" (the share of the pixel where lamps are seen), "error"
  /// (standard error of the mean per channel, see FilmErrors), "bias" where the integrator
  /// estimates it (how much the picture is expected to be too bright, per channel), and
  /// "noise.scattered" and "noise.mirrored" (of the photopic value, over all samples, as if they
  /// were independent: what denoising goes by; only from two samples per pixel on). Where there are
  /// passes of even and of odd replicates also "odd", the mean luminance over odd ones of each
  /// component, and "odd.share", the share of a pixel's passes that these are. All zero without a
  /// pass. "R" "G" "B" and "emission" alone if images are to have no layers, or these are
  /// not wanted: that is much sooner made.
  Image image(bool with_layers = true) const;
  /// FilmErrors::of_mean()
  double mean_error() const;
  /// FilmErrors::of_picture()
  double picture_error() const;

  /// The sums as part of a file, and back; reading throws as BinaryReader does.
  void write(BinaryWriter& writer) const;
  static Film read(BinaryReader& reader);
  static FilmHead read_head(BinaryReader& reader);
  /// The film whose head was just read.
  static Film read(const FilmHead& head, BinaryReader& reader);
  /// Adds the passes of the film whose head was just read, of this size and these layers, none of
  /// them there yet; holds a row of tiles of it at a time, and its regions. Returns passes that
  /// some pixel has in regions of both; if there are any, or it throws, this film is of no use.
  PassSet add(const FilmHead& head, BinaryReader& reader);

  // The sums of all passes of the whole picture apart from all else, for films of other processes.
  size_t sums_per_tile() const { return numbers_.count * PictureTiles::pixels; }
  /// Of tiles from the first on, as many as there is room for: [tile][number][place].
  void read_tiles(size_t first, std::span<Fixed> sums) const;
  /// Adds such sums; add_facts() has to follow.
  void add_tiles(size_t first, std::span<const Fixed> sums);
  FilmFacts facts() const { return {passes_, sample_count_, mean_luminances_}; }
  /// None of these passes was there.
  void add_facts(const FilmFacts& facts);
  /// All passes go, those of regions as well.
  void clear();

  // Sums over all passes that pixels have.
  /// All sums of a tile's pixels: [place in the tile][number].
  void read(size_t tile, std::vector<Fixed>& sums) const;
  /// One of them, of all the tile's pixels.
  void read(size_t tile, size_t number, std::array<Fixed, PictureTiles::pixels>& sums) const;
  /// One of one pixel, pixels counted row by row.
  Fixed sum(size_t pixel, size_t number) const;

  // Sums over passes.
  double total(size_t pixel, int lane) const;  ///< over the components
  /// Only if images have layers.
  double total_squares(size_t pixel, int lane) const {
    return double_from(sum(pixel, numbers_.squares + size_t(lane)));
  }
  double luminance_squares(size_t pixel) const {
    return double_from(sum(pixel, numbers_.luminance_squares));
  }
  /// Of the picture's mean luminance, by replicate, in passes of all of it.
  const std::array<Fixed, replicate_count>& mean_luminances() const { return mean_luminances_; }

 private:
  class Addition;
  Film(Vec2i size, const FilmLayers& layers);
  std::vector<std::string> channel_names(bool with_layers) const;
  /// Calls body(sums) with all sums of each row of pixels, [x][number], from the top on.
  /// All after the head but regions.
  void add_content(const FilmHead& head, BinaryReader& reader);
  void add_packed_tiles(BinaryReader& reader);
  void write_packed_tiles(BinaryWriter& writer) const;
  void add_region(const FilmRegion& region);
  void write_regions(BinaryWriter& writer) const;
  /// Of a film of this size and these layers.
  std::vector<FilmRegion> read_regions(BinaryReader& reader) const;
  /// Adds those of regions to the sums of a tile's pixels, [place][number].
  void add_regions(size_t tile, std::vector<Fixed>& sums) const;
  /// Where the region with these pixels is, or would be.
  std::pair<std::vector<FilmRegion>::iterator, bool> place_of(const PixelRegion& pixels);
  /// After all orders there are.
  uint32_t next_regional_number() const;
  bool knows_noise() const { return sample_count_ >= 2; }
  bool knows_halves() const;

  Vec2i size_;
  FilmLayers layers_;
  FilmNumbers numbers_;
  PictureTiles tiles_;
  PassSet passes_;
  uint64_t sample_count_ = 0;  ///< per pixel, on average
  std::vector<PackedTile> sums_;
  std::array<Fixed, replicate_count> mean_luminances_{};
  std::vector<FilmRegion> regions_;
};

/// Passes of a region that were asked for together, as far as they were taken.
struct FilmOrder {
  PassRange passes;    ///< numbers from 0: the index of a pass is that and `first_regional_pass`
  uint32_t stage = 0;  ///< RegionOrder::stage
  friend bool operator==(const FilmOrder&, const FilmOrder&) = default;
};

/// A part of a picture that has passes of its own.
struct FilmRegion {
  PixelRegion pixels;
  Film film;                      ///< of these pixels; its passes have numbers from 0
  std::vector<FilmOrder> orders;  ///< ascending; all that the passes are a function of

  /// Adds the passes of the same region of another film.
  void add(const FilmRegion& other);
  /// "64 x 48 pixels at (10, 20): 32 passes"
  std::string text() const;
};

/// Metadata of a picture whose regions have passes of their own: which, and how many.
inline constexpr const char* regions_key = "regions";

/// Throws Error(input) if these pixels of a picture of this size can't have passes of their own
/// beside other regions: they do not lie in it, or regions would take too much memory.
void check_region(const PixelRegion& pixels, const std::vector<PixelRegion>& others,
                  const Vec2i& size);

/// What is known of all regions, for that; "": there are none.
std::string text_of(const std::vector<FilmRegion>& regions);

}  // namespace kaustik
