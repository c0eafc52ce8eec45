#include "kaustik/loader/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/loader/json_document.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_bytes = size_t{64} << 20, most_factors = 100;

/// A number as a command line has it, without needless digits.
std::string text_of(double number) { return fmt::format("{}", number); }

/// "0007" of 7, where the longest has four digits.
std::string padded(const std::string& digits, size_t length) {
  return digits.size() < length ? std::string(length - digits.size(), '0') + digits : digits;
}

class StudyReader {
 public:
  explicit StudyReader(const std::string& path)
      : path_(path), name_(std::make_shared<const std::string>(path)) {
    const std::vector<uint8_t> bytes = read_file_start(path, most_bytes + 1);
    if (bytes.size() > most_bytes)
      throw Error(ErrorKind::input, "the study has more than 64 MiB", "give a file of JSON",
                  place_in(path));
    text_.assign(bytes.begin(), bytes.end());
  }

  Study read() {
    try {
      root_ = parse_json(text_);
    } catch (const BadJson& bad) {
      throw Error(ErrorKind::input, bad.what(),
                  "write JSON: names and texts in quotation marks, no comma before a closing brace",
                  place_at(bad.offset));
    }
    if (!root_.is_object()) fail(root_, "a study is an object", "begin it with {");
    check_names(root_, {"scene", "folder", "outputs", "options", "factors", "seed"});
    const JsonValue* scene = root_.find("scene");
    if (!scene) fail(root_, "the study names no scene", R"(write "scene": "room.xml")");
    const fs::path path = path_;
    Study study;
    study.scene_as_written = text(*scene, "scene");
    study.scene = near(study.scene_as_written);
    const JsonValue* folder = root_.find("folder");
    study.folder = near(folder ? text(*folder, "folder") : path.stem().string());
    study.outputs = outputs();
    study.options = options();
    study.factors = factors();
    study.has_seed_for_each = has_seed_for_each();
    return study;
  }

 private:
  // ---- messages ----

  Place place_at(size_t offset) const {
    const auto end = text_.begin() + std::ptrdiff_t(std::min(offset, text_.size()));
    const auto line_start = std::find(std::make_reverse_iterator(end), text_.rend(), '\n').base();
    return {name_, int(std::count(text_.begin(), end, '\n')) + 1, int(end - line_start) + 1};
  }
  Place place_of(const JsonValue& value) const { return place_at(value.offset()); }
  [[noreturn]] void fail(const JsonValue& at, const std::string& message,
                         const std::string& remedy) const {
    throw Error(ErrorKind::input, message, remedy, place_of(at));
  }
  void check_names(const JsonValue& object, const std::vector<std::string>& known) const {
    for (const auto& [name, value] : object.members())
      if (std::find(known.begin(), known.end(), name) == known.end())
        fail(value, fmt::format("there is no '{}' here", name), suggest(name, known));
  }

  // ---- values ----

  const std::string& text(const JsonValue& value, const std::string& name) const {
    const std::string* found = value.text();
    if (!found || found->empty())
      fail(value, fmt::format("'{}' is no text", name), "write a text in quotation marks");
    return *found;
  }
  /// A text, a number or a truth value, as the command line has it.
  std::string word(const JsonValue& value) const {
    if (const std::string* found = value.text()) return *found;
    if (const auto number = value.number()) return text_of(*number);
    if (const auto flag = value.boolean()) return *flag ? "true" : "false";
    fail(value, "this is no single value", "write a text, a number, true or false");
  }
  std::vector<std::string> words(const JsonValue& value) const {
    if (!value.is_list()) return {word(value)};
    std::vector<std::string> all;
    for (const JsonValue& item : value.items()) all.push_back(word(item));
    return all;
  }
  std::string near(const std::string& file) const {
    const fs::path path = file;
    return path.is_absolute() ? file : (fs::path(path_).parent_path() / path).string();
  }

  // ---- parts of the study ----

