#pragma once
#include <filesystem>
#include <string>

#include "kaustik/image/image.h"

namespace kaustik::bench {

/// What another renderer made of a scene.
struct PeerPicture {
  Image image;
  double seconds = 0;  ///< of rendering
  double start_up_seconds =
      0;               ///< of all that is done before, or once per render; not in `seconds`
  std::string effort;  ///< "512 samples per pixel"
};

/// A folder that goes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Whether the shell finds a program of that name.
bool is_installed(const std::string& program);

/// Runs a command of the shell; returns all that it printed. Throws Error(system) with that if it
/// fails.
std::string run_peer(const std::string& command, const TemporaryFolder& folder);

}  // namespace kaustik::bench
