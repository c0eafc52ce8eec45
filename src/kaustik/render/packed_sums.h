#pragma once
#include <span>
#include <vector>

#include "kaustik/base/binary_file.h"
#include "kaustik/base/exact_sum.h"

namespace kaustik {

/// Writes exact sums without the bytes that say nothing, as docs/reference/checkpoint_file.md
/// describes it.
void put_sums(BinaryWriter& writer, std::span<const Fixed> sums);

/// Reads so many; throws as BinaryReader does. Allocates at most 16 bytes for each of the file.
std::vector<Fixed> get_sums(BinaryReader& reader, uint64_t count);

}  // namespace kaustik
