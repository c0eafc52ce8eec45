#include "kit/scene_folder.h"

#include <fmt/format.h>

#include <stdexcept>

namespace kaustik::scenes {

SceneFolder::SceneFolder(std::string name, std::string title)
    : name_(std::move(name)),
      root_(Xml("scene", {{"version", "3.0.0"}})
                .said("Made by make_scenes (scenes/generator); not to be edited. " +
                      std::move(title))) {}

void SceneFolder::share_files_of(const std::string& other_scene) {
  shares_files_ = true;
  add(Xml("path", {{"value", "../" + other_scene}}));
}

void SceneFolder::add_view(const View& view, int spp) {
  const bool square = view.width == view.height;
  if (square) {
    add(setting("size", fmt::format("{}", view.width)));
  } else {
    add(setting("width", fmt::format("{}", view.width)));
    add(setting("height", fmt::format("{}", view.height)));
  }
  add(setting("spp", fmt::format("{}", spp)));
  const auto side = [](const char* name, const std::string& value) {
    return Xml("integer", {{"name", name}, {"value", "$" + value}});
  };
  Xml film = object("film", "hdrfilm");
  film.add(side("width", square ? "size" : "width"));
  film.add(side("height", square ? "size" : "height"));
  film.add(object("rfilter", "gaussian"));
  const bool has_lens = view.aperture_radius > 0;
  Xml sensor = object("sensor", has_lens ? "thinlens" : "perspective");
  sensor.add(number("fov", view.fov));
  if (has_lens) {
    sensor.add(number("aperture_radius", view.aperture_radius));
    sensor.add(number("focus_distance", (view.target - view.origin).length()));
  }
  sensor.add(transform({look_at(view.origin, view.target)}));
  if (!view.medium.empty()) sensor.add(ref(view.medium));
  sensor.add(std::move(film));
  sensor.add(object("sampler", "independent", {side("sample_count", "spp")}));
  add(std::move(sensor).said("The camera."));
}

void SceneFolder::add_bsdf(const std::string& id, Xml bsdf) {
  const char* heading = has_bsdfs_ ? "" : "Materials.";
  has_bsdfs_ = true;
  add(object("bsdf", "twosided", {std::move(bsdf)}, id).said(heading));
}

void SceneFolder::write_mesh(const std::string& name, const Mesh& mesh, const PlyLayout& layout) {
  for (const auto& [known, unused] : layouts_)
    if (known == name) throw std::logic_error("mesh '" + name + "' is written twice");
  layouts_.emplace_back(name, layout);
  if (!shares_files_) files_.push_back({"meshes/" + name + ".ply", ply_bytes(mesh, layout)});
  triangles_ += mesh.triangles.size();
}

Xml SceneFolder::shape(const std::string& mesh, const std::string& bsdf_id) const {
  for (const auto& [known, layout] : layouts_) {
    if (known != mesh) continue;
    Xml shape = object("shape", "ply", {text("filename", "meshes/" + mesh + ".ply")});
    if (layout.normals == Normals::flat) shape.add(boolean("face_normals", true));
    if (!bsdf_id.empty()) shape.add(ref(bsdf_id));
    return shape;
  }
  throw std::logic_error("there is no mesh '" + mesh + "'");
}

void SceneFolder::add_mesh(const std::string& name, const Mesh& mesh, const std::string& bsdf_id,
                           const PlyLayout& layout, const std::string& comment) {
  write_mesh(name, mesh, layout);
  add(shape(name, bsdf_id).said(comment));
}

std::string SceneFolder::write_picture(const std::string& name, const Picture& picture) {
  files_.push_back({"pictures/" + name + ".ppm", ppm_bytes(picture)});
  return files_.back().path;
}

std::vector<SceneFile> SceneFolder::files() const {
  std::vector<SceneFile> all = files_;
  const std::string text = root_.text();
  all.push_back({name_ + ".xml", std::vector<uint8_t>(text.begin(), text.end())});
  return all;
}

double luminance(const Vec3d& rgb) { return rgb.dot(Vec3d(0.2126, 0.7152, 0.0722)); }

Vec3d lamp_radiance(double watts, double area, const Vec3d& color) {
  return color * (watts / (pi_d * area * luminance(color)));
}

Vec3d lamp_intensity(double watts, double solid_angle, const Vec3d& color) {
  return color * (watts / (solid_angle * luminance(color)));
}

double cone_solid_angle(double degrees) { return 2 * pi_d * (1 - std::cos(degrees * pi_d / 180)); }

}  // namespace kaustik::scenes
