#pragma once
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "kaustik/export.h"

namespace kaustik::v0 {

namespace details {
struct ErrorState;
}

/// One thing that is wrong.
struct Problem {
  std::string message;  ///< what was found, and what is wrong with it
  std::string remedy;   ///< what to do; may be empty
  std::string file;     ///< a file, or what stands for one: "program"; "": no place is known
  int line = 0;         ///< from 1 on; 0: not known
  int column = 0;       ///< from 1 on; 0: not known
};

enum class ErrorKind {
  input,     ///< something is wrong with what was given: a scene, a file, a setting
  system,    ///< the machine has failed: disk full, no memory, no permission
  misuse,    ///< a function was called when or where it must not be
  callback,  ///< a function of the host's threw: Error::cause()
  internal   ///< a mistake of Kaustik's
};

/// The only exception that the library throws. what() is the whole text of all problems, with an
/// excerpt of the file where there is one. Copies share what they hold.
class KAUSTIK_EXPORT Error : public std::runtime_error {
 public:
  /// At least one problem; `text` is what what() says.
  Error(ErrorKind kind, std::vector<Problem> problems, const std::string& text,
        std::exception_ptr cause = nullptr);
  Error(const Error&) noexcept;
  Error& operator=(const Error&) noexcept;
  ~Error() override;

  ErrorKind kind() const noexcept;
  /// Everything that was found, in the order of the file.
  const std::vector<Problem>& problems() const noexcept;
  // Of the first problem:
  const std::string& message() const noexcept;
  const std::string& remedy() const noexcept;
  const std::string& file() const noexcept;
  int line() const noexcept;
  int column() const noexcept;
  /// What a function of the host's has thrown; null: nothing.
  std::exception_ptr cause() const noexcept;

 private:
  std::shared_ptr<const details::ErrorState> state_;
};

}  // namespace kaustik::v0
