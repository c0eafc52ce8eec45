#include "kaustik/loader/gltf/gltf_meshopt.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace kaustik::gltf {
namespace {

constexpr size_t group_elements = 16, most_block_elements = 256, block_bytes = 8192;
constexpr size_t least_attribute_tail = 32, triangle_tail = 16, index_tail = 4;
constexpr uint8_t attribute_mark = 0xa0, triangle_mark = 0xe1, index_mark = 0xd1;

/// Thrown where the packed bytes end too early or contradict themselves.
struct DamagedStream {};

/// Bytes that are read from the front.
class Stream {
 public:
  explicit Stream(std::span<const std::byte> bytes) : rest_(bytes) {}
  uint8_t byte() { return uint8_t(part(1)[0]); }
  std::span<const std::byte> part(size_t size) {
    if (size > rest_.size()) throw DamagedStream();
    const auto taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }
  /// Takes bytes off the end.
  std::span<const std::byte> tail(size_t size) {
    if (size > rest_.size()) throw DamagedStream();
    const auto taken = rest_.last(size);
    rest_ = rest_.first(rest_.size() - size);
    return taken;
  }
  /// Seven bits in each byte, the lowest first.
  uint32_t packed_number() {
    uint32_t number = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const uint8_t next = byte();
      number |= uint32_t(next & 127) << shift;
      if (next < 128) return number;
    }
    throw DamagedStream();
  }
  bool is_empty() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

/// 0, −1, 1, −2, … of 0, 1, 2, 3, …
template <typename T>
T signed_of(T number) {
  return T((number & 1) != 0 ? ~(number >> 1) : number >> 1);
}

// ---- attributes ----

/// Sixteen values of one byte each, of which most take two or four bits.
void read_group(Stream& stream, unsigned code, std::array<uint8_t, group_elements>& deltas) {
  if (code == 0) {
    deltas.fill(0);
    return;
  }
  if (code == 3) {
    std::memcpy(deltas.data(), stream.part(group_elements).data(), group_elements);
    return;
  }
  const unsigned bits = code == 1 ? 2 : 4, in_byte = 8 / bits, all_set = (1u << bits) - 1;
  const auto short_ones = stream.part(group_elements / in_byte);
  for (size_t i = 0; i < group_elements; ++i) {
    const unsigned shift = 8 - bits * (unsigned(i % in_byte) + 1);
    const unsigned value = unsigned(short_ones[i / in_byte]) >> shift & all_set;
    deltas[i] = value == all_set ? stream.byte() : uint8_t(value);
  }
}

size_t block_elements_of(size_t stride) {
  return std::min(block_bytes / stride / group_elements * group_elements, most_block_elements);
}

/// One byte of all elements of a block, as differences to the element before.
void read_plane(Stream& stream, uint8_t before, size_t stride, std::span<uint8_t> to) {
  const size_t elements = (to.size() + stride - 1) / stride;
  const size_t groups = (elements + group_elements - 1) / group_elements;
  const auto codes = stream.part((groups + 3) / 4);
  std::array<uint8_t, group_elements> deltas;
  for (size_t group = 0; group < groups; ++group) {
    read_group(stream, unsigned(codes[group / 4]) >> 2 * (group % 4) & 3, deltas);
    const size_t first = group * group_elements;
    for (size_t i = first; i < std::min(first + group_elements, elements); ++i)
      to[i * stride] = before = uint8_t(before + signed_of(deltas[i - first]));
  }
}

std::vector<uint8_t> read_attributes(Stream& stream, size_t count, size_t stride) {
  if (stream.byte() != attribute_mark) throw DamagedStream();
  const auto tail = stream.tail(std::max(least_attribute_tail, stride)).last(stride);
  std::vector<uint8_t> before(stride), all(count * stride);
  std::memcpy(before.data(), tail.data(), stride);
  const size_t most = block_elements_of(stride);
  for (size_t first = 0; first < count; first += most) {
    const size_t elements = std::min(most, count - first);
    const std::span<uint8_t> block = std::span(all).subspan(first * stride, elements * stride);
    for (size_t k = 0; k < stride; ++k) read_plane(stream, before[k], stride, block.subspan(k));
    std::memcpy(before.data(), &block[(elements - 1) * stride], stride);
  }
  return all;
}

// ---- triangles and indices ----

/// The last sixteen that were added; before that zeros.
template <typename T>
class Recent {
 public:
  void add(const T& item) { items_[next_++ % 16] = item; }
  /// 0: the one that was added last.
  const T& operator[](unsigned back) const { return items_[(next_ - 1 - back) % 16]; }

 private:
  std::array<T, 16> items_{};
  unsigned next_ = 0;
};

class TriangleReader {
 public:
  TriangleReader(Stream& stream, size_t triangles)
      : table_(stream.tail(triangle_tail)), codes_(stream.part(triangles)), stream_(stream) {}

  std::vector<uint32_t> read() {
    indices_.reserve(3 * codes_.size());
    for (const std::byte code : codes_) {
      const unsigned high = unsigned(code) >> 4, low = unsigned(code) & 15;
      if (high < 15)
        read_beside_edge(high, low);
      else if (low < 14)
        read_by_table(unsigned(table_[low]));
      else
        read_freely(low == 14);
    }
    return std::move(indices_);
  }

