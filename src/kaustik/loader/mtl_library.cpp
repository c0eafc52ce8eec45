#include "kaustik/loader/mtl_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/lower_case.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

class MtlReader {
 public:
  MtlReader(const std::string& path, const FindBeside& find, MtlKeys keys)
      : path_(path), find_(find), keys_(keys), lines_(path) {}

  MtlLibrary read() {
    for (std::string_view line; lines_.next(line);) try {
        read_line(line);
      } catch (const BadNumber&) {
        remark_bad_line();
      }
    return std::move(result_);
  }

 private:
  /// A number that is missing, or none.
  struct BadNumber {};

  Place here() const { return place_in(path_, lines_.number()); }
  void remark_bad_line() {
    if (!has_bad_lines_)
      result_.remarks.push_back({DeviationKind::ignored,
                                 "this line does not hold the numbers that belong there: it and "
                                 "others like it are left out",
                                 here()});
    has_bad_lines_ = true;
  }

  void read_line(std::string_view line);
  std::optional<double> number_in(std::string_view word) const;
  double number(std::string_view& line, double low, double high) const;
  Rgb color(std::string_view line, double most = 1) const;
  std::optional<MtlMap> map(std::string_view line);
  bool read_map_option(std::string_view option, std::string_view& line, MtlMap& map) const;
  bool read_number(std::string_view keyword, std::string_view line);
  bool read_map(std::string_view keyword, std::string_view line);

  std::string path_;
  const FindBeside& find_;
  MtlKeys keys_;
  TextLines lines_;
  MtlMaterial* current_ = nullptr;
  bool has_bad_lines_ = false;
  MtlLibrary result_;
};

std::optional<double> MtlReader::number_in(std::string_view word) const {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

double MtlReader::number(std::string_view& line, double low, double high) const {
  const std::optional<double> value = number_in(next_word(line));
  if (!value) throw BadNumber();
  return std::clamp(*value, low, high);
}

/// Three numbers, or one for all; also out of a range that surfaces have.
Rgb MtlReader::color(std::string_view line, double most) const {
  std::string_view rest = line;
  const double r = number(rest, 0, most);
  std::string_view further = rest;
  if (next_word(further).empty()) return {r, r, r};
  const double g = number(rest, 0, most);
  return {r, g, number(rest, 0, most)};
}

/// True if it was one; then its arguments are taken off the line.
bool MtlReader::read_map_option(std::string_view option, std::string_view& line,
                                MtlMap& map) const {
  const auto numbers = [&](Vec3d& values) {
    for (int i = 0; i < 3; ++i) {
      std::string_view rest = line;
      const std::optional<double> value = number_in(next_word(rest));
      if (!value) break;
      values[i] = *value;
      line = rest;
    }
  };
  Vec3d unused(0, 0, 0);
  if (option == "-s") return numbers(map.scale), true;
  if (option == "-o") return numbers(map.offset), true;
  if (option == "-t" || option == "-mm") return numbers(unused), true;
  if (option == "-clamp") return map.clamps = next_word(line) == "on", true;
  if (option == "-bm") {
    const std::optional<double> factor = number_in(next_word(line));
    return map.bump = factor.value_or(1), true;
  }
  if (option == "-imfchan") {
    const std::string channel = lower_case(std::string(next_word(line)));
    if (channel == "r" || channel == "g" || channel == "b") map.channel = channel;
    if (channel == "m") map.channel = "a";
    return true;
  }
  constexpr std::string_view with_one[] = {"-blendu", "-blendv", "-cc", "-texres", "-boost"};
  if (std::find(std::begin(with_one), std::end(with_one), option) == std::end(with_one))
    return false;
  next_word(line);
  return true;
}

/// Nothing where no file is named; what is not there is told.
std::optional<MtlMap> MtlReader::map(std::string_view line) {
  MtlMap map;
  for (std::string_view rest = line;; line = rest)
    if (!read_map_option(next_word(rest), rest, map)) break;
  // The name is the rest of the line: it may hold blanks.
  const std::optional<fs::path> file =
      find_(std::string(trimmed(line)), fs::path(path_).parent_path(), here());
  if (file)
    map.file = file->string();
  else
    result_.remarks.push_back({DeviationKind::missing, "there is no such picture", here()});
  return map;
}

void MtlReader::read_line(std::string_view line) {
  const std::string keyword = lower_case(std::string(next_word(line)));
  if (keyword == "newmtl") {
    current_ = &result_.materials[std::string(trimmed(line))];
    *current_ = {};
    current_->place = here();
    return;
  }
  if (!current_) return;
  MtlMaterial& material = *current_;
  if (keyword == "kd")
    material.diffuse = color(line);
  else if (keyword == "ks")
    material.specular = color(line);
  else if (keyword == "tf")
    material.filter = color(line);
  else if (keyword == "ke" && keys_ == MtlKeys::all)
    material.emission = color(line, 1e6);
  else if (keyword == "illum")
    material.illumination = int(number(line, 0, 10));
  else if (keyword == "d") {
    std::string_view rest = line;
    if (next_word(rest) == "-halo") line = rest;
    material.dissolve = number(line, 0, 1);
  } else if (!read_number(keyword, line)) {
    read_map(keyword, line);
  }
}

/// False: it is none of these.
bool MtlReader::read_number(std::string_view keyword, std::string_view line) {
  MtlMaterial& material = *current_;
  if (keyword == "ns") return material.exponent = number(line, 0, 1e6), true;
  if (keyword == "ni") return material.ior = number(line, 0, 100), true;
  if (keyword == "tr") return material.transparency = number(line, 0, 1), true;
  const std::pair<std::string_view, std::optional<double>*> shares[] = {
      {"pr", &material.roughness},       {"pm", &material.metallic},
      {"ps", &material.sheen},           {"pc", &material.coat},
      {"pcr", &material.coat_roughness}, {"aniso", &material.anisotropy}};
  for (const auto& [name, value] : shares)
    if (keyword == name && keys_ == MtlKeys::all) return *value = number(line, 0, 1), true;
  return false;
}

bool MtlReader::read_map(std::string_view keyword, std::string_view line) {
  MtlMaterial& material = *current_;
  const std::pair<std::string_view, std::optional<MtlMap>*> maps[] = {
      {"map_kd", &material.diffuse_map},  {"map_d", &material.dissolve_map},
      {"map_ke", &material.emission_map}, {"map_pr", &material.roughness_map},
      {"map_pm", &material.metallic_map}, {"map_ks", &material.specular_map},
      {"norm", &material.normal_map},     {"map_kn", &material.normal_map},
      {"map_bump", &material.bump_map},   {"bump", &material.bump_map}};
  for (const auto& [name, value] : maps)
    if (keyword == name && (keys_ == MtlKeys::all || keyword == "map_kd" || keyword == "map_d"))
      return *value = map(line), true;
  return false;
}

}  // namespace

MtlLibrary read_mtl_library(const std::string& path, const FindBeside& find, MtlKeys keys) {
  return MtlReader(path, find, keys).read();
}

}  // namespace kaustik
