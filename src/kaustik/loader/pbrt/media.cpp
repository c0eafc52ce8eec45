#include "kaustik/loader/pbrt/media.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::pbrt {

void Media::define(const std::string& name, MediumDefinition definition) {
  const auto [entry, is_new] = entries_.try_emplace(name);
  if (!is_new)
    deviations_.approximated(definition.owner.object, "it is defined twice: the first one counts",
                             definition.parameters.place());
  else
    entry->second.definition = std::move(definition);
}

std::shared_ptr<Object> Media::named(const std::string& name, const Place& place) {
  if (name.empty()) return nullptr;
  const auto known = entries_.find(name);
  if (known == entries_.end()) {
    deviations_.missing(fmt::format("medium {}", shown(name)),
                        "it is not defined: space is empty there", place,
                        did_you_mean(name, names_in(entries_)));
    return nullptr;
  }
  Entry& entry = known->second;
  if (entry.is_made) return entry.made;
  entry.is_made = true;
  entry.made = make(entry.definition);
  if (entry.made) entry.made->id = ids_.unused(name);
  entry.definition.parameters.tell_unused(entry.definition.owner.object, deviations_);
  return entry.made;
}

const std::map<std::string_view, Media::Maker>& Media::makers() {
  static const std::map<std::string_view, Maker> rows = {
      {"cloud", &Media::make_cloud},      {"homogeneous", &Media::make_homogeneous},
      {"nanovdb", &Media::make_nanovdb},  {"rgbgrid", &Media::make_colour_grid},
      {"uniformgrid", &Media::make_grid},
  };
  return rows;
}

std::shared_ptr<Object> Media::make(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const bool glows = list.has("Le") || list.has("temperature") || list.has("temperaturename");
  list.accept({"Lescale", "Legrid", "temperaturescale", "temperatureoffset", "temperaturecutoff"});
  if (glows)
    deviations_.ignored(definition.owner.object, "it does not glow: media emit no light here",
                        list.place());
  const auto maker = makers().find(definition.type);
  if (maker != makers().end()) return (this->*maker->second)(definition);
  deviations_.ignored(
      definition.owner.object,
      fmt::format("there is no medium {}: space is empty there", shown(definition.type)),
      list.place(), did_you_mean(definition.type, names_in(makers())));
  list.accept({"filename", "gridname", "density", "wispiness", "frequency", "sigma_a", "sigma_s",
               "scale", "g", "p0", "p1", "preset"});
  return nullptr;
}

Rgb Media::coefficient(const MediumDefinition& definition, const char* name) {
  const auto value =
      spectra_.read(definition.parameters, name, SpectrumUse::coefficient, definition.owner);
  if (!value) return {1, 1, 1};
  if (const auto colour = as_colour(*value)) return *colour;
  const double middle = number_of_index(*value);
  deviations_.approximated(definition.owner.object,
                           fmt::format("{} is that of yellow light", shown(name)),
                           definition.parameters.place_of(name));
  return {middle, middle, middle};
}

std::shared_ptr<Object> Media::with_phase(std::shared_ptr<Object> medium,
                                          const MediumDefinition& definition) {
  const double g = std::clamp(definition.parameters.number("g", 0), -0.999, 0.999);
  if (g == 0) return medium;
  auto phase = described("phase", "hg", medium->place);
  set(*phase, "g", g);
  hold(*medium, "", phase);
  return medium;
}

std::shared_ptr<Object> Media::make_homogeneous(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  auto medium = described("medium", "homogeneous", list.place());
  const std::string preset = list.text("preset"), substance = substance_named(preset);
  if (!preset.empty() && substance.empty())
    deviations_.missing(definition.owner.object,
                        fmt::format("there is no substance {}", shown(preset)),
                        list.place_of("preset"), substance_suggestion(preset));
  if (!substance.empty()) {
    list.accept({"sigma_a", "sigma_s"});
    set(*medium, "material", substance);
  } else {
    for (const char* const name : {"sigma_a", "sigma_s"})
      set(*medium, name,
          spectra_.read(list, name, SpectrumUse::coefficient, definition.owner).value_or(1.0));
  }
  set(*medium, "scale", std::max(list.number("scale", 1), 0.0));
  return with_phase(medium, definition);
}

}  // namespace kaustik::pbrt
