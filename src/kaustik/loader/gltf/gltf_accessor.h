#pragma once
// Accessors: typed numbers in buffers.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/base/array.h"
#include "kaustik/loader/gltf/gltf_file.h"

namespace kaustik::gltf {

/// Numbers of one accessor, of which there are `components` for each element.
struct AccessorShape {
  size_t count = 0, components = 0;
  float scale = 1;  ///< of integers that are normalised, one over the largest; else 1
};

/// The numbers of an array of floats.
inline std::span<const float> floats_in(const Array& array) {
  return {reinterpret_cast<const float*>(array.bytes().data()), array.count()};
}

/// Reads the accessors of a file, each once for each way of reading it.
class Accessors {
 public:
  explicit Accessors(File& file) : file_(file) {}

  AccessorShape shape(size_t index, const JsonValue& at) const;

  /// As floats [count, components]: integers that are normalised stand for −1 … 1 or 0 … 1, others
  /// for themselves. Floats without gaps are those of the buffer, not copied. Throws MissingData
  /// where the buffer is not there.
  std::shared_ptr<const Array> floats(size_t index, const JsonValue& at);
  /// As unsigned integers [count]; those of the buffer where they have no gaps.
  std::shared_ptr<const Array> indices(size_t index, const JsonValue& at);

  /// Whether it has been given numbers, or been read.
  bool knows_floats(size_t index) const { return known_.contains({index, true}); }
  /// Gives numbers to an accessor that has no buffer: what floats(), or indices(), is to tell.
  void supply_floats(size_t index, std::shared_ptr<const Array> values) {
    known_[{index, true}] = std::move(values);
  }
  void supply_indices(size_t index, std::shared_ptr<const Array> values) {
    known_[{index, false}] = std::move(values);
  }

  /// The box of an accessor by its `min` and `max` alone; nothing without them.
  std::optional<Bounds3f> told_bounds(size_t index, const JsonValue& at) const;

 private:
  /// How an accessor's numbers lie.
  struct Layout {
    int component_type = 0;
    size_t component_bytes = 0, row_components = 0, columns = 1, column_bytes = 0;
    size_t count = 0, element_bytes = 0, stride = 0;
    bool is_normalised = false;
    size_t components() const { return row_components * columns; }
  };
  /// Elements that take the place of others.
  struct Sparse {
    std::vector<size_t> places;
    Bytes values;
  };

  Layout layout_of(const JsonValue& accessor, size_t index) const;
  std::optional<Bytes> bytes_of(const JsonValue& accessor, const Layout& layout, size_t index);
  Bytes checked_part(size_t view, size_t offset, size_t wanted, const JsonValue& at,
                     const std::string& who);
  std::optional<Sparse> sparse_of(const JsonValue& accessor, const Layout& layout, size_t index);
  std::shared_ptr<const Array> read_floats(const JsonValue& accessor, size_t index);
  std::shared_ptr<const Array> read_indices(const JsonValue& accessor, size_t index);

  File& file_;
  std::map<std::pair<size_t, bool>, std::shared_ptr<const Array>> known_;
};

}  // namespace kaustik::gltf
