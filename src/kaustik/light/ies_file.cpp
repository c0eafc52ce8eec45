// IES LM-63: a header of keywords, the line TILT=, then numbers in free form.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/light/photometric_file.h"
#include "kaustik/light/photometric_number.h"

namespace kaustik {
namespace {

constexpr const char* ies_remedy = "get the file again from the maker of the luminaire";

struct Number {
  double value;
  int line;
};

bool is_gap(char c) {
  return c == '\0' || c == '\x1a' || std::isspace(static_cast<unsigned char>(c));
}

std::string in_upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

/// What follows "TILT=" on its line, in upper case; nothing where the line is another one.
std::optional<std::string> tilt_of(std::string_view line) {
  const std::string upper = in_upper_case(trimmed(line));
  if (!upper.starts_with("TILT")) return std::nullopt;
  const std::string_view rest = trimmed(std::string_view(upper).substr(4));
  if (!rest.starts_with('=')) return std::nullopt;
  return std::string(trimmed(rest.substr(1)));
}

class IesReader {
 public:
  IesReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Photometry read() {
    read_header();
    const size_t begin = at_;
    const int line = line_;
    // Numbers are parted by commas, too, if that makes sense; else commas are decimal ones.
    const std::string_view rest = text_.substr(begin);
    split(rest, line, true);
    if (rest.find(',') != std::string_view::npos && !has_right_count()) {
      split(rest, line, false);
      if (has_right_count())
        remark("its numbers have decimal commas");
      else
        split(rest, line, true);
    }
    return read_numbers();
  }

 private:
  [[noreturn]] void fail(const std::string& message, int line) const {
    throw Error(ErrorKind::input, message, ies_remedy, place_in(name_, line));
  }
  void remark(std::string text) { remarks_.push_back(std::move(text)); }

  std::string_view next_line() {
    const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end;
    if (at_ < text_.size()) at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
    ++line_;
    return line;
  }

  void read_header() {
    bool is_first = true;
    while (at_ < text_.size()) {
      const std::string_view line = trimmed(next_line());
      if (line.empty()) continue;
      if (is_first) {
        const std::string upper = in_upper_case(line);
        // Value 12 is a factor up to 1991; from 1995 on it is 1, or a code.
        has_second_factor_ = upper.find("LM-63-") == std::string::npos;
        is_first = false;
      }
      if (const auto tilt = tilt_of(line)) {
        has_tilt_table_ = *tilt == "INCLUDE";
        if (!has_tilt_table_ && *tilt != "NONE")
          remark("the factors of its file of tilts are left out");
        return;
      }
    }
    fail("there is no line TILT=: this is no IES file, or a part of one", std::max(line_, 1));
  }

  /// The words after the header as numbers, up to the first that is none.
  void split(std::string_view rest, int line, bool at_commas) {
    numbers_.clear();
    wrong_word_.reset();
    ++line;
    for (size_t i = 0; i < rest.size();) {
      const char c = rest[i];
      if (c == '\n' || (c == '\r' && rest.substr(i, 2) != "\r\n")) ++line;
      if (is_gap(c) || (at_commas && c == ',')) {
        ++i;
        continue;
      }
      size_t end = i;
      while (end < rest.size() && !is_gap(rest[end]) && !(at_commas && rest[end] == ',')) ++end;
      const auto value = photometric_number(rest.substr(i, end - i));
      if (!value) {
        wrong_word_ = {std::string(rest.substr(i, std::min<size_t>(end - i, 40))), line};
        return;
      }
      numbers_.push_back({*value, line});
      i = end;
    }
  }

  /// Whether the counts of angles are possible ones, and just as many numbers follow.
  bool has_right_count() const {
    size_t at = 0;
    if (has_tilt_table_) {
      if (numbers_.size() < 2 || !(numbers_[1].value >= 0 && numbers_[1].value < 1e6)) return false;
      at = 2 + 2 * size_t(numbers_[1].value);
    }
    if (numbers_.size() < at + 13) return false;
    const double v = numbers_[at + 3].value, h = numbers_[at + 4].value;
    const auto is_count = [](double n) { return n >= 1 && n < 1e6 && n == std::floor(n); };
    return is_count(v) && is_count(h) && double(numbers_.size() - at) == 13 + v + h + v * h;
  }

  /// Where the numbers end at something else.
  void fail_if_no_number() const {
    if (wrong_word_)
      fail(fmt::format("'{}' is not a number", wrong_word_->first), wrong_word_->second);
  }
  double next(const char* what) {
    if (next_ >= numbers_.size()) {
      fail_if_no_number();
      fail(fmt::format("the file ends before {}", what),
           numbers_.empty() ? line_ : numbers_.back().line);
    }
    return numbers_[next_++].value;
  }
  int line_here() const { return next_ > 0 ? numbers_[next_ - 1].line : line_; }
  size_t next_count(const char* what) {
    const double number = next(what);
    if (!(number >= 1 && number == std::floor(number) && number < 1e6))
      fail(fmt::format("{} is {:.6g}", what, number), line_here());
    return size_t(number);
  }
  /// A factor of the whole file: zero is a gap that somebody has filled.
  double next_factor(const char* what) {
    const double factor = next(what);
    if (factor > 0) return factor;
    remark(fmt::format("{} is {:.4g}: it is taken as 1", what, factor));
    return 1;
  }

  /// The factor for a luminaire that hangs as it was measured.
  double read_tilt() {
    if (!has_tilt_table_) return 1;
    next("the geometry of the lamp");
    const size_t count = next_count("the number of tilt angles");
    if (count > numbers_.size()) fail("the table of tilts is cut off", line_here());
    std::vector<double> angles(count);
    for (double& angle : angles) angle = next("the end of the tilt angles");
    double factor = 1;
    for (const double angle : angles) {
      const double there = next("the end of the tilt factors");
      if (angle == 0 && there > 0) factor = there;
    }
    return factor;
  }

