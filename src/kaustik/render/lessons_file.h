#pragma once
// What integrators have learned, for other renders of the same scene.

#include <string>

#include "kaustik/base/binary_file.h"
#include "kaustik/scene/description_digest.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// As many as `kaustik render` takes in all.
inline constexpr uint32_t most_samples_per_pass = uint32_t(1) << 30;

/// Lessons, and what they were learned of.
struct StoredLessons {
  std::string program;            ///< version
  std::string scene;              ///< file, for people
  std::string integrator;         ///< type
  DescriptionDigest digest;       ///< of the description that was learned from
  uint64_t seed = 0;              ///< that people gave
  uint32_t samples_per_pass = 1;  ///< of the passes that taught
  Lessons lessons;
};

/// Writes a .kln file atomically; throws as write_file_atomically() does.
void write_lessons(const std::string& path, const StoredLessons& stored);

/// Throws Error(input) if the file is missing, holds no lessons, is of another version or byte
/// order, truncated or damaged.
StoredLessons read_lessons(const std::string& path);

/// Whether the file starts as those of lessons do. Throws Error(input) if it cannot be read.
bool is_lessons_file(const std::string& path);

/// Differs in all likelihood between lessons that differ; never 0.
uint64_t digest_of(const Lessons& lessons);

// As a part of other files.
void put_lessons(BinaryWriter& writer, const Lessons& lessons);
Lessons get_lessons(BinaryReader& reader);

}  // namespace kaustik
