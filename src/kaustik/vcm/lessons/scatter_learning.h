#pragma once
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/base/bytes.h"
#include "kaustik/transport/scatter_guide.h"

namespace kaustik {

/// An event of a light path that may be guided, for who learns from it.
struct LightScattering {
  uint32_t path = 0;    ///< where the path's vertices begin …
  uint32_t at = 0;      ///< … and how many of them come before that of the event
  uint32_t number = 0;  ///< of the path among those of the pass, whatever else is kept of them
  Vec3f position;
  Vec3f normal{0, 0, 0};   ///< geometric, on the side on which the path arrived
  Vec3f next;              ///< the position of the next vertex
  float pdf = 0;           ///< per solid angle, of having gone there …
  float pdf_unguided = 0;  ///< … and without a guide
};

/// Learns a ScatterGuide from light paths whose use is known: directions are to be drawn in
/// proportion to the use of what follows them, which is what leaves no noise where all events are
/// guided so. (EmissionLearning asks for least noise by paths that go on as those did; of events
/// one after the other that would teach each as if the next were not guided.) The balls hold the
/// vertices that events of use went to, so that few events teach what lies in which direction from
/// everywhere (after Huang et al. 2024, whose Gaussians stand for them); the shares of a cell are
/// those by which its events are likeliest.
class ScatterLearning {
 public:
  /// Of a lesson so many events are taken at most, evenly.
  static constexpr size_t most_events_of_lesson = 1 << 13;
  /// An event of which the rest was of use `use`, in any unit; it stands for `events` such.
  void add(const LightScattering& event, double use, double events);
  size_t size() const { return events_.size(); }
  /// The events so far, and the same back. Reading throws as ByteReader does.
  void write(ByteWriter& writer) const;
  void read(ByteReader& reader);

  /// What the events so far teach; null: next to nothing, or it was stopped.
  std::shared_ptr<const ScatterGuide> learned(const std::stop_token& stop = {}) const;

 private:
  struct Event {
    Vec3f position, next, direction;
    float unguided = 0;
    double weight = 0;  ///< use
    int side = 0;
    int half = 0;  ///< of the events, by its path: those of one path are much alike
  };
  class Builder;

  std::vector<Event> events_;
};

}  // namespace kaustik