 private:
  struct Edge {
    uint32_t a = 0, b = 0;
  };

  /// A difference to the last one that was read so.
  uint32_t free_index() { return last_ += signed_of(stream_.packed_number()); }

  void read_beside_edge(unsigned edge_number, unsigned low) {
    const Edge edge = edges_[edge_number];
    uint32_t c = 0;
    if (low == 0)
      c = next_++;
    else if (low < 13)
      c = vertices_[low];
    else if (low < 15)
      c = last_ += low == 13 ? -1u : 1u;
    else
      c = free_index();
    if (low == 0 || low >= 13) vertices_.add(c);
    edges_.add({c, edge.b});
    edges_.add({edge.a, c});
    emit(edge.a, edge.b, c);
  }

  void read_by_table(unsigned entry) {
    const uint32_t a = next_++;
    const uint32_t b = known_or_next(entry >> 4), c = known_or_next(entry & 15);
    finish(a, b, c, entry >> 4 == 0, (entry & 15) == 0);
  }

  void read_freely(bool begins_with_next) {
    const unsigned entry = stream_.byte(), of_b = entry >> 4, of_c = entry & 15;
    if (entry == 0) next_ = 0;
    const uint32_t a = begins_with_next ? next_++ : free_index();
    const uint32_t b = of_b == 15 ? free_index() : known_or_next(of_b);
    const uint32_t c = of_c == 15 ? free_index() : known_or_next(of_c);
    finish(a, b, c, of_b == 0 || of_b == 15, of_c == 0 || of_c == 15);
  }

  uint32_t known_or_next(unsigned number) { return number == 0 ? next_++ : vertices_[number - 1]; }

  void finish(uint32_t a, uint32_t b, uint32_t c, bool is_b_new, bool is_c_new) {
    edges_.add({b, a});
    edges_.add({c, b});
    edges_.add({a, c});
    vertices_.add(a);
    if (is_b_new) vertices_.add(b);
    if (is_c_new) vertices_.add(c);
    emit(a, b, c);
  }
  void emit(uint32_t a, uint32_t b, uint32_t c) {
    for (const uint32_t index : {a, b, c}) indices_.push_back(index);
  }

  std::span<const std::byte> table_, codes_;
  Stream& stream_;
  uint32_t next_ = 0, last_ = 0;
  Recent<Edge> edges_;
  Recent<uint32_t> vertices_;
  std::vector<uint32_t> indices_;
};

std::vector<uint32_t> read_indices(Stream& stream, size_t count) {
  stream.tail(index_tail);
  std::vector<uint32_t> indices;
  indices.reserve(count);
  uint32_t last[2] = {0, 0};
  for (size_t i = 0; i < count; ++i) {
    const uint32_t number = stream.packed_number();
    indices.push_back(last[number & 1] += signed_of(number >> 1));
  }
  return indices;
}

std::vector<uint8_t> bytes_of(const std::vector<uint32_t>& indices, size_t stride) {
  std::vector<uint8_t> bytes(indices.size() * stride);
  for (size_t i = 0; i < indices.size(); ++i) std::memcpy(&bytes[i * stride], &indices[i], stride);
  return bytes;
}

std::vector<uint8_t> read_packed(Stream& stream, const MeshoptLayout& layout) {
  const auto [mode, filter, count, stride] = layout;
  if (mode == MeshoptMode::attributes) {
    std::vector<uint8_t> bytes = read_attributes(stream, count, stride);
    apply_meshopt_filter(filter, stride, bytes);
    return bytes;
  }
  const bool are_triangles = mode == MeshoptMode::triangles;
  if (stream.byte() != (are_triangles ? triangle_mark : index_mark)) throw DamagedStream();
  return bytes_of(
      are_triangles ? TriangleReader(stream, count / 3).read() : read_indices(stream, count),
      stride);
}

}  // namespace

bool MeshoptLayout::is_sound() const {
  if (mode == MeshoptMode::attributes) {
    if (stride == 0 || stride % 4 != 0 || stride > 256) return false;
    if (filter == MeshoptFilter::octahedral) return stride == 4 || stride == 8;
    return filter != MeshoptFilter::quaternion || stride == 8;
  }
  if (filter != MeshoptFilter::none || (stride != 2 && stride != 4)) return false;
  return mode == MeshoptMode::indices || count % 3 == 0;
}

size_t MeshoptLayout::least_packed_bytes() const {
  if (mode == MeshoptMode::triangles) return 1 + count / 3 + triangle_tail;
  if (mode == MeshoptMode::indices) return 1 + count + index_tail;
  return 1 + count / (4 * group_elements) * stride + std::max(least_attribute_tail, stride);
}

std::optional<std::vector<uint8_t>> unpacked_by_meshopt(std::span<const std::byte> packed,
                                                        const MeshoptLayout& layout) {
  if (!layout.is_sound() || packed.size() < layout.least_packed_bytes()) return std::nullopt;
  try {
    Stream stream(packed);
    std::vector<uint8_t> bytes = read_packed(stream, layout);
    if (!stream.is_empty()) return std::nullopt;
    return bytes;
  } catch (const DamagedStream&) {
    return std::nullopt;
  }
}

}  // namespace kaustik::gltf
