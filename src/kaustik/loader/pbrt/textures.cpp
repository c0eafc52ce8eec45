#include "kaustik/loader/pbrt/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/picture_textures.h"

namespace kaustik::pbrt {
namespace {

constexpr int most_levels = 32;

}  // namespace

void Textures::define(TextureDefinition definition) {
  by_name_[definition.name][definition.is_float].push_back(entries_.size());
  entries_.push_back(std::make_unique<Entry>(Entry{std::move(definition), {}, {}}));
}

Textures::Entry* Textures::find(const std::string& name, bool is_float, size_t sequence) {
  const auto known = by_name_.find(name);
  if (known == by_name_.end() || known->second[is_float].empty()) return nullptr;
  return entries_[definition_before(
                      known->second[is_float], sequence,
                      [&](size_t i) { return entries_[i]->definition.owner.sequence; })]
      .get();
}

const Input& Textures::made(Entry& entry) {
  if (entry.state == Entry::State::made) {
    for (const size_t mapping : entry.mappings) laid_by(mapping);
    return entry.made;
  }
  const TextureDefinition& definition = entry.definition;
  if (entry.state == Entry::State::being_made || depth_ >= most_levels)
    throw Error(ErrorKind::input,
                entry.state == Entry::State::being_made
                    ? fmt::format("texture {} is made of itself", shown(definition.name))
                    : fmt::format("textures nest more than {} deep", most_levels),
                "let it name other textures", definition.parameters.place());
  entry.state = Entry::State::being_made;
  ++depth_;
  {
    const Collecting collecting(*this, entry.mappings);
    entry.made = make(definition);
  }
  for (const size_t mapping : entry.mappings) laid_by(mapping);
  --depth_;
  if (!entry.made.is_given()) entry.made.value = 0.5;
  entry.state = Entry::State::made;
  definition.parameters.tell_unused(definition.owner.object, deviations_);
  return entry.made;
}

Textures::Entry* Textures::find_number(const std::string& name, size_t sequence) {
  Entry* entry = find(name, true, sequence);
  return entry ? entry : find(name, false, sequence);
}

Input Textures::named(const Parameter& parameter, bool is_float, const Owner& owner) {
  const std::string name = parameter.texts.empty() ? std::string() : parameter.texts.front();
  Entry* entry = is_float ? find_number(name, owner.sequence) : find(name, false, owner.sequence);
  if (entry) return made(*entry);
  deviations_.missing(owner.object,
                      fmt::format("there is no texture {}{}", shown(name),
                                  by_name_.contains(name) ? " of colours, but one of numbers" : ""),
                      parameter.place,
                      by_name_.contains(name) ? "write \"spectrum\" behind its name"
                                              : did_you_mean(name, names_in(by_name_)));
  return is_float ? Input{0.5, nullptr} : Input{{}, missing_picture(parameter.place)};
}

Input Textures::colour(const ParameterList& list, std::string_view name, const Owner& owner) {
  if (const Parameter* texture = list.find(name, {"texture"})) return named(*texture, false, owner);
  return {spectra_.read(list, name, SpectrumUse::reflectance, owner), nullptr};
}

Input Textures::number(const ParameterList& list, std::string_view name, const Owner& owner) {
  if (const Parameter* texture = list.find(name, {"texture"})) return named(*texture, true, owner);
  const auto number = list.number(name);
  return number ? Input{*number, nullptr} : Input{};
}

Input Textures::root_of_number(const ParameterList& list, std::string_view name,
                               const Owner& owner) {
  const Parameter* texture = list.find(name, {"texture"});
  if (!texture) {
    const auto number = list.number(name);
    return number ? Input{std::sqrt(std::max(0.0, *number)), nullptr} : Input{};
  }
  const std::string wanted = texture->texts.empty() ? std::string() : texture->texts.front();
  Entry* entry = find_number(wanted, owner.sequence);
  if (!entry) return named(*texture, true, owner);
  const Input root = root_of(*entry);
  if (root.is_given()) return root;
  deviations_.approximated(
      owner.object,
      fmt::format("the slope of its facets is texture {} itself, not its root", shown(wanted)),
      texture->place);
  return made(*entry);
}

Input Textures::root_of(Entry& entry) {
  const TextureDefinition& definition = entry.definition;
  const Input whole = made(entry);
  if (whole.value)
    if (const auto number = as_number(*whole.value))
      return {std::sqrt(std::max(0.0, *number)), nullptr};
  if (definition.type == "imagemap") return make_picture(definition, 0.5);
  return {};
}

}  // namespace kaustik::pbrt
