#pragma once
#include <string_view>
#include <vector>

namespace kaustik::view {

/// A file of the page, as it is embedded in the program: what is not among them is not served.
struct Asset {
  std::string_view name;  ///< "index.html"
  std::string_view bytes;
};
/// In the order of their names. Made by cmake/embed_assets.cmake from apps/view/dist.
const std::vector<Asset>& assets();

/// By its name: "text/html; charset=utf-8".
std::string_view content_type_of(std::string_view name);

}  // namespace kaustik::view
