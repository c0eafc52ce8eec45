#pragma once
// Named textures of pbrt, and parameters that name them.

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/described.h"
#include "kaustik/loader/pbrt/spectra.h"
#include "kaustik/loader/pbrt/surface_mapping.h"

namespace kaustik::pbrt {

/// A texture as a file defines it. It is made when something asks for it.
struct TextureDefinition {
  std::string name, type;
  bool is_float = false;
  ParameterList parameters;
  Owner owner;         ///< "texture 'wood'"
  Transform to_world;  ///< of mappings in space
};

class Textures {
 public:
  Textures(SceneFiles& files, Spectra& spectra, Deviations& deviations)
      : files_(files), spectra_(spectra), deviations_(deviations) {}

  void define(TextureDefinition definition);

  /// A parameter that is a spectrum or a texture of spectra.
  Input colour(const ParameterList& list, std::string_view name, const Owner& owner);
  /// A parameter that is a number or a texture of numbers.
  Input number(const ParameterList& list, std::string_view name, const Owner& owner);
  /// The square root of such a number, as roughness is turned into the facets' slope.
  Input root_of_number(const ParameterList& list, std::string_view name, const Owner& owner);

  /// A picture over uv, with v from its lower edge on; a chequered stand-in where it is missing.
  /// `raw`: its numbers are linear whatever the file says.
  std::shared_ptr<Object> picture(const std::string& file, bool raw, const Owner& owner,
                                  const Place& place);

  /// While it lives, what textures that are asked for lie by is put into a set.
  class Collecting {
   public:
    Collecting(Textures& textures, MappingSet& set)
        : textures_(textures), before_(std::exchange(textures.collected_, &set)) {}
    ~Collecting() { textures_.collected_ = before_; }
    Collecting(const Collecting&) = delete;
    Collecting& operator=(const Collecting&) = delete;

   private:
    Textures& textures_;
    MappingSet* before_;
  };
  const SurfaceMappings& mappings() const { return mappings_; }

 private:
  struct Entry {
    TextureDefinition definition;
    Input made;
    MappingSet mappings;
    enum class State : uint8_t { unmade, being_made, made } state = State::unmade;
  };

  /// Null: there is none. The last one before its user, or else the first one.
  Entry* find(const std::string& name, bool is_float, size_t sequence);
  const Input& made(Entry& entry);
  using Maker = Input (Textures::*)(const TextureDefinition&);
  static const std::map<std::string_view, Maker>& makers();
  Input make(const TextureDefinition& definition);
  Input make_constant(const TextureDefinition& definition);
  Input make_image(const TextureDefinition& definition);
  Input make_dots(const TextureDefinition& definition);
  Input make_ptex(const TextureDefinition& definition);
  Input make_picture(const TextureDefinition& definition, double power);
  Input make_scale(const TextureDefinition& definition);
  Input make_mix(const TextureDefinition& definition);
  Input make_checkerboard(const TextureDefinition& definition);
  Input make_bilinear(const TextureDefinition& definition);
  Input make_noise(const TextureDefinition& definition);
  Input root_of(Entry& entry);
  /// Of numbers, or else of colours: files of pbrt-v3 give numbers by these. Null: there is none.
  Entry* find_number(const std::string& name, size_t sequence);
  /// A value of the texture's kind; `otherwise` where it is not given.
  Input part(const TextureDefinition& definition, const char* name, double otherwise);
  Input named(const Parameter& parameter, bool is_float, const Owner& owner);
  /// Of uv to what the texture's own coordinates are. Mappings in space are those of shapes.
  Transform mapping(const TextureDefinition& definition);
  void laid_by(size_t mapping) {
    // One alone can be had; of many a few are told.
    constexpr size_t most = 16;
    if (collected_ && collected_->size() < most) collected_->insert(mapping);
  }

  SceneFiles& files_;
  Spectra& spectra_;
  Deviations& deviations_;
  std::vector<std::unique_ptr<Entry>> entries_;
  /// Those of colours, and those of numbers.
  std::map<std::string, std::array<std::vector<size_t>, 2>> by_name_;
  SurfaceMappings mappings_;
  MappingSet* collected_ = nullptr;
  int depth_ = 0;
};

}  // namespace kaustik::pbrt
