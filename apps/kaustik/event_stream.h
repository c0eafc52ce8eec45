#pragma once
#include <memory>
#include <mutex>
#include <string>

#include "json_object.h"

namespace kaustik::app {

/// Where lines of JSON go: a file, a pipe, a descriptor that the program was started with. Whoever
/// reads it never holds up the render: what cannot be written at the moment is left out.
class EventStream {
 public:
  /// "FILE", replaced as a whole, or "fd:N". Throws Error(input) if it cannot be written.
  explicit EventStream(const std::string& target);
  /// Standard error.
  EventStream();
  ~EventStream();
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;

  /// Whether it is what the descriptor is, under whatever name.
  bool is_same_as(int descriptor) const;

  enum class Need {
    passing,  ///< is left out where its reader is behind
    lasting   ///< is waited for up to a second
  };
  /// Writes a line. After the first one that fails, of which it warns, there are no more.
  void send(const JsonObject& event, Need need);

 private:
  void give_up(const std::string& why);

  std::mutex mutex_;  ///< of writing
  std::string name_;
  int descriptor_ = -1;
  bool is_own_ = false;
};

/// Whether it names a descriptor: "fd:3".
bool names_descriptor(const std::string& target);

}  // namespace kaustik::app
