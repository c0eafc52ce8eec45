#include "kaustik/base/array.h"

#include <fmt/format.h>

#include <limits>

#include "kaustik/base/checksum.h"
#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// What the extents ask for; the largest number there is where that overflows.
size_t bytes_of(ElementType type, const std::vector<size_t>& extents) {
  size_t bytes = element_size(type);
  bool overflows = false;
  for (const size_t extent : extents) {
    if (extent == 0) return 0;
    overflows = overflows || bytes > std::numeric_limits<size_t>::max() / extent;
    bytes *= extent;
  }
  return overflows ? std::numeric_limits<size_t>::max() : bytes;
}

}  // namespace

const char* element_name(ElementType type) {
  constexpr const char* names[] = {"uint8", "uint16",  "uint32", "int32",
                                   "int64", "float32", "float64"};
  return names[size_t(type)];
}

size_t element_size(ElementType type) {
  constexpr size_t sizes[] = {1, 2, 4, 4, 8, 4, 8};
  return sizes[size_t(type)];
}

bool is_integer(ElementType type) {
  return type != ElementType::float32 && type != ElementType::float64;
}

std::string extents_text(std::span<const size_t> extents) {
  return fmt::format("[{}]", fmt::join(extents, ", "));
}

Array::Array(ElementType type, std::vector<size_t> extents, std::span<const std::byte> bytes,
             std::shared_ptr<const void> owner)
    : type_(type), extents_(std::move(extents)), bytes_(bytes), owner_(std::move(owner)) {}

std::shared_ptr<const Array> Array::borrow(ElementType type, std::vector<size_t> extents,
                                           std::span<const std::byte> bytes,
                                           std::shared_ptr<const void> owner) {
  if (bytes_of(type, extents) != bytes.size())
    throw Error(ErrorKind::input,
                fmt::format("an array of {} with the extents {} cannot have {} bytes",
                            element_name(type), extents_text(extents), bytes.size()),
                "give extents whose product is the number of its elements");
  if (reinterpret_cast<uintptr_t>(bytes.data()) % element_size(type) != 0)
    throw Error(ErrorKind::input,
                fmt::format("an array of {} does not begin at a multiple of {} bytes",
                            element_name(type), element_size(type)),
                "copy it to memory of its own");
  return std::shared_ptr<const Array>(new Array(type, std::move(extents), bytes, std::move(owner)));
}

uint64_t Array::digest() const {
  std::call_once(digest_once_, [this] {
    const std::string text =
        fmt::format("{} {} {:016x}", element_name(type_), extents_text(extents_),
                    checksum({reinterpret_cast<const uint8_t*>(bytes_.data()), bytes_.size()}));
    digest_ = checksum({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  });
  return digest_;
}

}  // namespace kaustik
