#include "kaustik/loader/radiance/generators.h"

#include <array>
#include <string_view>
#include <utility>

namespace kaustik::radiance {
namespace {

using Generator = std::string (*)(const Words&, const GeneratorContext&);

constexpr auto generators = std::to_array<std::pair<std::string_view, Generator>>({
    {"genbox", generate_box},
    {"genrbox", generate_box},  // as Debian calls it
    {"genprism", generate_prism},
    {"genrev", generate_revolution},
    {"genworm", generate_worm},
    {"gensurf", generate_surface},
    {"genblinds", generate_blinds},
    {"gensky", generate_cie_sky},
    {"gendaylit", generate_perez_sky},
    {"replmarks", replace_marks},
});

}  // namespace

std::optional<std::string> run_generator(const Words& words, const GeneratorContext& context) {
  for (const auto& [name, generate] : generators)
    if (name == words.front()) return generate(words, context);
  if (words.front() != "cat") return std::nullopt;
  std::string all;
  for (size_t i = 1; i < words.size(); ++i) all += context.read_part(words[i]) + "\n";
  return all;
}

std::string generator_names() {
  std::string names = "xform, cat";
  for (const auto& row : generators) names += ", " + std::string(row.first);
  return names;
}

}  // namespace kaustik::radiance
