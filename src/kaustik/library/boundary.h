#pragma once
#include <exception>
#include <functional>
#include <string>

#include "kaustik/error.h"

namespace kaustik::v0 {

/// What a function of the host's has thrown, on its way through the rooms: no std::exception, so
/// that nobody takes it for one of theirs.
struct CallbackFailure {
  std::exception_ptr cause;
};

/// Where it is called in a handler: throws what is being handled as the host is to see it.
[[noreturn]] void throw_to_host();

/// Runs `body`, which lets no exception out but Error.
template <typename Body>
auto guarded(const Body& body) {
  try {
    return body();
  } catch (...) {
    throw_to_host();
  }
}

/// An Error of the library's own interface; `program` is its place.
Error misuse(const std::string& message, const std::string& remedy);
Error wrong_input(const std::string& message, const std::string& remedy);

/// The place of what no file has.
inline constexpr const char* program_place = "program";

}  // namespace kaustik::v0
