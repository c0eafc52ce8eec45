#include "kaustik/loader/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "kaustik/base/text_lines.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

/// A picture, and how it lies on the surface: u and v times `scale`, then plus `offset`.
struct MtlMap {
  std::string file;
  Vec3d scale{1, 1, 1}, offset{0, 0, 0};
  bool clamps = false;
};

struct MtlMaterial {
  Place place;
  Rgb diffuse{0.5, 0.5, 0.5}, specular{0, 0, 0};
  std::optional<Rgb> filter;
  double exponent = 0, ior = 1;
  std::optional<double> dissolve, transparency;
  int illumination = 2;
  std::optional<MtlMap> diffuse_map, dissolve_map;
};

double largest(const Rgb& color) { return std::max({color.r, color.g, color.b}); }
Rgb scaled(const Rgb& color, double factor) {
  return {color.r * factor, color.g * factor, color.b * factor};
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return lower;
}

class MtlReader {
 public:
  MtlReader(const std::string& path, const FindBeside& find)
      : path_(path), find_(find), lines_(path) {}

  MtlFile read() {
    for (std::string_view line; lines_.next(line);) try {
        read_line(line);
      } catch (const BadNumber&) {
        remark_bad_line();
      }
    for (const auto& [name, material] : materials_) result_.bsdfs[name] = bsdf_of(material);
    return std::move(result_);
  }

 private:
  /// A number that is missing, or none.
  struct BadNumber {};

  Place here() const { return place_in(path_, lines_.number()); }
  void remark_bad_line() {
    if (!has_bad_lines_)
      result_.remarks.push_back(fmt::format(
          "{}:{}: this line does not hold the numbers that belong there: it and others like it "
          "are left out",
          path_, lines_.number()));
    has_bad_lines_ = true;
  }

  void read_line(std::string_view line);
  std::optional<double> number_in(std::string_view word) const;
  double number(std::string_view& line, double low, double high) const;
  Rgb color(std::string_view line) const;
  std::optional<MtlMap> map(std::string_view line);
  bool read_map_option(std::string_view option, std::string_view& line, MtlMap& map) const;

  std::shared_ptr<Object> bsdf_of(const MtlMaterial& material) const;
  std::shared_ptr<Object> opaque_bsdf(const MtlMaterial& material) const;

