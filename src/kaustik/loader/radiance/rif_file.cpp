#include "kaustik/loader/radiance/rif_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/loader/near_names.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// Of rad. May be written shorter, as long as one alone begins so.
constexpr auto variables = std::to_array<std::string_view>(
    {"objects",     "scene",    "materials",  "illum",   "mkillum",  "render",  "oconv",
     "pfilt",       "view",     "ZONE",       "QUALITY", "OCTREE",   "PICTURE", "AMBFILE",
     "OPTFILE",     "EXPOSURE", "RESOLUTION", "UP",      "INDIRECT", "DETAIL",  "PENUMBRAS",
     "VARIABILITY", "REPORT",   "RAWFILE",    "ZFILE",   "mkpmap",   "PGMAP",   "PCMAP",
     "PIMAP",       "PDMAP",    "PVMAP",      "EYESEP",  "rpict",    "rvu",     "rtpict"});

/// The whole name; "" where none or several begin so. Capitals and small letters are alike.
std::string_view variable_of(std::string_view name) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  std::string_view found;
  for (const std::string_view variable : variables) {
    if (name.empty() || name.size() > variable.size() ||
        !std::equal(name.begin(), name.end(), variable.begin(),
                    [&](char a, char b) { return small(a) == small(b); }))
      continue;
    if (name.size() == variable.size()) return variable;
    // Single letters stand for the most usual one.
    if (found.empty()) found = variable;
  }
  return found;
}

/// A line with those that it goes on in, and where it begins.
class RifLines {
 public:
  explicit RifLines(std::string_view text) : text_(text) {}

  bool next(std::string& line, size_t& begin) {
    if (at_ >= text_.size()) return false;
    line.clear();
    begin = at_;
    for (bool goes_on = true; goes_on && at_ < text_.size();) {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view part = text_.substr(at_, end - at_);
      at_ = end + 1;
      if (part.ends_with('\r')) part.remove_suffix(1);
      goes_on = part.ends_with('\\');
      if (goes_on) part.remove_suffix(1);
      line += part;
      if (goes_on) line += ' ';
    }
    return true;
  }

 private:
  std::string_view text_;
  size_t at_ = 0;
};

void add_files(std::string_view value, const Place& place,
               std::vector<std::pair<std::string, Place>>& files) {
  for (auto word = next_word(value); !word.empty(); word = next_word(value))
    files.emplace_back(std::string(word), place);
}

void read_resolution(std::string_view value, const Place& place, PictureOptions& picture) {
  const auto width = number_of(next_word(value));
  const std::string_view second = next_word(value);
  const auto height = second.empty() ? width : number_of(second);
  if (!width || !height || !(*width >= 1 && *width <= 65536) || !(*height >= 1 && *height <= 65536))
    throw Error(ErrorKind::input, "RESOLUTION is no size of a picture",
                "write one number of pixels, or width and height", place);
  picture.width = int(*width);
  picture.height = int(*height);
}

void read_exposure(std::string_view value, const Place& place, PictureOptions& picture) {
  const std::string_view word = next_word(value);
  const auto number = number_of(word);
  const bool is_stops = word.starts_with('+') || word.starts_with('-');
  if (!number || (!is_stops && !(*number > 0)))
    throw Error(ErrorKind::input, "EXPOSURE is no exposure",
                "write stops with a sign (+1.5), or a factor above zero", place);
  picture.exposure_stops = is_stops ? *number : std::log2(*number);
}

/// Options of rpict; only those that change what is seen count.
void read_render(std::string_view value, const Place& place, RifFile& rif, Deviations& deviations) {
  for (auto word = next_word(value); !word.empty(); word = next_word(value)) {
    std::string_view rest = value;
    if (word == "-pd") {
      rif.picture.lens_diameter = std::max(number_of(next_word(rest)).value_or(0), 0.0);
    } else if (word == "-av") {
      bool is_zero = true;
      for (int i = 0; i < 3; ++i) is_zero = is_zero && number_of(next_word(rest)).value_or(0) == 0;
      if (!is_zero)
        deviations.ignored("render", "ambient light (-av) is left out: all light is computed",
                           place);
    } else if (word == "-me" || word == "-ma" || word == "-mg") {
      deviations.ignored("render", "mist everywhere (-me, -ma, -mg) is left out", place);
    } else if (word == "-i" || word == "-i+") {
      deviations.ignored("render",
                         "a picture of irradiance (-i) becomes one of radiance; see "
                         "film.quantity",
                         place);
    }
  }
}

/// What looks like a slip of the pen is an error.
void leave_out(std::string_view name, const Place& place, Deviations& deviations) {
  const std::vector<std::string> names(variables.begin(), variables.end());
  const std::string message = fmt::format("rad knows no variable '{}'", name.substr(0, 40));
  if (const std::string remedy = did_you_mean(name.substr(0, 40), names); !remedy.empty())
    throw Error(ErrorKind::input, message, remedy, place);
  deviations.ignored("control file", message, place);
}

}  // namespace

RifFile read_rif(std::string_view text, const PlaceAt& place_at, Deviations& deviations) {
  RifFile rif;
  std::vector<std::pair<std::string, Place>> materials, illums, scenes;
  RifLines lines(text);
  std::string line;
  size_t begin = 0;
  while (lines.next(line, begin)) {
    const std::string_view whole = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (whole.empty()) continue;
    const Place place = place_at(begin);
    const size_t equals = whole.find('=');
    if (equals == std::string_view::npos)
      throw Error(ErrorKind::input, "this line is no 'variable= value'",
                  "write as in: scene= room.rad", place);
    const std::string_view name = trimmed(whole.substr(0, equals));
    const std::string_view value = trimmed(whole.substr(equals + 1));
    const std::string_view variable = variable_of(name);
    if (variable.empty()) leave_out(name, place, deviations);
    if (variable == "materials")
      add_files(value, place, materials);
    else if (variable == "illum")
      add_files(value, place, illums);
    else if (variable == "scene")
      add_files(value, place, scenes);
    else if (variable == "view")
      rif.views.emplace_back(std::string(value), place);
    else if (variable == "RESOLUTION")
      read_resolution(value, place, rif.picture);
    else if (variable == "EXPOSURE")
      read_exposure(value, place, rif.picture);
    else if (variable == "render")
      read_render(value, place, rif, deviations);
  }
  for (auto* list : {&materials, &illums, &scenes})
    rif.files.insert(rif.files.end(), list->begin(), list->end());
  return rif;
}

bool begins_as_rif(std::string_view text) {
  RifLines lines(text);
  std::string line;
  size_t begin = 0;
  while (lines.next(line, begin)) {
    const std::string_view whole = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (whole.empty()) continue;
    const size_t equals = whole.find('=');
    const std::string_view name = trimmed(whole.substr(0, std::min(equals, whole.size())));
    return equals != std::string_view::npos && name.size() >= 2 &&
           name.find_first_of(" \t<>\"'") == std::string_view::npos && !variable_of(name).empty();
  }
  return false;
}

}  // namespace kaustik::radiance
