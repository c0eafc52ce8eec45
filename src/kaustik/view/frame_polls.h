#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/live/snapshot.h"
#include "kaustik/view/frames.h"
#include "kaustik/view/http_message.h"
#include "kaustik/view/query.h"

namespace kaustik {
class Watched;
}

namespace kaustik::view {

class Worker;

/// Which frame is asked for.
struct FrameQuery {
  uint64_t after = 0;  ///< another one than that
  std::string layer;   ///< "": the picture
  FrameFormat format = FrameFormat::rgb9e5;
  std::optional<int> width;  ///< no wider; absent: as it is

  /// Throws RequestError.
  static FrameQuery from(const Query& query);
  friend bool operator==(const FrameQuery&, const FrameQuery&) = default;
};

/// What a film's picture holds beside the picture itself, made when it is asked for.
class LayerPictures {
 public:
  struct Layers {
    uint64_t revision = 0;
    uint32_t passes = 0, regional_passes = 0;
    Image image;
  };
  /// The layers of what is shown, as of a revision; null: there are none now. Takes time.
  std::shared_ptr<const Layers> of(const Watched& shown, uint64_t revision);

 private:
  std::shared_ptr<const Layers> last_;
};

/// Requests that wait for the next frame; none holds a thread. In the server's thread, but for the
/// making of frames, which is the worker's.
class FramePolls {
 public:
  /// Both must outlive this.
  FramePolls(const Watched& shown, Worker& worker);

  void add(FrameQuery query, std::shared_ptr<HttpReply> reply);
  /// Answers those that there is a frame for, and those that have waited long enough.
  void serve();
  void clear() { polls_.clear(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Poll {
    FrameQuery query;
    std::shared_ptr<HttpReply> reply;
    Clock::time_point deadline;
  };
  bool is_due(const Poll& poll, const Snapshot* snapshot) const;
  void answer(std::vector<Poll> polls, std::shared_ptr<const Snapshot> snapshot);

  const Watched& shown_;
  Worker& worker_;
  std::shared_ptr<LayerPictures> layers_ = std::make_shared<LayerPictures>();
  std::vector<Poll> polls_;
};

/// The answer with one frame of a snapshot, and of the layers where the query asks for one. Throws
/// RequestError if there is no such layer.
HttpResponse frame_response(const FrameQuery& query, const Snapshot& snapshot,
                            const LayerPictures::Layers* layers);

}  // namespace kaustik::view