  std::string path_;
  const FindBeside& find_;
  TextLines lines_;
  std::map<std::string, MtlMaterial> materials_;
  MtlMaterial* current_ = nullptr;
  bool has_bad_lines_ = false;
  MtlFile result_;
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
Rgb MtlReader::color(std::string_view line) const {
  std::string_view rest = line;
  const double r = number(rest, 0, 1);
  std::string_view further = rest;
  if (next_word(further).empty()) return {r, r, r};
  const double g = number(rest, 0, 1);
  return {r, g, number(rest, 0, 1)};
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
  constexpr std::string_view with_one[] = {"-blendu",  "-blendv", "-cc",   "-bm",
                                           "-imfchan", "-texres", "-boost"};
  if (std::find(std::begin(with_one), std::end(with_one), option) == std::end(with_one))
    return false;
  next_word(line);
  return true;
}

/// Nothing if there is no such file.
std::optional<MtlMap> MtlReader::map(std::string_view line) {
  MtlMap map;
  for (std::string_view rest = line;; line = rest)
    if (!read_map_option(next_word(rest), rest, map)) break;
  // The name is the rest of the line: it may hold blanks.
  const std::optional<fs::path> file =
      find_(std::string(trimmed(line)), fs::path(path_).parent_path(), here());
  if (!file) {
    result_.remarks.push_back(
        fmt::format("{}:{}: there is no such picture: the material has its plain colour", path_,
                    lines_.number()));
    return std::nullopt;
  }
  map.file = file->string();
  return map;
}

void MtlReader::read_line(std::string_view line) {
  const std::string keyword = lower_case(next_word(line));
  if (keyword == "newmtl") {
    current_ = &materials_[std::string(trimmed(line))];
    *current_ = {};
    current_->place = here();
    return;
  }
  if (!current_) return;
  if (keyword == "kd")
    current_->diffuse = color(line);
  else if (keyword == "ks")
    current_->specular = color(line);
  else if (keyword == "tf")
    current_->filter = color(line);
  else if (keyword == "ns")
    current_->exponent = number(line, 0, 1e6);
  else if (keyword == "ni")
    current_->ior = number(line, 0, 100);
  else if (keyword == "tr")
    current_->transparency = number(line, 0, 1);
  else if (keyword == "illum")
    current_->illumination = int(number(line, 0, 10));
  else if (keyword == "map_kd")
    current_->diffuse_map = map(line);
  else if (keyword == "map_d")
    current_->dissolve_map = map(line);
  else if (keyword == "d") {
    std::string_view rest = line;
    if (next_word(rest) == "-halo") line = rest;
    current_->dissolve = number(line, 0, 1);
  }
}

std::shared_ptr<Object> bsdf(const char* type, const Place& place) {
  return std::make_shared<Object>(Object{"bsdf", type, "", {}, {}, place});
}

Child texture(const std::string& name, const MtlMap& map, bool is_raw, const Place& place) {
  auto made = std::make_shared<Object>(Object{"texture", "bitmap", "", {}, {}, place});
  made->properties = {{"filename", map.file, place}, {"raw", is_raw, place}};
  if (map.clamps) made->properties.push_back({"wrap_mode", std::string("clamp"), place});
  const Vec3d &s = map.scale, &o = map.offset;
  if ((s.x != 1 || s.y != 1 || o.x != 0 || o.y != 0) && s.x != 0 && s.y != 0)
    // Of coordinates with v turned upside down, as OBJ files have it.
    made->properties.push_back(
        {"to_uv", Transform::translate({o.x, 1 - s.y - o.y, 0}) * Transform::scale({s.x, s.y, 1}),
         place});
  return {name, made};
}

/// Diffuse, with a highlight or a mirror.
std::shared_ptr<Object> MtlReader::opaque_bsdf(const MtlMaterial& material) const {
  const Place& place = material.place;
  const double diffuse = material.diffuse_map ? 0.5 : largest(material.diffuse);
  const double specular = largest(material.specular);
  const auto give_diffuse = [&](Object& to, const char* name, double factor) {
    if (material.diffuse_map)
      to.children.push_back(texture(name, *material.diffuse_map, false, place));
    else
      to.properties.push_back({name, scaled(material.diffuse, factor), place});
  };
  constexpr double least_specular = 0.02;
  if (specular < least_specular) {
    auto plain = bsdf("diffuse", place);
    give_diffuse(*plain, "reflectance", 1);
    return plain;
  }
  const double total = std::max(1.0, diffuse + specular);
  const bool is_mirror =
      material.illumination == 3 || material.illumination == 5 || material.exponent > 1000;
  if (!is_mirror) {
    auto glossy = bsdf("phong", place);
    give_diffuse(*glossy, "diffuse_reflectance", 1 / total);
    glossy->properties.push_back(
        {"specular_reflectance", scaled(material.specular, 1 / total), place});
    glossy->properties.push_back({"exponent", material.exponent, place});
    return glossy;
  }
  // The blend takes of each its share: both are that much brighter.
  const double share = specular / (diffuse + specular);
  auto mirror = bsdf("conductor", place);
  mirror->properties.push_back({"material", std::string("none"), place});
  mirror->properties.push_back(
      {"specular_reflectance", scaled(material.specular, 1 / (share * total)), place});
  if (diffuse < least_specular) return mirror;
  auto plain = bsdf("diffuse", place);
  give_diffuse(*plain, "reflectance", 1 / ((1 - share) * total));
  auto blend = bsdf("blendbsdf", place);
  blend->properties.push_back({"weight", share, place});
  blend->children = {{"", plain}, {"", mirror}};
  return blend;
}

std::shared_ptr<Object> MtlReader::bsdf_of(const MtlMaterial& material) const {
  const Place& place = material.place;
  // Tr is 1 − d, but where nothing would be left of the material: there the writer means d.
  double opacity = 1;
  if (material.dissolve)
    opacity = *material.dissolve;
  else if (material.transparency && *material.transparency < 1)
    opacity = 1 - *material.transparency;
  const Rgb filter =
      material.filter && largest(*material.filter) > 0 ? *material.filter : Rgb{1, 1, 1};
  const bool is_filtered = std::min({filter.r, filter.g, filter.b}) < 1;
  const int model = material.illumination;
  const bool is_glass = model == 4 || model == 6 || model == 7 || model == 9 ||
                        (material.ior != 1 && (opacity < 1 || is_filtered));
  if (is_glass) {
    auto glass = bsdf("dielectric", place);
    glass->properties.push_back({"int_ior", material.ior > 1 ? material.ior : 1.5, place});
    if (is_filtered) glass->properties.push_back({"specular_transmittance", filter, place});
    return glass;
  }
  auto opaque = opaque_bsdf(material);
  if (opacity >= 1 && !material.dissolve_map) return opaque;
  auto mask = bsdf("mask", place);
  if (material.dissolve_map)
    mask->children.push_back(texture("opacity", *material.dissolve_map, true, place));
  else
    mask->properties.push_back({"opacity", opacity, place});
  mask->children.push_back({"", opaque});
  return mask;
}

}  // namespace

MtlFile read_mtl(const std::string& path, const FindBeside& find) {
  return MtlReader(path, find).read();
}

}  // namespace kaustik
