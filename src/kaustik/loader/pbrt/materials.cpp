#include "kaustik/loader/pbrt/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/pbrt/texture_mixes.h"
#include "kaustik/loader/pbrt/upgrade.h"

namespace kaustik::pbrt {
namespace {

constexpr int most_material_levels = 16;

using MaterialMaker = MadeMaterial (*)(const MaterialTools&);

/// Of types whose material is a bsdf alone.
template <auto make_bsdf>
MadeMaterial only_bsdf(const MaterialTools& tools) {
  return {make_bsdf(tools), nullptr};
}

std::shared_ptr<Object> make_coated(const MaterialTools& tools) {
  return make_coated_diffuse(tools);
}

std::shared_ptr<Object> matt_and_grey(const MaterialTools& tools) {
  auto bsdf = described("bsdf", "diffuse", tools.place());
  set(*bsdf, "reflectance", 0.5);
  return two_sided(bsdf);
}

std::shared_ptr<Object> make_measured(const MaterialTools& tools) {
  tools.list().accept({"filename", "bsdffile"});
  tools.approximated("files of measured reflection are not read: it is matt and grey");
  return matt_and_grey(tools);
}

/// All but those that are mixed of others, and those without a surface.
const std::map<std::string_view, MaterialMaker>& material_makers() {
  static const std::map<std::string_view, MaterialMaker> rows = {
      {"coatedconductor", only_bsdf<make_coated_conductor>},
      {"coateddiffuse", only_bsdf<make_coated>},
      {"conductor", only_bsdf<make_conductor>},
      {"dielectric", only_bsdf<make_dielectric>},
      {"diffuse", only_bsdf<make_diffuse>},
      {"diffusetransmission", only_bsdf<make_diffuse_transmission>},
      {"disney", only_bsdf<make_disney>},
      {"fourier", only_bsdf<make_measured>},
      {"hair", only_bsdf<make_hair>},
      {"measured", only_bsdf<make_measured>},
      {"subsurface", make_subsurface},
      {"thindielectric", only_bsdf<make_thin_dielectric>},
  };
  return rows;
}

MadeMaterial make_unknown(const MaterialTools& tools) {
  std::vector<std::string> known = names_in(material_makers());
  known.insert(known.end(), {"interface", "mix"});
  known.insert(known.end(), old_materials.begin(), old_materials.end());
  const std::string& type = tools.definition.type;
  tools.deviations.approximated(
      tools.object, fmt::format("there is no material {}: it is matt and grey", shown(type)),
      tools.place(), did_you_mean(type, known));
  return {matt_and_grey(tools), nullptr};
}

}  // namespace

Materials::Materials(SceneFiles& files, Textures& textures, Spectra& spectra, Ids& ids,
                     Deviations& deviations)
    : files_(files), textures_(textures), spectra_(spectra), ids_(ids), deviations_(deviations) {
  // The one of shapes that have none: matt, of a reflectance of one half.
  define({"", "diffuse", ParameterList(), {"the default material", ColourSpace::srgb, 0}});
}

size_t Materials::define(MaterialDefinition definition) {
  const size_t index = entries_.size();
  if (!definition.name.empty()) by_name_[definition.name].push_back(index);
  entries_.push_back(std::make_unique<Entry>(Entry{std::move(definition), {}, {}}));
  return index;
}

const MadeMaterial& Materials::made(const MaterialReference& reference) {
  if (reference.name.empty()) return made(*entries_[reference.index]);
  const auto known = by_name_.find(reference.name);
  if (known == by_name_.end()) {
    deviations_.missing(fmt::format("material {}", shown(reference.name)),
                        "it is not defined: what has it is matt and grey", reference.place,
                        did_you_mean(reference.name, names_in(by_name_)));
    return made(*entries_.front());
  }
  return made(*entries_[definition_before(known->second, reference.sequence, [&](size_t i) {
    return entries_[i]->definition.owner.sequence;
  })]);
}

const MadeMaterial& Materials::made(Entry& entry) {
  if (entry.state == Entry::State::made) return entry.made;
  const MaterialDefinition& definition = entry.definition;
  if (entry.state == Entry::State::being_made || depth_ >= most_material_levels)
    throw Error(ErrorKind::input,
                entry.state == Entry::State::being_made
                    ? fmt::format("{} is mixed of itself", definition.owner.object)
                    : fmt::format("materials nest more than {} deep", most_material_levels),
                "let it name other materials", definition.parameters.place());
  entry.state = Entry::State::being_made;
  ++depth_;
  MappingSet mappings;
  {
    const Textures::Collecting collecting(textures_, mappings);
    entry.made = make(definition);
  }
  entry.made.mappings.merge(mappings);
  --depth_;
  if (!definition.name.empty() && entry.made.bsdf->id.empty())
    entry.made.bsdf->id = ids_.unused(definition.name);
  definition.parameters.tell_unused(definition.owner.object, deviations_);
  entry.state = Entry::State::made;
  return entry.made;
}

MadeMaterial Materials::make(const MaterialDefinition& definition) {
  const MaterialTools tools{{deviations_, definition.owner.object, definition.parameters.place()},
                            textures_,
                            spectra_,
                            definition};
  const std::string& type = definition.type;
  MadeMaterial result;
  if (type.empty() || type == "none" || type == "interface") {
    result.bsdf = described("bsdf", "null", tools.place());
    result.is_interface = true;
    tools.list().accept({"displacement", "normalmap"});
    return result;
  }
  if (type == "mix") return make_mix(definition);
  const auto maker = material_makers().find(type);
  result = maker != material_makers().end() ? maker->second(tools) : make_unknown(tools);
  result.bsdf =
      without_mixes(with_relief(result.bsdf, definition), definition.owner.object, deviations_);
  return result;
}

std::shared_ptr<Object> Materials::with_relief(std::shared_ptr<Object> bsdf,
                                               const MaterialDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const Input heights = textures_.number(list, "displacement", definition.owner);
  const std::string normals = list.text("normalmap");
  if (heights.texture) {
    auto relief = described("bsdf", "bumpmap", list.place_of("displacement"));
    hold(*relief, "texture", heights.texture);
    hold(*relief, "", std::move(bsdf));
    return relief;
  }
  if (normals.empty()) return bsdf;
  const Place place = list.place_of("normalmap");
  if (!files_.find(normals, place)) {
    deviations_.missing(
        definition.owner.object,
        fmt::format("normal map {} is not there: the surface is smooth", shown(normals)), place,
        where_files_lie);
    return bsdf;
  }
  auto relief = described("bsdf", "normalmap", place);
  hold(*relief, "normalmap", textures_.picture(normals, true, definition.owner, place));
  hold(*relief, "", std::move(bsdf));
  return relief;
}

MadeMaterial Materials::make_mix(const MaterialDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const Place& place = list.place();
  const Parameter* names = list.find("materials", {"string"});
  if (!names || names->texts.size() != 2)
    throw Error(ErrorKind::input,
                fmt::format("{} does not name two materials", definition.owner.object),
                "write \"string materials\" [ \"one\" \"other\" ]", place);
  const Input amount = textures_.number(list, "amount", definition.owner);
  MadeMaterial result;
  result.bsdf = described("bsdf", "blendbsdf", place);
  if (amount.is_given())
    set(*result.bsdf, "weight", amount);
  else
    set(*result.bsdf, "weight", 0.5);
  for (const std::string& name : names->texts) {
    const MadeMaterial& part = made({0, name, definition.owner.sequence, names->place});
    result.mappings.insert(part.mappings.begin(), part.mappings.end());
    if (name == names->texts.front() || !result.interior) result.interior = part.interior;
    hold(*result.bsdf, "", part.bsdf);
  }
  result.bsdf = without_mixes(result.bsdf, definition.owner.object, deviations_);
  return result;
}

}  // namespace kaustik::pbrt
