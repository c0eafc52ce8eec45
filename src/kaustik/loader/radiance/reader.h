#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/loader/radiance/command_line.h"
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

  const Bounds3f& bounds() const { return surfaces_.bounds(); }

 private:
  /// Where statements are placed.
  struct Frame {
    Transform placed;
    bool is_inverted = false;
    std::optional<std::string> modifier;  ///< of all surfaces
    std::filesystem::path folder;         ///< of the file
  };

  void walk(const std::shared_ptr<const Statements>& statements, const Frame& frame);
  void walk_file(const std::filesystem::path& path, const Frame& frame, const Place& place);
  void read(const std::shared_ptr<const Primitive>& primitive, const Frame& frame);
  void run(const Command& command, const Frame& frame);
  void run_programs(const Command& command, const Frame& frame);
  /// The frames of what an xform command places, and the files that it names.
  std::vector<Frame> frames_of(const Words& words, const Frame& frame, const Place& place,
                               std::vector<std::string>& files);
  void leave_out_instance(const Primitive& primitive);

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
  int depth_ = 0;
  size_t includes_ = 0;
};

}  // namespace kaustik::radiance
