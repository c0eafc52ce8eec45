#pragma once
// A scene as the files of its folder: NAME.xml, meshes/*.ply, pictures/*.ppm.

#include "kit/picture.h"
#include "kit/ply_writer.h"
#include "kit/xml_writer.h"

namespace kaustik::scenes {

struct SceneFile {
  std::string path;  ///< below the scene's folder, with /
  std::vector<uint8_t> bytes;
};

struct View {
  Vec3d origin, target;
  double fov = 50;  ///< degrees across the width
  int width = 800, height = 800;
  std::string medium = {};     ///< id of the one that the camera is in; empty: none
  double aperture_radius = 0;  ///< of its lens, focused on the target; 0: a pinhole
};

class SceneFolder {
 public:
  /// `title` is the comment at the head of the scene file.
  SceneFolder(std::string name, std::string title);

  const std::string& name() const { return name_; }

  /// Its meshes and pictures are those of another scene, beside it: none are written here. To be
  /// called before any is added.
  void share_files_of(const std::string& other_scene);

  /// Film and camera. The picture's size can be changed with -D size=… (square pictures) or
  /// -D width=… -D height=…, the samples with -D spp=….
  void add_view(const View& view, int spp = 64);

  /// An element at the first level.
  void add(Xml element) { root_.add(std::move(element)); }
  /// A bsdf that meshes refer to by its id.
  void add_bsdf(const std::string& id, Xml bsdf_without_id);

  /// Writes meshes/NAME.ply. Each mesh is written once; throws std::logic_error when a name
  /// comes twice.
  void write_mesh(const std::string& name, const Mesh& mesh, const PlyLayout& layout = {});
  /// The shape of a mesh written before, with its layout.
  Xml shape(const std::string& mesh, const std::string& bsdf_id) const;
  /// write_mesh and its shape, added to the scene.
  void add_mesh(const std::string& name, const Mesh& mesh, const std::string& bsdf_id,
                const PlyLayout& layout = {}, const std::string& comment = {});
  /// Writes pictures/NAME.ppm and returns that path.
  std::string write_picture(const std::string& name, const Picture& picture);

  std::vector<SceneFile> files() const;
  size_t triangles() const { return triangles_; }  ///< in all meshes written

 private:
  std::string name_;
  Xml root_;
  std::vector<SceneFile> files_;
  std::vector<std::pair<std::string, PlyLayout>> layouts_;  ///< by mesh
  size_t triangles_ = 0;
  bool shares_files_ = false;
  bool has_bsdfs_ = false;
};

inline constexpr double luminous_efficacy = 179;  ///< lm/W of white light

/// Luminance of linear Rec. 709.
double luminance(const Vec3d& rgb);
/// Radiance in W/(sr m²) of a matt lamp of `area` m² that emits `watts` in all (luminous flux over
/// 179 lm/W); `color` counts only by its ratios.
Vec3d lamp_radiance(double watts, double area, const Vec3d& color);
/// Radiant intensity in W/sr of a lamp of `watts` that shines evenly into `solid_angle` sr.
Vec3d lamp_intensity(double watts, double solid_angle, const Vec3d& color);
/// Solid angle of a cone of half angle `degrees`.
double cone_solid_angle(double degrees);

}  // namespace kaustik::scenes
