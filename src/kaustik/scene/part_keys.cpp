#include "kaustik/scene/part_keys.h"

#include <fmt/format.h>

#include <chrono>

#include "kaustik/base/sampler.h"
#include "kaustik/scene/file_stamp.h"
#include "kaustik/scene/type_tables.h"

namespace kaustik {
namespace {

/// Which no other build has.
std::string unique_text() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return fmt::format("fresh {}", std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::string text_of_file(const std::string& path, const std::string& unique) {
  const auto stamp = stamp_of_file(path);
  if (!stamp || !is_settled(*stamp)) return unique;
  return fmt::format("file {}", fmt::join(*stamp, " "));
}

}  // namespace

PartKeys::PartKeys()
    : digests_(scene_types(), [unique = unique_text()](const std::string& path) {
        return text_of_file(path, unique);
      }) {}

uint64_t PartKeys::light(const Object& emitter, int shape) {
  return hash_mix(digests_.of(emitter), uint64_t(int64_t(shape)));
}

}  // namespace kaustik
