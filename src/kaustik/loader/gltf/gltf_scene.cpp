#include "kaustik/loader/gltf/gltf_scene.h"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/framing.h"
#include "kaustik/loader/gltf/gltf_extensions.h"
#include "kaustik/loader/gltf/gltf_instances.h"
#include "kaustik/loader/gltf/gltf_meshes.h"
#include "kaustik/loader/gltf/gltf_view.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::gltf {
namespace {

constexpr size_t most_unpacked_bytes = size_t{8} << 30;

class SceneReader {
 public:
  SceneReader(std::vector<uint8_t> bytes, std::string name, std::filesystem::path folder,
              const LoadOptions& options)
      : options_(options_of(options)),
        is_strict_(options.is_strict),
        file_(std::move(bytes), std::move(name), std::move(folder), deviations_),
        accessors_(file_),
        materials_(file_, options_, deviations_),
        meshes_(file_, accessors_, materials_, options_, deviations_),
        instances_(file_, accessors_, meshes_, deviations_) {
    description_.scene = make_object("scene", "", file_.place());
  }

  Description read() {
    check_extensions(file_, deviations_);
    const Pose pose = pose_of(file_, accessors_, options_, deviations_);
    const std::vector<PlacedNode> placed = placed_nodes(file_, pose, deviations_);
    instances_.take_nodes(placed);
    bool has_lamps = false;
    for (const PlacedNode& node : placed) {
      if (!node.is_there) continue;
      if (auto sensor = sensor_of(file_, node, camera_ids_)) put(scene(), "", std::move(sensor));
      for (auto& lamp :
           {lamp_of(file_, node, options_, deviations_), luminaire_of(file_, node, deviations_)})
        if (lamp) {
          put(scene(), "", lamp);
          has_lamps = true;
        }
      for (auto& shape : instances_.shapes_of(node, pose)) put(scene(), "", std::move(shape));
    }
    const bool needs_light = !has_lamps && !materials_.has_bright_emission();
    if (needs_light || camera_ids_.empty()) frame(needs_light);
    description_.sources = file_.sources();
    deviations_.finish(description_, is_strict_);
    description_.is_strict = is_strict_;
    return std::move(description_);
  }

 private:
  Object& scene() { return *description_.scene; }

  void frame(bool needs_light) {
    Framing framing(description_, deviations_);
    if (needs_light) light_studio(framing);
    framing.add_missing_camera();
  }

  /// Such files mean emission of 1 to be as bright as white surfaces.
  void light_studio(Framing& framing) {
    const bool is_faint = is_lit(description_);
    if (is_faint) {
      instances_.scale_emission(studio_luminance);
      deviations_.approximated(
          "emission",
          fmt::format("the file has no lamps: what shines does so {} times as much, to go with "
                      "the studio's light",
                      studio_luminance),
          file_.place());
    }
    framing.add_studio_light();
  }

  Options options_;
  bool is_strict_;
  Deviations deviations_;
  File file_;
  Accessors accessors_;
  Materials materials_;
  Meshes meshes_;
  Instances instances_;
  std::set<std::string> camera_ids_;
  Description description_{nullptr};
};

Description read_bytes(std::vector<uint8_t> bytes, const std::string& name,
                       const std::filesystem::path& folder, const LoadOptions& options) {
  bytes = unpacked(std::move(bytes), most_unpacked_bytes, place_in(name));
  return SceneReader(std::move(bytes), name, folder, options).read();
}

}  // namespace
}  // namespace kaustik::gltf

namespace kaustik {

bool is_gltf(std::string_view head) {
  if (head.starts_with("glTF")) return true;
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const size_t first = head.find_first_not_of(" \t\r\n");
  return first != head.npos && head[first] == '{' && head.find("\"asset\"") != head.npos;
}

Description load_gltf(const std::string& path, const LoadOptions& options) {
  std::vector<uint8_t> bytes;
  try {
    bytes = read_file(path);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, place_in(path));
  }
  return gltf::read_bytes(std::move(bytes), path, std::filesystem::path(path).parent_path(),
                          options);
}

Description parse_gltf(std::string_view bytes, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options) {
  return gltf::read_bytes({bytes.begin(), bytes.end()}, name_for_messages, base_folder, options);
}

}  // namespace kaustik
