#include "kaustik/loader/xml_doctype.h"

#include <algorithm>

#include "kaustik/base/error.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik {
namespace {

/// Reads the declarations in the brackets of a DOCTYPE.
class DoctypeReader {
 public:
  DoctypeReader(std::string_view text, size_t begin, const TextPlaces& places)
      : text_(text), at_(begin), places_(places) {}

  Doctype read();

 private:
  void read_declaration();
  void read_entity();
  /// Text in quotes; `begin` becomes where it begins behind the quote.
  std::string quoted(size_t& begin);
  void skip_blanks() {
    at_ = std::min(text_.find_first_not_of(xml_white_space, at_), text_.size());
  }
  bool skip(std::string_view word) {
    const bool is_there = text_.substr(at_).starts_with(word);
    if (is_there) at_ += word.size();
    return is_there;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::input, "broken DOCTYPE: " + what,
                "declare entities as in <!DOCTYPE scene [<!ENTITY name \"text\"> <!ENTITY other "
                "SYSTEM \"file.xml\">]>",
                places_.at(std::min(at_, text_.size())));
  }

  std::string_view text_;  ///< to where the DOCTYPE ends
  size_t at_;
  const TextPlaces& places_;
  Doctype result_;
};

Doctype DoctypeReader::read() {
  result_.end = std::min(end_of_special(text_, at_), text_.size());
  text_ = text_.substr(0, result_.end);
  // Before the brackets a file may be named that declares more; it is not read.
  size_t ignored = 0;
  while (at_ < text_.size() && text_[at_] != '[') {
    if (text_[at_] == '"' || text_[at_] == '\'')
      quoted(ignored);
    else
      ++at_;
  }
  if (at_ >= text_.size()) return std::move(result_);
  ++at_;
  for (skip_blanks(); !skip("]"); skip_blanks()) read_declaration();
  return std::move(result_);
}

void DoctypeReader::read_declaration() {
  if (at_ >= text_.size()) fail("its brackets do not end");
  if (text_[at_] == '%')
    throw Error(ErrorKind::input,
                "the DOCTYPE uses a parameter entity, which Kaustik does not read",
                "declare the entities that the scene uses in this file itself", places_.at(at_));
  if (text_[at_] != '<') fail("something that is no declaration");
  const size_t end = text_.substr(at_).starts_with("<!--") || text_.substr(at_).starts_with("<?")
                         ? end_of_special(text_, at_)
                         : end_of_tag(text_, at_);
  if (end == std::string_view::npos) fail("a declaration does not end");
  if (skip("<!ENTITY")) read_entity();
  at_ = end;
}

void DoctypeReader::read_entity() {
  skip_blanks();
  if (text_[at_] == '%') return;  // told where it is used
  const size_t name_end = end_of_name(text_, at_);
  if (name_end == at_) fail("an entity without a name");
  const std::string name(text_.substr(at_, name_end - at_));
  at_ = name_end;
  skip_blanks();
  Entity entity;
  if (skip("PUBLIC")) {
    entity.is_file = true;
    quoted(entity.begin);  // by which libraries would know it
  } else {
    entity.is_file = skip("SYSTEM");
  }
  entity.text = quoted(entity.begin);
  result_.entities.try_emplace(name, std::move(entity));
}

std::string DoctypeReader::quoted(size_t& begin) {
  skip_blanks();
  const char quote = at_ < text_.size() ? text_[at_] : char(0);
  if (quote != '"' && quote != '\'') fail("text in quotes is missing");
  begin = at_ + 1;
  const size_t end = text_.find(quote, begin);
  if (end == std::string_view::npos) fail("a quote does not end");
  at_ = end + 1;
  return std::string(text_.substr(begin, end - begin));
}

}  // namespace

Doctype read_doctype(std::string_view document, size_t begin, const TextPlaces& places) {
  return DoctypeReader(document, begin, places).read();
}

}  // namespace kaustik
