#pragma once
// What goes over the wire, without the library that carries it.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kaustik::view {

struct HttpRequest {
  std::string method;  ///< "GET", "POST", as it came
  std::string target;  ///< as it came: path and query
  /// Names in lower case, in the order in which they came.
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;

  /// The value of the first header of that name, in lower case; null: there is none.
  const std::string* header(std::string_view name) const {
    for (const auto& [key, value] : headers)
      if (key == name) return &value;
    return nullptr;
  }
  int count(std::string_view name) const {
    int found = 0;
    for (const auto& header : headers) found += header.first == name ? 1 : 0;
    return found;
  }
};

struct HttpResponse {
  unsigned status = 200;
  std::string content_type;  ///< "" where there is no body
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::shared_ptr<const std::string> body = nullptr;  ///< null: none
};

/// Where events go that one client listens to (server-sent events). From any thread.
class EventSink {
 public:
  virtual ~EventSink() = default;
  /// Queues text; a client that reads too slowly for it is dropped.
  virtual void send(std::shared_ptr<const std::string> text) = 0;
  /// Whether the client is still there, as far as one knows.
  virtual bool is_open() const = 0;
};

/// The answer to one request: send() or stream(), once, from any thread. Where it is destroyed
/// without either the client is told of a failure.
class HttpReply {
 public:
  virtual ~HttpReply() = default;
  virtual void send(HttpResponse response) = 0;
  /// Begins a stream of events, which lasts until the client goes.
  virtual std::shared_ptr<EventSink> stream() = 0;
  /// Whether the client still waits for it, as far as one knows.
  virtual bool is_open() const = 0;
};

}  // namespace kaustik::view
