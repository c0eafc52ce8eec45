#pragma once
#include <stdexcept>
#include <string>
#include <utility>

#include "kaustik/view/http_message.h"

namespace kaustik::view {

/// A request that is refused: what is wrong with it, and what to do.
class RequestError : public std::runtime_error {
 public:
  RequestError(unsigned status, const std::string& message, std::string remedy = {})
      : std::runtime_error(message), status_(status), remedy_(std::move(remedy)) {}
  unsigned status() const { return status_; }
  const std::string& remedy() const { return remedy_; }

 private:
  unsigned status_;
  std::string remedy_;
};

/// {"error": …, "remedy": …}
HttpResponse response_of(const RequestError& error);
/// The same of whatever is being handled: what is wrong with a scene (Error) counts as a request
/// that is refused, the rest as a failure of the server.
HttpResponse response_of_current_exception();

}  // namespace kaustik::view
