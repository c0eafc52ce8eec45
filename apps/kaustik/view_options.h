#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/image/tone_mapping.h"
#include "picture_viewer.h"

namespace kaustik::app {

/// Where the running picture is to be seen.
struct ViewOptions {
  std::optional<std::string> tev;      ///< --tev
  std::optional<std::string> preview;  ///< --preview: "auto", or a kind of graphics
};

void add_views(CLI::App& command, ViewOptions& options);

/// Throws Error(input) for what cannot be read. Before long work.
void check_views(const ViewOptions& options);

/// The viewers that are asked for and can be had; the picture is shown by `tone`, and in windows
/// called `name`.
std::vector<std::unique_ptr<PictureViewer>> make_viewers(
    const ViewOptions& options, const std::string& name,
    const std::shared_ptr<const ToneOperator>& tone);

}  // namespace kaustik::app
