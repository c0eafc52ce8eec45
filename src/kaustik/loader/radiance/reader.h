#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/loader/radiance/command_line.h"
#include "kaustik/loader/radiance/compiled_reader.h"
#include "kaustik/loader/radiance/environment.h"
#include "kaustik/loader/radiance/surfaces.h"

namespace kaustik::radiance {

/// Reads scene files one after the other, with the files and the programs that they name, and
/// describes what they hold.
class SceneReader {
 public:
  SceneReader(SceneFiles& files, Deviations& deviations, Object& scene);

  /// Throws Error(input).
  void read_file(const std::filesystem::path& path, const Place& place);
  void read_statements_of(const Statements& statements, const std::filesystem::path& folder);
  /// When all is read.
  void finish();

 private:
  /// Where statements are placed.
  struct Frame {
    Transform placed;
    bool is_inverted = false;
    std::optional<std::string> modifier;   ///< of all surfaces
    std::optional<ModifierPointer> given;  ///< the same where it is known, for octrees
    std::filesystem::path folder;          ///< of the file
  };

  void walk(const std::shared_ptr<const Statements>& statements, const Frame& frame);
  void walk_file(const std::filesystem::path& path, const Frame& frame, const Place& place);
  void read(const std::shared_ptr<const Primitive>& primitive, const Frame& frame);
  /// Throws std::invalid_argument, too, where transforms are out of bounds.
  void read_checked(const std::shared_ptr<const Primitive>& primitive, const Frame& frame);
  void run(const Command& command, const Frame& frame);
  void run_programs(const Command& command, const Frame& frame);
  /// The frames of what an xform command places, and the files that it names.
  std::vector<Frame> frames_of(const Words& words, const Frame& frame, const Place& place,
                               std::vector<std::string>& files);
  ModifierPointer modifier_of(const Primitive& surface, const Frame& frame);
  /// Files of materials are often left out: grey paint stands for what they define. Slips of the
  /// pen stay unknown.
  void stand_in_for(const std::string& modifier, const Place& place);
  /// What an octree holds.
  void place_octree(const Primitive& instance, const Frame& frame);
  void place_mesh(const std::shared_ptr<const Primitive>& mesh, const Frame& frame);
  /// The first string is a file, the others a transform; nothing where one of them is wrong, which
  /// is told.
  std::optional<Frame> frame_of(const Primitive& placed, const Frame& frame);
  std::optional<std::filesystem::path> compiled_file(const Primitive& primitive,
                                                     const Frame& frame);
  const CompiledMesh& mesh_in(const std::filesystem::path& path, const Place& place);

  SceneFiles& files_;
  Deviations& deviations_;
  Modifiers modifiers_;
  PatternReader patterns_;
  MaterialMaker materials_;
  SurfaceMaker surfaces_;
  EnvironmentMaker environment_;
  Object& scene_;
  std::vector<std::filesystem::path> open_;                  ///< files that are being read
  std::map<std::string, std::filesystem::path> identities_;  ///< by path
  /// Octrees and meshes have modifiers of their own, and see those that stand before their first
  /// use.
  std::map<std::string, Modifiers> own_modifiers_;
  std::map<std::string, CompiledMesh> meshes_;
  int depth_ = 0;
  size_t includes_ = 0;
};

}  // namespace kaustik::radiance
