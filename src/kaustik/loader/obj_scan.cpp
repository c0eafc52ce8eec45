#include "kaustik/loader/obj_scan.h"

#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "kaustik/base/decimal.h"
#include "kaustik/base/text_lines.h"

namespace kaustik {
namespace {

/// False: there are no three numbers.
bool take_point(std::string_view rest, Vec3f& point) {
  for (int i = 0; i < 3; ++i) {
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    double value = 0;
    std::string_view quick = rest;
    if (take_decimal(quick, value) && (quick.empty() || is_blank(quick.front()))) {
      rest = quick;
    } else {
      std::string_view word = next_word(rest);
      if (word.starts_with('+')) word.remove_prefix(1);
      if (std::from_chars(word.data(), word.data() + word.size(), value).ec != std::errc())
        return false;
    }
    point[i] = float(value);
    if (!std::isfinite(point[i])) return false;
  }
  return true;
}

constexpr size_t most_scanned_libraries = 100;

class ObjScanner {
 public:
  explicit ObjScanner(const std::string& path) : path_(path), lines_(path) {}

  ObjScan scan() {
    scan_.bytes = lines_.file_size();
    for (std::string_view line; lines_.next(line);) {
      while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
      if (line.size() > 1) read(line);
    }
    return std::move(scan_);
  }

 private:
  /// In small or capital letters.
  void read(std::string_view line) {
    const char first = char(line[0] | 0x20), second = char(line[1] | 0x20);
    if (first == 'v' && is_blank(line[1])) {
      Vec3f point;
      if (take_point(line.substr(2), point)) scan_.bounds.extendBy(point);
    } else if (first == 'v' && second == 'n') {
      scan_.has_normals = true;
    } else if (first == 'f' && is_blank(line[1])) {
      scan_.has_faces = true;
      if (is_new_material_) add_material();
    } else if ((first == 'l' || first == 'p') && is_blank(line[1])) {
      if (!scan_.first_line) scan_.first_line = place_in(path_, lines_.number());
    } else if (first == 'u' || first == 'm') {
      const std::string_view word = next_word(line);
      if (word == "usemtl") {
        material_ = trimmed(line);
        place_ = place_in(path_, lines_.number());
        is_new_material_ = true;
      } else if (word == "mtllib" && scan_.libraries.size() < most_scanned_libraries) {
        scan_.libraries.emplace_back(trimmed(line), place_in(path_, lines_.number()));
      }
    }
  }

  void add_material() {
    is_new_material_ = false;
    if (known_.insert(material_).second) scan_.materials.emplace_back(material_, place_);
  }

  std::string path_;
  TextLines lines_;
  ObjScan scan_;
  std::string material_;  ///< of faces to come
  Place place_ = place_in(path_);
  bool is_new_material_ = true;
  std::set<std::string> known_;
};

}  // namespace

ObjScan scan_obj(const std::string& path) { return ObjScanner(path).scan(); }

}  // namespace kaustik
