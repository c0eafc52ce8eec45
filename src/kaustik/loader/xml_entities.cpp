#include "kaustik/loader/xml_entities.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kaustik/base/error.h"
#include "kaustik/loader/xml_doctype.h"
#include "kaustik/loader/xml_encoding.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik {
namespace {

/// Of what is told in messages.
constexpr size_t longest_name = 100;

[[noreturn]] void fail_at(const Place& place, const std::string& message,
                          const std::string& remedy) {
  throw Error(ErrorKind::input, message, remedy, place);
}

bool is_of_xml_itself(std::string_view name) {
  return name == "amp" || name == "lt" || name == "gt" || name == "quot" || name == "apos";
}

}  // namespace

/// Goes through a text once, and at each `&name;` through what that stands for.
class ExpandedXml::Expander {
 public:
  Expander(ExpandedXml& result, const EntityRules& rules,
           std::map<std::string, Entity, std::less<>> entities)
      : result_(result), rules_(rules), entities_(std::move(entities)) {
    if (!rules_.bytes_left) rules_.bytes_left = &own_bytes_left_;
  }
  /// `text` stands in that source, from `shift` on.
  void expand(std::string_view text, size_t begin, size_t source, size_t shift);

 private:
  /// Where in the XML the text has come to.
  enum class Inside { content, tag, value };

  /// Writes text[begin, end).
  void copy(std::string_view text, size_t begin, size_t end, size_t source, size_t shift);
  /// Steps over what begins at `at`.
  size_t step(std::string_view text, size_t at);
  void insert(std::string_view name, const Place& place);
  [[noreturn]] void fail_undeclared(std::string_view name, const Place& place) const;
  void check_use(const Entity& entity, std::string_view name, const Place& place) const;
  /// The source that the entity's text stands in: a file's is read when it is first used.
  size_t source_of(Entity& entity, const Place& place);
  void use_up(size_t bytes, const Place& place);

  ExpandedXml& result_;
  EntityRules rules_;
  std::map<std::string, Entity, std::less<>> entities_;
  std::map<const Entity*, size_t> read_files_;  ///< their sources
  size_t own_bytes_left_ = EntityRules::most_bytes;
  std::vector<const Entity*> open_;  ///< the outermost first
  Inside inside_ = Inside::content;
  char quote_ = 0;          ///< of the value
  size_t value_level_ = 0;  ///< of open entities where the value began
};

void ExpandedXml::Expander::copy(std::string_view text, size_t begin, size_t end, size_t source,
                                 size_t shift) {
  if (begin == end) return;
  result_.pieces_.push_back({result_.xml.size(), source, begin + shift});
  result_.xml += text.substr(begin, end - begin);
}

size_t ExpandedXml::Expander::step(std::string_view text, size_t at) {
  const char c = text[at];
  if (inside_ == Inside::content && c == '<') {
    if (at + 1 < text.size() && (text[at + 1] == '!' || text[at + 1] == '?'))
      return std::min(end_of_special(text, at), text.size());
    inside_ = Inside::tag;
  } else if (inside_ == Inside::tag && c == '>') {
    inside_ = Inside::content;
  } else if (inside_ == Inside::tag && (c == '"' || c == '\'')) {
    inside_ = Inside::value;
    quote_ = c;
    value_level_ = open_.size();
  } else if (inside_ == Inside::value && c == quote_) {
    inside_ = Inside::tag;
  }
  return at + 1;
}

void ExpandedXml::Expander::expand(std::string_view text, size_t begin, size_t source,
                                   size_t shift) {
  size_t copied = begin;
  for (size_t at = begin; at < text.size();) {
    const bool in_inner_value = inside_ == Inside::value && open_.size() > value_level_;
    if (in_inner_value && text[at] == quote_) {
      copy(text, copied, at, source, shift);
      copied = ++at;
      result_.xml += quote_ == '"' ? "&quot;" : "&apos;";
      continue;
    }
    const size_t name_end =
        text[at] == '&' && inside_ != Inside::tag ? end_of_name(text, at + 1) : 0;
    const bool is_reference = name_end > at + 1 && name_end < text.size() && text[name_end] == ';';
    const std::string_view name = text.substr(at + 1, is_reference ? name_end - at - 1 : 0);
    if (!is_reference || is_of_xml_itself(name)) {
      at = step(text, at);
      continue;
    }
    copy(text, copied, at, source, shift);
    insert(name, result_.sources_[source].at(at + shift));
    copied = at = name_end + 1;
  }
  copy(text, copied, text.size(), source, shift);
}

