#include "kaustik/error.h"

#include <cassert>
#include <new>
#include <system_error>
#include <utility>

#include "kaustik/base/error.h"
#include "kaustik/library/boundary.h"

namespace kaustik::v0 {

namespace details {

struct ErrorState {
  ErrorKind kind;
  std::vector<Problem> problems;
  std::exception_ptr cause;
};

}  // namespace details

Error::Error(ErrorKind kind, std::vector<Problem> problems, const std::string& text,
             std::exception_ptr cause)
    : std::runtime_error(text) {
  if (problems.empty()) problems.push_back({.message = text, .remedy = {}, .file = {}});
  state_ = std::make_shared<const details::ErrorState>(
      details::ErrorState{kind, std::move(problems), std::move(cause)});
}

Error::Error(const Error&) noexcept = default;
Error& Error::operator=(const Error&) noexcept = default;
Error::~Error() = default;

ErrorKind Error::kind() const noexcept { return state_->kind; }
const std::vector<Problem>& Error::problems() const noexcept { return state_->problems; }
const std::string& Error::message() const noexcept { return problems()[0].message; }
const std::string& Error::remedy() const noexcept { return problems()[0].remedy; }
const std::string& Error::file() const noexcept { return problems()[0].file; }
int Error::line() const noexcept { return problems()[0].line; }
int Error::column() const noexcept { return problems()[0].column; }
std::exception_ptr Error::cause() const noexcept { return state_->cause; }

namespace {

Error converted(const kaustik::Error& error) {
  std::vector<Problem> problems;
  for (const kaustik::Problem& p : error.problems())
    problems.push_back({p.message, p.remedy, p.place.file ? *p.place.file : std::string(),
                        p.place.line, p.place.column});
  return {error.kind() == kaustik::ErrorKind::input ? ErrorKind::input : ErrorKind::system,
          std::move(problems), error.what()};
}

Error of_program(ErrorKind kind, const std::string& message, const std::string& remedy) {
  return {kind,
          {{.message = message, .remedy = remedy, .file = {}}},
          remedy.empty() ? message : message + "\n  remedy: " + remedy};
}

Error callback_error(const std::exception_ptr& cause) {
  std::string message = "a function of the program's has thrown";
  try {
    std::rethrow_exception(cause);
  } catch (const std::exception& error) {
    message += std::string(": ") + error.what();
  } catch (...) {
  }
  return {ErrorKind::callback, {{.message = message, .remedy = {}, .file = {}}}, message, cause};
}

}  // namespace

Error misuse(const std::string& message, const std::string& remedy) {
  return of_program(ErrorKind::misuse, message, remedy);
}

Error wrong_input(const std::string& message, const std::string& remedy) {
  return of_program(ErrorKind::input, message, remedy);
}

void throw_to_host() {
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const CallbackFailure& failure) {
    throw callback_error(failure.cause);
  } catch (const kaustik::Error& error) {
    throw converted(error);
  } catch (const std::bad_alloc&) {
    throw of_program(ErrorKind::system, "not enough memory",
                     "free some, or ask for less: smaller pictures, fewer photons");
  } catch (const std::system_error& error) {
    throw of_program(ErrorKind::system, error.what(), "");
  } catch (const std::invalid_argument& error) {
    throw of_program(ErrorKind::input, error.what(), "");
  } catch (const std::exception& error) {
    throw of_program(ErrorKind::internal, error.what(), "");
  } catch (...) {
    throw of_program(ErrorKind::internal, "something unknown was thrown", "");
  }
}

}  // namespace kaustik::v0
