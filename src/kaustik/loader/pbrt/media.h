#pragma once
#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/described.h"
#include "kaustik/loader/pbrt/spectra.h"

namespace kaustik::pbrt {

/// A named medium as a file defines it. It is made when a surface or the camera names it.
struct MediumDefinition {
  std::string type;
  ParameterList parameters;
  Owner owner;  ///< "medium 'smoke'"
  Transform to_world;
};

/// What Kaustik calls a substance that pbrt knows the coefficients of; "": it knows none.
std::string substance_named(const std::string& name);
/// "did you mean …?", of the substances; "" where none is near.
std::string substance_suggestion(const std::string& name);

class Media {
 public:
  Media(SceneFiles& files, Spectra& spectra, Ids& ids, Deviations& deviations)
      : files_(files), spectra_(spectra), ids_(ids), deviations_(deviations) {}

  void define(const std::string& name, MediumDefinition definition);
  /// Null for "", for a name that nothing has (which is told), and for what Kaustik can't render.
  std::shared_ptr<Object> named(const std::string& name, const Place& place);

 private:
  struct Entry {
    MediumDefinition definition;
    std::shared_ptr<Object> made;
    bool is_made = false;
  };
  using Maker = std::shared_ptr<Object> (Media::*)(const MediumDefinition&);
  static const std::map<std::string_view, Maker>& makers();

  std::shared_ptr<Object> make(const MediumDefinition& definition);
  std::shared_ptr<Object> make_homogeneous(const MediumDefinition& definition);
  std::shared_ptr<Object> make_grid(const MediumDefinition& definition);
  std::shared_ptr<Object> make_colour_grid(const MediumDefinition& definition);
  std::shared_ptr<Object> with_phase(std::shared_ptr<Object> medium,
                                     const MediumDefinition& definition);
  std::shared_ptr<Object> make_nanovdb(const MediumDefinition& definition);
  std::shared_ptr<Object> make_cloud(const MediumDefinition& definition);
  Rgb coefficient(const MediumDefinition& definition, const char* name);
  /// sigma_s, and sigma_s + sigma_a.
  struct Coefficients {
    Rgb scattering, extinction;
    bool is_grey() const { return extinction.r == extinction.g && extinction.r == extinction.b; }
    size_t components() const { return is_grey() ? 1 : 3; }
  };
  Coefficients coefficients(const MediumDefinition& definition);
  /// What scatters by the coefficients times a density, x running fastest, in cells that fill the
  /// box to which the unit cube goes.
  template <typename Number>
  std::shared_ptr<Object> with_density(const MediumDefinition& definition,
                                       const Coefficients& coefficients,
                                       std::span<const Number> density,
                                       const std::array<size_t, 3>& size,
                                       const Transform& to_world);
  /// From p0 to p1, in the medium's space.
  struct Box {
    Vec3d low, size;
    Transform to_world;  ///< of the unit cube
  };
  /// Throws Error(input) where it has no volume.
  static Box box_of(const MediumDefinition& definition);
  std::shared_ptr<Object> grid_volume(const MediumDefinition& definition,
                                      std::vector<size_t> extents, std::vector<float> samples,
                                      const Transform& to_world);

  SceneFiles& files_;
  Spectra& spectra_;
  Ids& ids_;
  Deviations& deviations_;
  std::map<std::string, Entry> entries_;
};

}  // namespace kaustik::pbrt
