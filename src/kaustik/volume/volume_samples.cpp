#include "kaustik/volume/volume_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik {
namespace {

/// Beyond that, 4 GB of floats, sums over a line lose their digits.
constexpr uint64_t most_values = uint64_t{1} << 30;
/// Of single values: their integrals have to be floats, too.
constexpr float largest_value = 1e30f;

struct Fault {
  std::string message, remedy;
};

bool is_valid_channel_count(uint64_t channels) {
  return channels == 1 || channels == 3 || channels == 6;
}

/// Numbers of all places and channels.
uint64_t value_count(const VolumeSamples& samples) {
  return uint64_t(samples.size[0]) * uint64_t(samples.size[1]) * uint64_t(samples.size[2]) *
         uint64_t(samples.channels);
}

/// What is wrong with so many numbers; nothing if all is well.
std::optional<Fault> fault_of_size(const std::array<uint64_t, 3>& size, uint64_t channels) {
  if (!is_valid_channel_count(channels))
    return Fault{fmt::format("the grid has {} channels", channels), "give it 1, 3 or 6"};
  // In double precision: the product of hostile sizes overflows integers.
  const double count = double(size[0]) * double(size[1]) * double(size[2]) * double(channels);
  if (count <= double(most_values) && count > 0) return std::nullopt;
  return Fault{fmt::format("the grid has {} x {} x {} cells of {} channels", size[0], size[1],
                           size[2], channels),
               fmt::format("give it between one and {} numbers in all", most_values)};
}

/// What is wrong with the values; nothing if all is well.
std::optional<Fault> fault_of_values(const VolumeSamples& samples) {
  for (size_t i = 0; i < samples.values.size(); ++i) {
    const float value = samples.values[i];
    if (std::fabs(value) <= largest_value) continue;
    const size_t cell = i / size_t(samples.channels);
    const size_t x = cell % size_t(samples.size[0]), row = cell / size_t(samples.size[0]);
    return Fault{fmt::format("the value of cell ({}, {}, {}) is {:g}", x,
                             row % size_t(samples.size[1]), row / size_t(samples.size[1]), value),
                 fmt::format("give finite numbers, of at most {:g}", largest_value)};
  }
  return std::nullopt;
}

class VolReader {
 public:
  explicit VolReader(const std::string& path) : path_(path) {}

  VolumeSamples read() {
    const FilePart head = read_file_part(path_, 0, header_bytes);
    check_kind(head.bytes);
    if (head.bytes.size() < header_bytes)
      fail("the file ends within its header", "copy or export it again");
    read_header(head.bytes);
    check_file_size(head.file_size);
    read_values();
    check(fault_of_values(samples_));
    return std::move(samples_);
  }

 private:
  static constexpr size_t header_bytes = 48;
  enum Encoding : int32_t { floats = 1, bytes_of_unit = 3 };

  [[noreturn]] void fail(const std::string& message, const std::string& remedy) const {
    throw Error(ErrorKind::input, message, remedy, place_in(path_));
  }
  void check(const std::optional<Fault>& fault) const {
    if (fault) fail(fault->message, fault->remedy);
  }

  void check_kind(const std::vector<uint8_t>& head) const {
    const std::string start(
        head.begin(), head.begin() + std::ptrdiff_t(std::min<size_t>(head.size(), size_t(8))));
    if (start.starts_with("NanoVDB") || start.starts_with(" BDV"))
      fail("this is a file of OpenVDB's or NanoVDB's, which are not read yet",
           "convert the grid to Mitsuba's format VOL");
    if (!start.starts_with("VOL") || head.size() < 4)
      fail("this is not a volume: it does not begin with 'VOL'",
           "name a file of Mitsuba's format VOL");
    if (head[3] != 3)
      fail(fmt::format("the volume has version {}, not 3", head[3]), "export it as version 3");
  }