  std::vector<double> read_angles(size_t count, const char* what) {
    if (count > numbers_.size() - next_) {
      fail_if_no_number();
      fail(fmt::format("the file announces {} {}, and has no such many numbers", count, what),
           line_here());
    }
    std::vector<double> angles(count);
    for (double& angle : angles) angle = next(what);
    return angles;
  }

  Photometry read_numbers() {
    const double tilt = read_tilt();
    const double lamps = next("the number of lamps"), lumens = next("the lumens of a lamp");
    const double multiplier = next_factor("its multiplier");
    const size_t angle_count = next_count("the number of vertical angles");
    const size_t plane_count = next_count("the number of horizontal angles");
    const double type = next("the type of photometry");
    next("the unit of lengths");
    for (int i = 0; i < 3; ++i) next("the size of the luminous opening");
    const double ballast = next_factor("its ballast factor");
    const double second = has_second_factor_ ? next_factor("its second ballast factor")
                                             : next("the value after the ballast factor");
    next("the power");
    if (type != 1 && type != 2 && type != 3)
      fail(fmt::format("the type of photometry is {:.6g}, not 1, 2 or 3", type), line_here());
    const double factor = multiplier * ballast * (has_second_factor_ ? second : 1) * tilt;

    PhotometricPlanes planes;
    planes.angles = read_angles(angle_count, "vertical angles");
    planes.planes = read_angles(plane_count, "horizontal angles");
    const size_t left = numbers_.size() - next_;
    if (left / angle_count < plane_count) {
      fail_if_no_number();
      fail(fmt::format("there are {} intensities, and the angles ask for {}", left,
                       angle_count * plane_count),
           line_here());
    }
    planes.candelas.reserve(angle_count * plane_count);
    for (size_t i = 0; i < angle_count * plane_count; ++i)
      planes.candelas.push_back(next("the end of the intensities") * factor);
    if (next_ < numbers_.size() || wrong_word_)
      remark("what follows the intensities of the first luminaire is left out");
    for (const double candela : planes.candelas)
      if (!(std::fabs(candela) < 1e30)) fail("an intensity is too large for a number", line_here());
    tidy(planes, remarks_);

    const char* const letter = type == 1 ? "C" : type == 2 ? "B" : "A";
    std::string facts = lumens < 0 ? std::string("absolute photometry")
                                   : fmt::format("{:.4g} × {:.6g} lm of lamps", lamps, lumens);
    facts += fmt::format(", factor {:.4g}, type {}", factor, letter);
    IntensityTable table =
        type == 1 ? table_of_type_c(planes) : table_of_other_type(planes, type == 3);
    return {std::move(table), std::move(facts), std::move(remarks_)};
  }

  IntensityTable table_of_type_c(PhotometricPlanes& planes) {
    const double first = planes.planes.front(), last = planes.planes.back();
    if (planes.angles.size() < 2)
      fail("there is one vertical angle; at least two make a distribution", line_here());
    if (planes.angles.front() < 0 || planes.angles.back() > 180.001)
      fail(fmt::format("the vertical angles are {:.4g}° to {:.4g}°; those of type C lie between 0° "
                       "and 180°",
                       planes.angles.front(), planes.angles.back()),
           line_here());
    if (first < -360 || last > 720)
      fail(fmt::format("the horizontal angles are {:.4g}° to {:.4g}°", first, last), line_here());
    if (planes.planes.size() == 1) {
      if (first != 0)
        remark(fmt::format("its only plane is at {:.4g}°: it counts all around", first));
      return table_of_planes(planes, remarks_);
    }
    const auto are = [&](double from, double to) {
      return std::fabs(first - from) < 0.01 && std::fabs(last - to) < 0.01;
    };
    planes.mirror_at_0 = are(0, 90) || are(0, 180) || are(180, 360);
    planes.mirror_at_90 = are(0, 90) || are(90, 270) || are(-90, 90);
    const double step = planes.planes[1] - first;
    if (!planes.mirror_at_0 && !planes.mirror_at_90 && last - first < 359.99 - 1.001 * step)
      remark(fmt::format("its planes go from {:.4g}° to {:.4g}°: in the gap they are joined", first,
                         last));
    return table_of_planes(planes, remarks_);
  }

  IntensityTable table_of_other_type(const PhotometricPlanes& planes, bool is_type_a) const {
    if (planes.planes.size() < 2 || planes.angles.size() < 2)
      fail("types A and B need at least two angles in each direction", line_here());
    for (const auto* angles : {&planes.planes, &planes.angles})
      if (angles->front() < -180.001 || angles->back() > 180.001)
        fail(fmt::format("the angles are {:.4g}° to {:.4g}°; those of types A and B lie between "
                         "-90° and 90°",
                         angles->front(), angles->back()),
             line_here());
    return table_of_sheaves(planes, is_type_a);
  }

  std::string_view text_;
  const std::string& name_;
  size_t at_ = 0;
  int line_ = 0;
  bool has_second_factor_ = true, has_tilt_table_ = false;
  std::vector<Number> numbers_;
  std::optional<std::pair<std::string, int>> wrong_word_;  ///< after the numbers, and its line
  size_t next_ = 0;
  std::vector<std::string> remarks_;
};

}  // namespace

Photometry read_ies(std::string_view text, const std::string& name) {
  return IesReader(text, name).read();
}

}  // namespace kaustik
