#pragma once
#include "kaustik/library/access.h"
#include "kaustik/render/job.h"
#include "kaustik/session.h"

namespace kaustik::v0::details {

/// Throws Error for values that mean nothing.
void check_settings(const v0::SessionSettings& settings);

/// What a job is to do of a scene; `settings` has been checked.
JobSettings job_settings(const v0::SessionSettings& settings, const SceneState& scene);

/// The same of one that goes on with a checkpoint of the name `path`. Throws Error for settings
/// that the checkpoint has decided, and for what another version has written.
JobSettings job_settings(const v0::SessionSettings& settings, const SceneState& scene,
                         Checkpoint checkpoint, const std::string& path);

}  // namespace kaustik::v0::details
