#include "kaustik/loader/obj_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/loader/framing.h"
#include "kaustik/loader/mtl_material.h"
#include "kaustik/loader/obj_scan.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/reader_definitions.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

/// The file is read once for each material: all together may be so much.
constexpr uint64_t most_scanned_bytes = uint64_t{32} << 30;
/// Between faces of a file without normals.
constexpr double smooth_degrees = 30;

bool is_regular(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

class ObjSceneReader {
 public:
  ObjSceneReader(const std::string& path, const LoadOptions& options)
      : path_(path), folder_(fs::path(path).parent_path()), is_strict_(options.is_strict) {
    const ReaderDefinitions none(options, {});
    description_.scene = make_object("scene", "", place_in(path));
    description_.sources.push_back(path);
  }

  Description read() {
    const ObjScan scan = scan_obj(path_);
    if (!scan.has_faces)
      throw Error(ErrorKind::input, "the OBJ file has no faces", "export its surfaces as polygons",
                  place_in(path_));
    read_libraries(scan);
    add_shapes(scan);
    Framing framing(description_, deviations_, {{path_, scan.bounds}});
    if (!is_lit(description_)) framing.add_studio_light();
    framing.add_missing_camera();
    deviations_.finish(description_, is_strict_);
    description_.is_strict = is_strict_;
    return std::move(description_);
  }

 private:
  /// The file of that name beside the scene, or one that stands for it.
  std::optional<fs::path> find(const std::string& name, const fs::path& folder,
                               const Place& place) {
    if (name.empty()) return std::nullopt;
    std::string with_slashes = name;
    std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
    for (const std::string& candidate : {name, with_slashes})
      if (is_regular(folder / candidate)) return folder / candidate;
    const auto like = search_.find_like(name, {folder, folder_});
    if (like)
      deviations_.approximated(
          "file " + like->filename().string(),
          fmt::format("there is no file of the name given: '{}' stands for it", like->string()),
          place);
    return like;
  }

  void read_libraries(const ObjScan& scan) {
    for (const auto& [line, place] : scan.libraries) {
      // One name with blanks, or several names.
      bool any = read_library(line, place);
      std::string_view rest = any ? std::string_view() : line;
      for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest))
        any |= read_library(std::string(name), place);
      if (!any)
        deviations_.missing("materials",
                            fmt::format("there is no file of materials '{}'", line.substr(0, 200)),
                            place);
    }
  }

  bool read_library(const std::string& name, const Place& place) {
    const auto path = find(name, folder_, place);
    if (!path) return false;
    if (!libraries_read_.insert(path->string()).second) return true;
    const FindBeside beside = [this](const std::string& file, const fs::path& folder,
                                     const Place& where) { return find(file, folder, where); };
    MtlLibrary library = read_mtl_library(path->string(), beside, MtlKeys::all);
    description_.sources.push_back(path->string());
    for (MtlRemark& remark : library.remarks)
      deviations_.add(remark.kind, fmt::format("line {}", remark.place.line),
                      std::move(remark.what), remark.place);
    materials_.merge(library.materials);
    return true;
  }

  void add_shapes(const ObjScan& scan) {
    const bool are_many =
        scan.materials.size() > most_scanned_bytes / std::max<uint64_t>(1, scan.bytes);
    if (are_many)
      deviations_.ignored("materials",
                          fmt::format("its {} materials take too long to be told apart: all "
                                      "faces have the first one",
                                      scan.materials.size()),
                          place_in(path_));
    if (!scan.has_normals)
      deviations_.approximated("normals",
                               fmt::format("the file has none: faces are smooth where they turn "
                                           "by less than {} degrees",
                                           smooth_degrees),
                               place_in(path_));
    if (scan.first_line)
      deviations_.ignored("lines", "lines and points are left out: faces alone are seen",
                          *scan.first_line);
    for (const auto& [material, place] : scan.materials) {
      auto shape = make_object("shape", "obj", place);
      give(*shape, "filename", path_);
      if (!scan.has_normals) give(*shape, "max_smooth_angle", smooth_degrees);
      if (scan.materials.size() > 1 && !are_many) give(*shape, "material", material);
      give_material(*shape, material);
      put(*description_.scene, "", std::move(shape));
      if (are_many) return;
    }
  }

  void give_material(Object& shape, const std::string& name) {
    const auto found = materials_.find(name);
    if (found == materials_.end()) {
      if (!name.empty() && !libraries_read_.empty())
        deviations_.missing(fmt::format("material '{}'", name.substr(0, 80)),
                            "no file of materials has it: it is matt and grey", shape.place);
      MtlMaterial grey;
      grey.place = shape.place;
      put(shape, "", full_mtl_bsdf(grey));
      return;
    }
    put(shape, "", full_mtl_bsdf(found->second));
    if (auto emitter = mtl_emitter(found->second)) put(shape, "", std::move(emitter));
  }

  std::string path_;
  fs::path folder_;
  bool is_strict_;
  Deviations deviations_;
  FileSearch search_;
  std::map<std::string, MtlMaterial> materials_;
  std::set<std::string> libraries_read_;
  Description description_{nullptr};
};

/// Whether a line is of an OBJ file; `is_sure`: and of hardly any other.
bool is_obj_line(std::string_view line, bool& is_sure) {
  const std::string_view word = next_word(line);
  if (word.empty() || word[0] == '#') return true;
  if (word == "v" || word == "vn") {
    int numbers = 0;
    for (std::string_view next = next_word(line); !next.empty(); next = next_word(line)) {
      if (next.find_first_not_of("0123456789+-.eE") != next.npos) return false;
      ++numbers;
    }
    is_sure = is_sure || numbers >= 3;
    return numbers >= 3;
  }
  is_sure = is_sure || word == "mtllib" || word == "usemtl";
  constexpr std::string_view others[] = {"vt", "vp", "f", "l",      "p",
                                         "o",  "g",  "s", "mtllib", "usemtl"};
  return std::find(std::begin(others), std::end(others), word) != std::end(others);
}

}  // namespace

bool is_obj(std::string_view head) {
  constexpr int most_lines = 50;
  bool is_sure = false;
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  for (int i = 0; i < most_lines && !head.empty(); ++i) {
    const size_t end = head.find_first_of("\r\n");
    if (end == head.npos) break;  // it may be cut off
    if (!is_obj_line(head.substr(0, end), is_sure)) return false;
    head.remove_prefix(end + 1);
  }
  return is_sure;
}

Description load_obj_scene(const std::string& path, const LoadOptions& options) {
  const std::vector<uint8_t> start = read_file_start(path, 2);
  if (start.size() == 2 && start[0] == 0x1f && start[1] == 0x8b)
    throw Error(ErrorKind::input, "the OBJ file is packed by gzip", "unpack it: gunzip",
                place_in(path));
  return ObjSceneReader(path, options).read();
}

Description parse_obj_scene(std::string_view, std::string name_for_messages, const std::string&,
                            const LoadOptions&) {
  throw Error(ErrorKind::input, "an OBJ file cannot be read as text", "give the name of the file",
              place_in(std::move(name_for_messages)));
}

}  // namespace kaustik