  void read_header(const std::vector<uint8_t>& head) {
    int32_t numbers[5];
    float bounds[6];
    std::memcpy(numbers, head.data() + 4, sizeof(numbers));
    std::memcpy(bounds, head.data() + 24, sizeof(bounds));
    encoding_ = numbers[0];
    if (encoding_ != floats && encoding_ != bytes_of_unit)
      fail(fmt::format("the volume's numbers are of encoding {}", encoding_),
           "export them as floats of 32 bits (1), or as bytes (3)");
    std::array<uint64_t, 3> size{};
    for (size_t axis = 0; axis < 3; ++axis) {
      if (numbers[1 + axis] < 1)
        fail(fmt::format("the volume has {} cells along {}", numbers[1 + axis], "xyz"[axis]),
             "the file is damaged: export it again");
      size[axis] = uint64_t(numbers[1 + axis]);
      samples_.size[axis] = numbers[1 + axis];
    }
    check(fault_of_size(size, uint64_t(std::max(0, numbers[4]))));
    samples_.channels = numbers[4];
    samples_.box = Bounds3f({bounds[0], bounds[1], bounds[2]}, {bounds[3], bounds[4], bounds[5]});
  }

  size_t value_bytes() const { return encoding_ == floats ? sizeof(float) : 1; }
  uint64_t data_bytes() const { return value_count(samples_) * value_bytes(); }

  void check_file_size(uint64_t file_size) const {
    if (file_size == header_bytes + data_bytes()) return;
    fail(fmt::format("the volume's {} x {} x {} cells take {} bytes, but {} are there",
                     samples_.size[0], samples_.size[1], samples_.size[2], data_bytes(),
                     file_size - header_bytes),
         "the file is damaged or truncated: copy or export it again");
  }

  /// Piece by piece, so that the file is not in memory twice.
  void read_values() {
    constexpr size_t piece = size_t{1} << 24;
    samples_.values.resize(size_t(value_count(samples_)));
    size_t done = 0;
    while (done < samples_.values.size()) {
      const FilePart part =
          read_file_part(path_, header_bytes + uint64_t(done) * value_bytes(), piece);
      const size_t count =
          std::min(part.bytes.size() / value_bytes(), samples_.values.size() - done);
      if (count == 0) fail("the file ends too early", "copy or export it again");
      float* to = samples_.values.data() + done;
      if (encoding_ == floats)
        std::memcpy(to, part.bytes.data(), count * sizeof(float));
      else
        for (size_t i = 0; i < count; ++i) to[i] = float(part.bytes[i]) / 255.0f;
      done += count;
    }
  }

  const std::string& path_;
  VolumeSamples samples_;
  int32_t encoding_ = floats;
};

}  // namespace

VolumeSamples read_vol(const std::string& path) { return VolReader(path).read(); }

VolumeSamples samples_of_array(const Array& array) {
  const auto fail = [](const Fault& fault) {
    throw Error(ErrorKind::input, fault.message, fault.remedy);
  };
  const std::vector<size_t>& extents = array.extents();
  if (extents.size() != 3 && extents.size() != 4)
    fail({fmt::format("a volume cannot have the extents {}", extents_text(extents)),
          "give [z, y, x], or [z, y, x, 1, 3 or 6]"});
  const uint64_t channels = extents.size() == 4 ? extents[3] : 1;
  if (const auto fault = fault_of_size({extents[2], extents[1], extents[0]}, channels))
    fail(*fault);
  VolumeSamples samples;
  samples.size = {int(extents[2]), int(extents[1]), int(extents[0])};
  samples.channels = int(channels);
  array.visit([&]<typename T>(std::span<const T> values) {
    if constexpr (std::is_same_v<T, uint8_t> || std::is_same_v<T, uint16_t> ||
                  std::is_floating_point_v<T>) {
      const float unit = std::is_floating_point_v<T> ? 1.0f : sizeof(T) == 1 ? 255.0f : 65535.0f;
      samples.values.reserve(values.size());
      for (const T value : values) samples.values.push_back(float(value) / unit);
    } else {
      fail({fmt::format("a volume cannot be made of {}", element_name(array.type())),
            "give uint8, uint16, float32 or float64"});
    }
  });
  if (const auto fault = fault_of_values(samples)) fail(*fault);
  return samples;
}

}  // namespace kaustik
