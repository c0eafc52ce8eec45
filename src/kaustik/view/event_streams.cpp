#include "kaustik/view/event_streams.h"

#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr size_t kept_messages = 50;

/// JSON of one line is one field of an event.
std::shared_ptr<const std::string> text_of_event(const std::string& event, const Json& data) {
  return std::make_shared<const std::string>("event: " + event + "\ndata: " + text_of_json(data) +
                                             "\n\n");
}

}  // namespace

void EventStreams::forget_closed() {
  std::erase_if(sinks_, [](const auto& sink) { return !sink->is_open(); });
}

void EventStreams::check_room() {
  forget_closed();
  if (sinks_.size() >= most)
    throw RequestError(503, "as many pages listen to events as may", "close one of them");
}

void EventStreams::add(std::shared_ptr<EventSink> sink) {
  sinks_.push_back(std::move(sink));
  for (const Json& message : messages_) send_to_last("log", message);
}

void EventStreams::send(const std::string& event, const Json& data) {
  forget_closed();
  if (sinks_.empty()) return;
  const auto text = text_of_event(event, data);
  for (const auto& sink : sinks_) sink->send(text);
}

void EventStreams::send_to_last(const std::string& event, const Json& data) {
  sinks_.back()->send(text_of_event(event, data));
}

void EventStreams::log(const std::string& level, const std::string& text) {
  messages_.push_back({{"level", level}, {"text", text}});
  if (messages_.size() > kept_messages) messages_.pop_front();
  send("log", messages_.back());
}

}  // namespace kaustik::view
