#include "failures.h"

#include <fmt/format.h>

#include <new>

namespace kaustik::app {

void Failures::keep(const Error& error) {
  if (error.kind() == ErrorKind::system) kind_ = ErrorKind::system;
  problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
}

void Failures::keep(const std::string& what, const std::exception& error) {
  const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  keep(Error(ErrorKind::system,
             fmt::format("cannot {}: {}", what, no_memory ? "not enough memory" : error.what())));
}

void Failures::throw_if_any() const {
  if (!problems_.empty()) throw Error(kind_, problems_);
  if (is_reader_gone_) throw ReaderGone{};
}

}  // namespace kaustik::app
