#include "kaustik/scene/description.h"

namespace kaustik {

std::string file_of(const Property& property) {
  if (property.name != "filename" && property.name != "photon_map") return {};
  if (const auto* text = std::get_if<std::string>(&property.value)) return *text;
  if (const auto* untyped = std::get_if<Untyped>(&property.value)) return untyped->text;
  return {};
}

}  // namespace kaustik
