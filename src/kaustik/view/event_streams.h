#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/view/http_message.h"
#include "kaustik/view/json_text.h"

namespace kaustik::view {

/// The clients that listen to events (server-sent events). In the server's thread.
class EventStreams {
 public:
  static constexpr size_t most = 8;

  /// Throws RequestError if there are as many as there may be.
  void check_room();
  /// Begins with messages that were told before.
  void add(std::shared_ptr<EventSink> sink);
  bool empty() const { return sinks_.empty(); }
  void send(const std::string& event, const Json& data);
  /// To the one that was added last.
  void send_to_last(const std::string& event, const Json& data);
  /// A message for users, which later clients are told, too.
  void log(const std::string& level, const std::string& text);
  void clear() { sinks_.clear(); }

 private:
  void forget_closed();

  std::vector<std::shared_ptr<EventSink>> sinks_;
  std::deque<Json> messages_;
};

}  // namespace kaustik::view
