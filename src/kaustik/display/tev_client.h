#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "kaustik/base/place.h"
#include "kaustik/image/image.h"

namespace kaustik {

/// Where a viewer listens.
struct TevAddress {
  static constexpr uint16_t usual_port = 14158;
  std::string host = "localhost";
  uint16_t port = usual_port;

  /// "HOST", "HOST:PORT", ":PORT", "[ADDRESS]:PORT". Throws Error(input), at `place`, for anything
  /// else.
  static TevAddress parse(const std::string& text, const Place& place = {});
  std::string text() const;
};

/// How long a viewer is waited for, in seconds.
struct TevPatience {
  double connecting_s = 5;
  double stalled_s = 10;  ///< without taking a byte
};

/// Shows a running picture in the viewer tev, by TCP, in a thread of its own: nobody waits for the
/// viewer. One that is not there, stops reading or closes is told of once; from then on pictures
/// are dropped.
class TevClient {
 public:
  /// The viewer calls the picture `name`. `warn` gets a sentence, from the client's thread.
  TevClient(TevAddress address, std::string name, std::function<void(const std::string&)> warn,
            const TevPatience& patience = {});
  /// Ends at once, whatever has got through.
  ~TevClient();
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;

  /// "R", "G", "B" of the image as the viewer is to show them next; one that has not been sent yet
  /// is dropped for it. Returns at once. From any thread.
  void show(Image image);
  /// Whether all that was shown has been sent.
  bool is_idle() const;
  /// Whether the viewer was given up.
  bool is_gone() const;
  /// Waits until the client is idle or the viewer is given up, at most so long.
  void finish(double most_s);

  struct State;  ///< what the client shares with its thread

 private:
  // The thread may outlive this by the time that the system takes to find a host.
  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace kaustik
