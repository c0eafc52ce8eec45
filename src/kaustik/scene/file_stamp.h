#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace kaustik {

/// What the system tells of a file without reading it: device, number, size, and the times of its
/// last change and of the last change of its state, in nanoseconds. Whoever writes to a file or
/// puts another in its place changes one of these, but for changes within one tick of the clock.
using FileStamp = std::array<int64_t, 5>;

/// Nothing if it is not there.
std::optional<FileStamp> stamp_of_file(const std::string& path);

/// Whether the file had its last change long enough ago (2 s, the coarsest clock of file systems)
/// that any later one would change the stamp.
bool is_settled(const FileStamp& stamp);

}  // namespace kaustik
