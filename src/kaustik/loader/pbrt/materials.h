#pragma once
// Materials of pbrt as bsdfs.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/pbrt/textures.h"

namespace kaustik::pbrt {

/// A material as a file defines it. It is made when a shape has it.
struct MaterialDefinition {
  std::string name;  ///< "" for one without
  std::string type;  ///< of pbrt-v4
  ParameterList parameters;
  Owner owner;  ///< "material 'glass'"
};

/// What shapes of a material hold.
struct MadeMaterial {
  std::shared_ptr<Object> bsdf;
  std::shared_ptr<Object> interior;  ///< a medium that belongs to it; null: none
  bool is_interface = false;         ///< no surface is there
  MappingSet mappings = {};          ///< what its textures lie by
};

/// Which material a shape has: one by its index, or by a name that may be defined later.
struct MaterialReference {
  size_t index = 0;
  std::string name;  ///< "": the index counts
  size_t sequence = 0;
  Place place;

  friend bool operator==(const MaterialReference& a, const MaterialReference& b) {
    return a.index == b.index && a.name == b.name && (a.name.empty() || a.sequence == b.sequence);
  }
};

class Materials {
 public:
  Materials(SceneFiles& files, Textures& textures, Spectra& spectra, Ids& ids,
            Deviations& deviations);

  /// Its index.
  size_t define(MaterialDefinition definition);
  const MadeMaterial& made(const MaterialReference& reference);

 private:
  struct Entry {
    MaterialDefinition definition;
    MadeMaterial made;
    enum class State : uint8_t { unmade, being_made, made } state = State::unmade;
  };

  const MadeMaterial& made(Entry& entry);
  MadeMaterial make(const MaterialDefinition& definition);
  std::shared_ptr<Object> with_relief(std::shared_ptr<Object> bsdf,
                                      const MaterialDefinition& definition);
  MadeMaterial make_mix(const MaterialDefinition& definition);

  SceneFiles& files_;
  Textures& textures_;
  Spectra& spectra_;
  Ids& ids_;
  Deviations& deviations_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::map<std::string, std::vector<size_t>> by_name_;
  int depth_ = 0;
};

/// What makers of single materials work with.
struct MaterialTools : Subject {
  Textures& textures;
  Spectra& spectra;
  const MaterialDefinition& definition;

  const ParameterList& list() const { return definition.parameters; }
  const Owner& owner() const { return definition.owner; }
};

std::shared_ptr<Object> make_diffuse(const MaterialTools& tools);
/// `index`: of its coat, where the file gives none.
std::shared_ptr<Object> make_coated_diffuse(const MaterialTools& tools, double index = 1.5);
std::shared_ptr<Object> make_conductor(const MaterialTools& tools);
std::shared_ptr<Object> make_coated_conductor(const MaterialTools& tools);
std::shared_ptr<Object> make_dielectric(const MaterialTools& tools);
std::shared_ptr<Object> make_thin_dielectric(const MaterialTools& tools);
std::shared_ptr<Object> make_diffuse_transmission(const MaterialTools& tools);
std::shared_ptr<Object> make_hair(const MaterialTools& tools);
std::shared_ptr<Object> make_disney(const MaterialTools& tools);
MadeMaterial make_subsurface(const MaterialTools& tools);

/// Seen from both sides alike, as all opaque materials of pbrt are.
std::shared_ptr<Object> two_sided(std::shared_ptr<Object> bsdf);

/// Slopes of facets, α of the GGX distribution, along u and v.
struct Facets {
  Input u, v;
  bool is_smooth = false;
};
/// Of the parameters roughness, uroughness and vroughness with that prefix ("interface.").
Facets facets_of(const MaterialTools& tools, const std::string& prefix = {}, double otherwise = 0);
/// Gives a rough bsdf its distribution.
void set_facets(Object& bsdf, const Facets& facets);

/// The index of refraction `name`: a number, a named glass, or the middle of a curve, which is
/// told.
double index_of(const MaterialTools& tools, std::string_view name, double otherwise);

}  // namespace kaustik::pbrt