  std::vector<std::string> outputs() const {
    const JsonValue* given = root_.find("outputs");
    if (!given) return {"exr"};
    std::vector<std::string> all = words(*given);
    if (all.empty()) fail(*given, "the list is empty", R"(write ["exr", "png"])");
    for (std::string& extension : all) {
      const std::string given_text = extension;
      if (extension.starts_with('.')) extension.erase(0, 1);
      if (extension.empty() || !std::all_of(extension.begin(), extension.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
          }))
        fail(*given, fmt::format("'{}' is no extension of a file", given_text),
             R"(write such as "exr", "png" or "csv")");
    }
    return all;
  }

  std::vector<StudyOption> options() const {
    const JsonValue* given = root_.find("options");
    if (!given) return {};
    if (!given->is_object())
      fail(*given, "'options' is no object", R"(write {"time": "60s", "integrator": "auto"})");
    std::vector<StudyOption> all;
    for (const auto& [name, value] : given->members()) {
      StudyOption option{{StudyTarget::option, name, place_of(value)}, {}};
      const auto flag = value.boolean();
      if (flag && !*flag) continue;
      if (!flag) option.values = words(value);
      if (!flag && option.values.empty())
        fail(value, fmt::format("'{}' has no value", name), "write one, or true for a switch");
      all.push_back(std::move(option));
    }
    return all;
  }

  std::vector<StudyFactor> factors() const {
    const JsonValue* given = root_.find("factors");
    if (!given) return {};
    if (!given->is_list())
      fail(*given, "'factors' is no list", R"(write [{"define": "hour", "values": [9, 12]}])");
    std::vector<StudyFactor> all;
    std::set<std::string> labels;
    size_t count = 1;
    for (const JsonValue& item : given->items()) {
      all.push_back(factor(item));
      if (!labels.insert(all.back().label).second)
        fail(item, fmt::format("two factors are called '{}'", all.back().label),
             R"(give one another "name")");
      if ((count *= all.back().values.size()) > most_variants)
        fail(item, fmt::format("the study has more than {} variants", most_variants),
             "divide it into several studies");
      if (all.size() > most_factors)
        fail(item, fmt::format("the study has more than {} factors", most_factors),
             "divide it into several studies");
    }
    return all;
  }

  StudyFactor factor(const JsonValue& item) const {
    check_names(item, {"define", "set", "option", "name", "values", "names", "first", "last"});
    StudyFactor factor;
    factor.setting = setting(item);
    const std::string& target = factor.setting.name;
    const JsonValue* name = item.find("name");
    factor.label = name ? text(*name, "name") : target.substr(target.rfind('.') + 1);
    factor.values = item.find("values") ? listed_values(item) : counted_values(item);
    return factor;
  }

  StudySetting setting(const JsonValue& item) const {
    StudySetting found;
    int count = 0;
    for (const auto& [name, target] : {std::pair("define", StudyTarget::definition),
                                       {"set", StudyTarget::parameter},
                                       {"option", StudyTarget::option}})
      if (const JsonValue* value = item.find(name)) {
        found = {target, text(*value, name), place_of(*value)};
        ++count;
      }
    if (count != 1)
      fail(item, "a factor says one thing that it changes",
           R"(write "define" for a variable, "set" for a parameter, or "option" for an option)");
    return found;
  }

  std::vector<StudyValue> listed_values(const JsonValue& item) const {
    const JsonValue& list = *item.find("values");
    if (!list.is_list() || list.items().empty())
      fail(list, "'values' is no list of values", "write [9, 12, 15]");
    for (const char* other : {"first", "last"})
      if (const JsonValue* value = item.find(other))
        fail(*value, fmt::format("there are 'values' beside '{}'", other), "keep one of both");
    std::vector<StudyValue> values;
    for (const JsonValue& value : list.items()) values.push_back({word(value), word(value)});
    if (const JsonValue* names = item.find("names")) {
      if (names->items().size() != values.size())
        fail(*names,
             fmt::format("there are {} names for {} values", names->items().size(), values.size()),
             "give each value a name, or leave 'names' out");
      for (size_t i = 0; i < values.size(); ++i) values[i].label = word(names->items()[i]);
    }
    return values;
  }

  /// Whole numbers, such as those of frames. In file names they have equally many digits.
  std::vector<StudyValue> counted_values(const JsonValue& item) const {
    if (const JsonValue* names = item.find("names"))
      fail(*names, "numbers that are counted have no names", R"(list "values" and their names)");
    const auto first = whole(item, "first"), last = whole(item, "last");
    if (!first || !last)
      fail(item, "the factor has no values",
           R"(write "values": [9, 12], or "first": 1, "last": 24)");
    if (*last < *first || *last - *first >= double(most_variants))
      fail(*item.find("last"), fmt::format("there are no frames from {} to {}", *first, *last),
           fmt::format("count upward, at most {} of them", most_variants));
    const size_t digits = text_of(*last).size();
    std::vector<StudyValue> values;
    for (double number = *first; number <= *last; ++number)
      values.push_back({text_of(number), padded(text_of(number), digits)});
    return values;
  }
  std::optional<double> whole(const JsonValue& item, const char* name) const {
    const JsonValue* value = item.find(name);
    if (!value) return {};
    const auto number = value->number();
    if (!number || *number != std::floor(*number) || *number < 0 || *number > 1e9)
      fail(*value, fmt::format("'{}' is no whole number", name), "write a number such as 1");
    return number;
  }

  bool has_seed_for_each() const {
    const JsonValue* given = root_.find("seed");
    if (!given) return false;
    const std::string& choice = text(*given, "seed");
    if (choice != "fixed" && choice != "each")
      fail(*given, fmt::format("there is no seed '{}'", choice),
           R"(write "fixed" for the same noise in all variants, "each" for noise of their own)");
    return choice == "each";
  }

  std::string path_, text_;
  std::shared_ptr<const std::string> name_;
  JsonValue root_;
};

}  // namespace

size_t Study::variant_count() const {
  size_t count = 1;
  for (const StudyFactor& factor : factors) count *= factor.values.size();
  return count;
}

Study read_study(const std::string& path) { return StudyReader(path).read(); }

}  // namespace kaustik
