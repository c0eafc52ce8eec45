// The part of Reader that deals with files: reading them, finding them, including them.

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/mitsuba_reader.h"
#include "kaustik/loader/mitsuba_tags.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik::mitsuba {
namespace {

namespace fs = std::filesystem;

constexpr size_t maximum_bytes = size_t{512} << 20;
constexpr size_t maximum_includes = 10000;
constexpr size_t maximum_include_depth = 15;   // as Mitsuba
constexpr size_t maximum_search_folders = 50;  ///< each costs a look at the disk per file

std::string joined(const std::vector<fs::path>& paths, std::string_view separator) {
  std::string text;
  for (const fs::path& path : paths) {
    if (!text.empty()) text += separator;
    text += path.empty() ? "." : path.string();
  }
  return text;
}

/// A name that two paths to the same file share.
fs::path identity(const fs::path& path) {
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(path, ignored);
  return canonical.empty() ? path : canonical;
}

/// Of this version or an older one.
bool is_object_tag(const std::string& tag) {
  return is_in(object_tags(), upgraded_tag(tag, {0, 0, 0}));
}

/// A scene may name any file: an error quotes only what looks like a part of one.
bool begins_as_scene(const std::string& text) { return is_object_tag(root_tag(text)); }

/// Of this version or an older one: what a file may begin with that stands within a scene.
bool begins_as_part(const std::string& text) {
  const std::string tag = root_tag(text);
  return is_object_tag(tag) || is_in(part_tags(), tag) || tag == "srgb" || tag == "blackbody";
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// The first of the folders that has the file; else where it would be in `own_folder`.
fs::path find_file(const std::string& file, const std::vector<fs::path>& folders,
                   const fs::path& own_folder) {
  if (fs::path(file).is_absolute()) return file;
  for (const fs::path& folder : folders)
    if (is_there(folder / file)) return folder / file;
  if (file.find('\\') == std::string::npos) return own_folder / file;
  std::string with_slashes = file;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  return find_file(with_slashes, folders, own_folder);
}

}  // namespace

std::string Reader::text_of(const fs::path& path, const Place& where) {
  const size_t allowed = maximum_bytes - read_bytes_;
  const auto refuse = [&] {
    throw Error(ErrorKind::input, "the scene's XML has more than 512 MiB",
                "keep meshes in PLY files, which load faster", where);
  };
  std::error_code unknown;
  const auto size = fs::is_regular_file(path, unknown) ? fs::file_size(path, unknown) : 0;
  if (!unknown && size > allowed) refuse();
  std::vector<uint8_t> bytes;
  try {
    // One more than is allowed: it may grow meanwhile, and only what has been read counts.
    bytes = kaustik::read_file_start(path.string(), allowed + 1);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, where);
  }
  const size_t file_bytes = bytes.size();
  bytes = unpacked(std::move(bytes), allowed, where);
  if (bytes.size() > allowed) refuse();
  ++counts_.files;
  sources_.insert(path.string());
  read_bytes_ += bytes.size();
  budget_.allow_file(std::min(bytes.size(), usual_growth * file_bytes));
  return {bytes.begin(), bytes.end()};
}

Description Reader::read_file(const std::string& path) {
  open_files_ = {path};
  return read_text(text_of(path, place_in(path)), path, fs::path(path).parent_path());
}

Description Reader::read_text(std::string text, const std::string& name, const fs::path& folder) {
  if (open_files_.empty()) open_files_ = {name};
  const bool may_be_quoted = begins_as_scene(text);
  const XmlDocument document(std::move(text), name, may_be_quoted, entity_rules(folder));
  Source source = {document, {}, {folder}, folder};
  const bool has_version = read_version(source);
  version_ = source.version;
  const std::shared_ptr<Object> scene = has_version ? read_scene(source) : nullptr;
  scene_folders_ = source.folders;
  return finish(scene);
}

fs::path Reader::found(const std::string& file, const Source& source) const {
  return find_file(file, source.folders, source.own_folder);
}

fs::path Reader::found_or_like(const Attribute& file, const Source& source) {
  fs::path path = found(file.value, source);
  if (is_strict_ || is_there(path)) return path;
  const auto like = file_search_.find_like(file.value, source.folders);
  if (!like) return path;
  leave_out("file " + file.value,
            fmt::format("there is no file '{}': '{}' stands for it", file.value, like->string()),
            file.place);
  return *like;
}

std::optional<fs::path> Reader::found_beside(const std::string& name, const fs::path& folder,
                                             const Place& place) {
  if (name.empty()) return std::nullopt;
  std::vector<fs::path> folders = {folder};
  folders.insert(folders.end(), scene_folders_.begin(), scene_folders_.end());
  const auto is_file = [](const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
  };
  if (const fs::path path = find_file(name, folders, folder); is_file(path)) return path;
  if (is_strict_) return std::nullopt;
  const auto like = file_search_.find_like(name, folders);
  if (like)
    leave_out("file " + like->string(),
              fmt::format("there is no file of that name: '{}' stands for it", like->string()),
              place);
  return like;
}

bool Reader::is_open(const fs::path& path) const {
  return std::any_of(open_files_.begin(), open_files_.end(),
                     [&](const auto& other) { return identity(other) == identity(path); });
}

EntityRules Reader::entity_rules(const fs::path& folder) {
  return {[this, folder](const std::string& name, const Place& where) {
            return entity_file(name, folder, where);
          },
          &entity_bytes_left_};
}

