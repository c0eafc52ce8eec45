#pragma once
#include <string>
#include <vector>

namespace kaustik {

/// The layers that channels of these names belong to, "" for the picture itself, each once, in the
/// order of their first channels: "direct" of "direct.R".
std::vector<std::string> layer_names(const std::vector<std::string>& channels);

}  // namespace kaustik
