#pragma once
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "standard_streams.h"

namespace kaustik::app {

/// Collects what fails, so that one output that fails does not cost the others.
class Failures {
 public:
  /// Runs `action`, which is to write `file`; what it throws is kept.
  template <typename Action>
  void attempt(const std::string& file, const Action& action) {
    attempt_to("write '" + file + "'", action);
  }
  /// The same of any work; `what` is for messages: cannot `what`.
  template <typename Action>
  void attempt_to(const std::string& what, const Action& action) {
    try {
      action();
    } catch (const Error& error) {
      keep(error);
    } catch (const std::exception& error) {
      keep(what, error);
    } catch (const ReaderGone&) {
      is_reader_gone_ = true;
    }
  }
  /// Throws Error with all of them, if there are any; of kind system if one is. Else ReaderGone if
  /// that was thrown.
  void throw_if_any() const;

 private:
  void keep(const Error& error);
  void keep(const std::string& what, const std::exception& error);

  ErrorKind kind_ = ErrorKind::input;
  std::vector<Problem> problems_;
  bool is_reader_gone_ = false;
};

}  // namespace kaustik::app
