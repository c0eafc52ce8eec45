#include "kaustik/loader/radiance/data_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

constexpr size_t most_dimensions = 4;

/// Numbers with blanks, commas or comments between.
class DataReader {
 public:
  explicit DataReader(std::string_view text) : rest_(text) {}

  std::optional<double> next() {
    for (;;) {
      const size_t begin = rest_.find_first_not_of(" \t\r\n,");
      if (begin == std::string_view::npos) return std::nullopt;
      rest_.remove_prefix(begin);
      if (rest_[0] != '#') break;
      rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
    }
    const size_t end = std::min(rest_.find_first_of(" \t\r\n,"), rest_.size());
    const auto value = number_of(rest_.substr(0, end));
    if (!value) throw CalError("a table of data holds something else than numbers");
    rest_.remove_prefix(end);
    return value;
  }
  double number() {
    const auto value = next();
    if (!value) throw CalError("a table of data ends too early");
    return *value;
  }
  size_t letters_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

}  // namespace

DataTable::DataTable(std::string_view text) {
  DataReader reader(text);
  const double dimensions = reader.number();
  if (!(dimensions >= 1 && dimensions <= double(most_dimensions)))
    throw CalError("a table of data has not 1 to 4 dimensions");
  size_t count = 1;
  for (auto left = size_t(dimensions); left > 0; --left) {
    const double first = reader.number(), last = reader.number(), points = reader.number();
    // Each value takes a letter and a blank.
    if (!(points >= 2 && points <= 1e7) || size_t(points) > reader.letters_left() / count)
      throw CalError("a table of data has too few or too many points");
    const auto n = size_t(points);
    count *= n;
    std::vector<double> axis(n);
    const bool is_listed = first == last;
    for (size_t i = 0; i < n; ++i)
      axis[i] = is_listed ? reader.number() : first + (last - first) * double(i) / double(n - 1);
    axes_.push_back(std::move(axis));
  }
  values_.reserve(count);
  for (size_t i = 0; i < count; ++i) values_.push_back(reader.number());
}

double DataTable::at(std::span<const double> point) const {
  size_t low[most_dimensions] = {};
  double share[most_dimensions] = {};
  for (size_t d = 0; d < axes_.size(); ++d) {
    const std::vector<double>& axis = axes_[d];
    const bool is_falling = axis.back() < axis.front();
    const auto beyond = std::partition_point(axis.begin(), axis.end(), [&](double at) {
      return is_falling ? at >= point[d] : at <= point[d];
    });
    const auto next = std::clamp<ptrdiff_t>(beyond - axis.begin(), 1, ptrdiff_t(axis.size()) - 1);
    low[d] = size_t(next - 1);
    const double step = axis[size_t(next)] - axis[low[d]];
    const double along = step != 0 ? (point[d] - axis[low[d]]) / step : 0;
    share[d] = std::isfinite(along) ? std::clamp(along, 0.0, 1.0) : 0.0;
  }
  double sum = 0;
  for (size_t corner = 0; corner < size_t{1} << axes_.size(); ++corner) {
    double weight = 1;
    size_t index = 0;
    for (size_t d = 0; d < axes_.size(); ++d) {
      const size_t high = corner >> d & 1;
      weight *= high ? share[d] : 1 - share[d];
      index = index * axes_[d].size() + low[d] + high;
    }
    if (weight > 0) sum += weight * values_[index];
  }
  return sum;
}

double DataTable::mean() const {
  return std::accumulate(values_.begin(), values_.end(), 0.0) / double(values_.size());
}

}  // namespace kaustik::radiance
