#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "kaustik/view/http_message.h"

namespace kaustik::view {

/// What one client, or all together, may take.
struct HttpLimits {
  size_t connections = 64;
  uint32_t header_bytes = 16 << 10;
  size_t body_bytes = 1 << 20;
  /// For a request's header, and once more for its body, to come.
  std::chrono::milliseconds read_time = std::chrono::seconds(30);
  /// For a response, or for events, to be taken.
  std::chrono::milliseconds write_time = std::chrono::seconds(20);
  size_t queued_event_bytes = 1 << 20;  ///< of one stream, that wait to be taken
};

/// Called in the server's thread; must return soon. What it throws becomes the answer.
using HttpHandler = std::function<void(HttpRequest, std::shared_ptr<HttpReply>)>;

/// HTTP/1.1 on one address, in one thread: no client, however slow, holds up another. Every answer
/// has headers that keep browsers from using it otherwise than the page does.
class HttpServer {
 public:
  /// Listens from now on; port 0: any that is free. Throws Error(input) for what is no address, and
  /// Error(system) if it cannot listen there.
  HttpServer(const std::string& address, uint16_t port, HttpLimits limits = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  uint16_t port() const;
  /// Whether only this machine can reach it.
  bool is_local() const;
  /// Begins to accept; `tick` is called in the server's thread again and again.
  void start(HttpHandler handler, std::chrono::milliseconds interval, std::function<void()> tick);
  /// Runs it in the server's thread. From any thread.
  void post(std::function<void()> action);
  /// Ends the thread; nothing is accepted, answered or called any more.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kaustik::view