void ExpandedXml::Expander::insert(std::string_view name, const Place& place) {
  const auto found = entities_.find(name);
  if (found == entities_.end()) fail_undeclared(name, place);
  Entity& entity = found->second;
  check_use(entity, name, place);
  const size_t source = source_of(entity, place);
  open_.push_back(&entity);
  expand(entity.text, 0, source, entity.is_file ? 0 : entity.begin);
  open_.pop_back();
}

void ExpandedXml::Expander::fail_undeclared(std::string_view name, const Place& place) const {
  if (name.size() > longest_name || entities_.size() > 1000)
    fail_at(place, "the DOCTYPE does not declare this entity",
            "declare it; & itself is written &amp;");
  std::vector<std::string> names;
  for (const auto& [known, entity] : entities_)
    if (known.size() <= longest_name) names.push_back(known);
  fail_at(place, fmt::format("the DOCTYPE declares no entity '{}'", name),
          suggest(name, names) + "; & itself is written &amp;");
}

void ExpandedXml::Expander::check_use(const Entity& entity, std::string_view name,
                                      const Place& place) const {
  const std::string told =
      name.size() > longest_name ? "an entity" : fmt::format("the entity '{}'", name);
  if (std::find(open_.begin(), open_.end(), &entity) != open_.end())
    fail_at(place, told + " stands within itself", "remove it from what it stands for");
  if (open_.size() >= EntityRules::most_levels)
    fail_at(place,
            fmt::format("entities stand within one another more than {} levels deep",
                        EntityRules::most_levels),
            "let them stand for plain text");
  if (entity.is_file && inside_ == Inside::value)
    fail_at(place, told + ", which is a file, stands in a value",
            "declare it by its text, as in <!ENTITY name \"text\">");
}

size_t ExpandedXml::Expander::source_of(Entity& entity, const Place& place) {
  const auto known = read_files_.find(&entity);
  if (!entity.is_file || known != read_files_.end()) {
    use_up(entity.text.size(), place);
    return entity.is_file ? known->second : 0;
  }
  const Place declared = result_.sources_[0].at(entity.begin);
  if (!rules_.read)
    fail_at(declared, "an entity is a file, which cannot be read here", "declare it by its text");
  EntityFile file = rules_.read(entity.text, declared);
  entity.text = std::move(file.text);
  if (entity.text.starts_with(byte_order_mark)) entity.text.erase(0, byte_order_mark.size());
  const size_t source = read_files_[&entity] = result_.sources_.size();
  result_.sources_.emplace_back(entity.text, std::move(file.name), true);
  check_encoding(entity.text, result_.sources_.back());
  // The declaration of the encoding may stand at the start of a document alone.
  if (entity.text.starts_with("<?xml"))
    for (size_t end = std::min(end_of_special(entity.text, 0), entity.text.size()); end > 0; --end)
      if (entity.text[end - 1] != '\n') entity.text[end - 1] = ' ';
  return source;
}

void ExpandedXml::Expander::use_up(size_t bytes, const Place& place) {
  // Where entities hold entities what is short costs, too: its piece.
  constexpr size_t least = 32;
  const size_t needed = open_.empty() ? bytes : std::max(bytes, least);
  if (needed > *rules_.bytes_left)
    fail_at(place,
            fmt::format("entities stand for more than {} MiB of text in all",
                        EntityRules::most_bytes >> 20),
            "write what they stand for once and refer to its objects by their ids");
  *rules_.bytes_left -= needed;
}

ExpandedXml::ExpandedXml(std::string written, std::string name, bool may_be_quoted,
                         const EntityRules& rules) {
  if (written.starts_with(byte_order_mark)) written.erase(0, byte_order_mark.size());
  sources_.emplace_back(written, std::move(name), may_be_quoted);
  pieces_.push_back({0, 0, 0});
  check_encoding(written, sources_[0]);
  const size_t at = may_be_quoted ? find_doctype(written) : std::string::npos;
  Doctype doctype;
  if (at != std::string::npos) doctype = read_doctype(written, at, sources_[0]);
  if (doctype.entities.empty()) {
    xml = std::move(written);
    return;
  }
  xml = written.substr(0, doctype.end);
  Expander(*this, rules, std::move(doctype.entities)).expand(written, doctype.end, 0, 0);
}

Place ExpandedXml::place(size_t offset) const {
  const auto next =
      std::upper_bound(pieces_.begin(), pieces_.end(), offset,
                       [](size_t at, const Piece& piece) { return at < piece.begin; });
  const Piece& piece = *(next - 1);
  return sources_[piece.source].at(piece.offset + (offset - piece.begin));
}

}  // namespace kaustik
