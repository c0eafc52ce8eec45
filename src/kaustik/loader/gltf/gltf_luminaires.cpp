// EXT_lights_ies: luminaires by files of measured intensities.

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/gltf/gltf_view.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::gltf {
namespace {

/// Only names of the header have other letters than ASCII; '$' means something in scene files.
std::string text_of_bytes(const Bytes& bytes) {
  std::string text(reinterpret_cast<const char*>(bytes.bytes.data()), bytes.bytes.size());
  for (char& c : text) {
    const bool is_end = c == '\n' || c == '\r' || c == '\t';
    if ((c < ' ' && !is_end) || c > '~' || c == '$') c = ' ';
  }
  return text;
}

/// Gives the emitter its file, or the text of one within this file. False: there is none.
bool give_profile(File& file, const JsonValue& profile, const std::string& name, Object& emitter,
                  Deviations& deviations) {
  std::string missing;
  if (const std::string uri = file.text(profile, "uri", ""); !uri.empty()) {
    if (const auto bytes = file.data_uri(uri, profile)) {
      give(emitter, "profile", text_of_bytes(*bytes));
      return true;
    }
    if (const auto path = file.find(uri, profile)) {
      give(emitter, "filename", path->string());
      return true;
    }
    missing = fmt::format("there is no file '{}'", uri.substr(0, 100));
  } else if (const auto view = file.count(profile, "bufferView")) {
    try {
      give(emitter, "profile", text_of_bytes(file.view(*view, profile)));
      return true;
    } catch (const MissingData& data) {
      missing = data.what;
    }
  } else {
    missing = "it names no file";
  }
  deviations.missing(name, fmt::format("{}: the luminaire is dark", missing), file.place(profile),
                     "put the file beside the scene");
  return false;
}

}  // namespace

std::shared_ptr<Object> luminaire_of(File& file, const PlacedNode& placed, Deviations& deviations) {
  const JsonValue* named = file.extension(*placed.node, "EXT_lights_ies");
  const JsonValue* all = file.extension(file.root(), "EXT_lights_ies");
  const auto index = named ? file.count(*named, "light") : std::nullopt;
  if (!index) return nullptr;
  const JsonValue* lights = all ? all->find("lights") : nullptr;
  if (!lights || *index >= lights->items().size())
    file.fail(*named, fmt::format("light profile {} is named, which the file has not", *index),
              "export the file again");
  const JsonValue& profile = lights->items()[*index];
  auto emitter = make_object("emitter", "goniometric", file.place(profile));
  if (!give_profile(file, profile, file.name_of("light profile", profile, *index), *emitter,
                    deviations))
    return nullptr;
  const std::vector<double> color = file.numbers(*named, "color", {1, 1, 1});
  const double factor = std::max(0.0, file.number(*named, "multiplier", 1));
  give(*emitter, "intensity",
       Rgb{std::max(0.0, color[0]) * factor, std::max(0.0, color[1]) * factor,
           std::max(0.0, color[2]) * factor});
  // It shines along the node's −z, as cameras look; C 0 is +x and C 90 +y.
  give(*emitter, "to_world", view_of(file, placed));
  return emitter;
}

}  // namespace kaustik::gltf
