#include "kaustik/image/layer_names.h"

#include <algorithm>

namespace kaustik {

std::vector<std::string> layer_names(const std::vector<std::string>& channels) {
  std::vector<std::string> layers;
  for (const std::string& name : channels) {
    const size_t dot = name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

}  // namespace kaustik