EntityFile Reader::entity_file(const std::string& name, const fs::path& folder,
                               const Place& where) {
  constexpr std::string_view here = "file://";
  const std::string file = name.starts_with(here) ? name.substr(here.size()) : name;
  const auto refuse = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, where);
  };
  if (file.find("://") != std::string::npos)
    refuse(fmt::format("an entity stands for {}, which is no file here", in_quotes(file)),
           "load it to a file beside the scene and name that");
  const fs::path path = find_file(file, {folder}, folder);
  if (file.empty() || is_open(path))
    refuse(file.empty() ? "an entity stands for a file without a name"
                        : fmt::format("an entity stands for {}, which is being read already",
                                      in_quotes(path.string())),
           "name a file that holds a part of the scene");
  if (++included_files_ > maximum_includes)
    refuse(fmt::format("more than {} files are included", maximum_includes),
           "put the parts into fewer files");
  std::string text = text_of(path, where);
  if (!begins_as_part(text))
    refuse(fmt::format("{} is no part of a scene", in_quotes(path.string())),
           "name a file that holds objects or properties, such as <bsdf type=\"…\">");
  return {std::move(text), path.string()};
}

void Reader::read_search_folder(const Element& element, Unfinished&, Source& source) {
  refuse_children(element, source);
  if (!check_attributes(element, {{"value"}, {}})) return;
  const Attribute& value = *element.find("value");
  const fs::path folder = found(value.value, source).lexically_normal();
  std::error_code ignored;
  if (element.node.parent() != source.document.root()) {
    problems_.add("<path> in an object", "move it to the start of the scene", element.place);
  } else if (!fs::is_directory(folder, ignored)) {
    const std::string message = fmt::format("there is no folder {}", in_quotes(folder.string()));
    if (is_strict_)
      problems_.add(message, "name a folder, relative to the one of this file", value.place);
    else
      leave_out("folder " + folder.string(), message + ": it is not searched", value.place);
  } else {
    std::erase(source.folders, folder);
    source.folders.insert(source.folders.begin(), folder);
    if (source.folders.size() > maximum_search_folders) {
      problems_.add(fmt::format("more than {} folders are searched", maximum_search_folders),
                    "name the folder in the file names themselves", value.place);
      problems_.throw_if_any();
    }
  }
}

void Reader::read_include(const Element& element, Unfinished& parent, Source& source) {
  refuse_children(element, source);
  if (!check_attributes(element, {{"filename"}, {"name"}})) {
    incomplete_ = true;
    return;
  }
  const Attribute& file = *element.find("filename");
  const fs::path path = found_or_like(file, source);
  const bool is_circular = is_open(path);
  open_files_.push_back(path);
  try {
    if (is_circular)
      throw BadValue(fmt::format("circular <include>: {}", joined(open_files_, " → ")),
                     "no file can include itself: remove one of these", file.place);
    if (open_files_.size() > maximum_include_depth)
      throw BadValue(fmt::format("includes nest more than {} files deep", maximum_include_depth),
                     "include the parts from one file", file.place);
    if (++included_files_ > maximum_includes)
      throw BadValue(fmt::format("more than {} files are included", maximum_includes),
                     "put the parts into fewer files", file.place);
    read_included(path, element, parent, source);
  } catch (const BadValue& bad) {
    incomplete_ = true;
    add(problems_, bad, element.place);
  }
  open_files_.pop_back();
}

const XmlDocument& Reader::included_document(const fs::path& path, const Place& place) {
  auto& document = documents_[identity(path)];
  if (document) return *document;
  try {
    std::string text = text_of(path, place);
    const bool may_be_quoted = begins_as_scene(text);
    document = std::make_unique<XmlDocument>(std::move(text), path.string(), may_be_quoted,
                                             entity_rules(path.parent_path()));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    const Problem& problem = error.problems().front();
    throw BadValue(problem.message, problem.remedy, problem.place);
  }
  return *document;
}

void Reader::read_included(const fs::path& path, const Element& element, Unfinished& parent,
                           Source& includer) {
  const XmlDocument& document = included_document(path, element.find("filename")->place);
  if (!is_object_tag(document.root().name()))
    throw BadValue(fmt::format("{} is no part of a scene", in_quotes(path.string())),
                   "include files whose root is <scene version=\"3.0.0\"> or an object, such as "
                   "<bsdf version=\"3.0.0\" type=\"…\">",
                   element.find("filename")->place);
  Source source = {document, {}, includer.folders, path.parent_path()};
  source.folders.insert(source.folders.begin(), source.own_folder);
  const auto root =
      read_version(source, &includer.version) ? ready(document.root(), source) : std::nullopt;
  if (!root) {
    incomplete_ = true;
  } else if (root->tag == "scene") {
    check_attributes(*root, {{}, {"version", "type", "id", "name"}});
    read_parts(root->node, parent, source);
  } else {
    read_included_object(*root, element.value("name"), parent, source);
  }
}

void Reader::read_included_object(const Element& root, const std::string& name, Unfinished& parent,
                                  Source& source) {
  const std::string child_name = name.empty() ? root.value("name") : name;
  take_name(parent, child_name, root.place);
  parent.object->children.push_back({child_name, read_object(root, source)});
}

}  // namespace kaustik::mitsuba
