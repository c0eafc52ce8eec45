#include "kaustik/loader/near_names.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"

namespace kaustik {

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? std::string() : fmt::format("did you mean '{}'?", nearest);
}

}  // namespace kaustik
