#pragma once
// Going on with a checkpoint.
#include <optional>
#include <string>
#include <vector>

#include "kaustik/render/prepared_scene.h"
#include "kaustik/render/session.h"

namespace kaustik {

/// As far as the render was told to go when it began; what is left of its time.
SessionSettings settings_to_go_on(const Checkpoint& checkpoint);

/// Leaves of this time, which is for all sessions together, what those of the checkpoint have not
/// used. If that is nothing: no pass but those that are there.
void keep_to_time(SessionSettings& settings, std::optional<double> seconds,
                  const Checkpoint& checkpoint);

/// Throws Error(input), at `path`, if the scene, prepared with its digest, is not the one of the
/// checkpoint's passes: new ones would not belong to them.
void check_same_scene(const PreparedScene& prepared, const Checkpoint& checkpoint,
                      const std::string& path);

/// Throws Error(input), at `path`, if the session's passes have other numbers of samples than those
/// of the checkpoint, or are another part: they would not be what was asked for when it began.
void check_same_passes(const Session& session, const Checkpoint& checkpoint,
                       const std::string& path);

/// Those that lie neither in nor below the folder that `checkpoint` lies in, as links have it. A
/// checkpoint may come from anybody, so what it names is not to be written anywhere.
std::vector<std::string> files_outside_its_folder(const std::vector<std::string>& files,
                                                  const std::string& checkpoint);

}  // namespace kaustik
