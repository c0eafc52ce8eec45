#include "benchmarks/cluster/machines.h"

#include <nlohmann/json.hpp>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik::bench {

void measured_from(const std::string& path, Machines& machines) {
  const std::vector<uint8_t> bytes = read_file(path);
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!json.is_object())
    throw Error(ErrorKind::input, "it is not JSON", "make it anew: make bench-cluster",
                place_in(path));
  const auto take = [&](const char* name, double& value) { value = json.value(name, value); };
  take("reduction", machines.reduction);
  take("merge_gb_s", machines.merge_gb_s);
}

}  // namespace kaustik::bench
