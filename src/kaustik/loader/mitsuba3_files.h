#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// A mesh, a picture or a volume that a scene names and that is still to be written.
struct FileToWrite {
  std::string path;
  std::shared_ptr<const Object> source;             ///< the shape, bitmap or volume it is made of
  Rgb factor = {1, 1, 1};                           ///< that a picture is multiplied by
  std::vector<std::shared_ptr<Object>> users = {};  ///< that name the file

  bool is_mesh() const { return source->family == "shape"; }
  bool is_volume() const { return source->family == "volume"; }
};

/// Collects files to write beside a scene and names them after it and what they are made of. What
/// is made of the same in the same way is one file.
class FilesToWrite {
 public:
  /// `scene_file`: the path of the scene.
  explicit FilesToWrite(const std::string& scene_file);

  /// The shape becomes a `ply` of a new file with the mesh of `source`, which is what it was: see
  /// shape_as_ply().
  void use_ply(const std::shared_ptr<Object>& shape, const Object& source);
  /// The bitmap shows a new EXR file, with its picture's values times a factor, linear.
  void use_exr(const std::shared_ptr<Object>& bitmap, const Rgb& factor);
  /// An `envmap` whose picture is a buffer shows a new EXR file.
  void use_exr_around(const std::shared_ptr<Object>& envmap);
  /// The volume has the samples of its buffer from a new VOL file.
  void use_vol(const std::shared_ptr<Object>& volume);

  std::vector<FileToWrite> take() { return std::move(files_); }

 private:
  void use(const std::string& key, const std::shared_ptr<Object>& user, const Object& source,
           const Rgb& factor, const char* ending);
  std::string new_name(const Object& source, const char* ending);

  std::string stem_;  ///< that all paths begin with
  std::vector<FileToWrite> files_;
  std::map<std::string, size_t> known_;  ///< by what they are made of
  std::set<std::string> names_;
};

}  // namespace kaustik
