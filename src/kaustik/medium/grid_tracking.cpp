#include "kaustik/medium/grid_tracking.h"

#include <algorithm>
#include <cmath>

namespace kaustik {
namespace {

/// A look at a place takes as long as following the line through so many cells.
constexpr float cells_per_look = 4;

/// Whether the cells of the piece are followed, rather than `looks` expected.
bool is_followed(const GridCrossing::Piece& piece, float looks) {
  return looks * cells_per_look > piece.cells;
}

/// Light of which less than this is left goes on by Russian roulette.
constexpr float least_sure = 0.3f;
/// Not before so much work has been done, in cells: where little is to be done, it saves no time.
constexpr float work_before_roulette = 8;

/// 1 − σ x, where that is not below 0 but for rounding.
Spectrum left_by_look(const Spectrum& extinction, float x) {
  Spectrum left = Spectrum(1) - extinction * x;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (left[lane] < 0) left.set(lane, 0);
  return left;
}

float exponential(float u) { return -std::log1p(-u); }

/// Independent optical depths, distributed exponentially.
class Depths {
 public:
  explicit Depths(Sampler& numbers) : numbers_(numbers) {}
  float next() {
    if (!has_other_) two_ = numbers_.next_2d();
    has_other_ = !has_other_;
    return exponential(has_other_ ? two_.x : two_.y);
  }

 private:
  Sampler& numbers_;
  Vec2f two_ = Vec2f(0, 0);
  bool has_other_ = false;
};

}  // namespace

Spectrum tracked_transmittance(GridCrossing crossing, const Spectrum& extinction, Sampler numbers) {
  const float most = extinction.max_lane();
  float fewest = most;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    fewest = std::min(fewest, extinction[lane]);
  Depths depths(numbers);
  float least_left = -1, to_look = -1;
  float work = 0;      // in cells
  Spectrum left(1);    // by looks
  float integral = 0;  // what has been crossed without
  const auto most_left = [&] { return left.max_lane() * std::exp(-fewest * integral); };
  const auto may_end = [&] { return work > work_before_roulette; };
  const auto is_given_up = [&] {
    // exp(−x) ≥ 1 − x tells nearly always.
    return may_end() && left.max_lane() * (1 - fewest * integral) <= least_left &&
           most_left() <= least_left;
  };
  GridCrossing::Piece piece;
  while (crossing.next(piece)) {
    if (least_left < 0) {
      const Vec2f u = numbers.next_2d();
      least_left = least_sure * (1 - u.x);  // above 0
      to_look = exponential(u.y);
    }
    const float length = piece.end - piece.begin;
    const float unknown = most * (piece.largest - piece.least);
    if (is_followed(piece, unknown * length)) {
      integral += crossing.integral(piece);
      work += piece.cells;
    } else {
      integral += piece.least * length;
      float at = piece.begin;
      while (to_look < unknown * (piece.end - at)) {
        at = std::min(at + to_look / unknown, piece.end);
        const float above = crossing.value(piece, at) - piece.least;
        left *= left_by_look(extinction, above / unknown);
        work += cells_per_look;
        if (is_given_up()) return Spectrum();
        to_look = depths.next();
      }
      to_look -= unknown * (piece.end - at);
    }
    if (is_given_up()) return Spectrum();
  }
  const float chance = may_end() ? most_left() / least_sure : 1;
  left *= exp(extinction * -integral);
  return chance < 1 ? left * (1 / chance) : left;
}

TrackedFlight tracked_flight(GridCrossing crossing, const Spectrum& extinction, int lane,
                             float depth, Sampler numbers) {
  const float most = extinction.max_lane(), chosen = extinction[lane];
  TrackedFlight flight;
  float integral = 0;
  const auto collided = [&](float place) {
    flight.collided = true;
    flight.distance = crossing.distance(place);
    flight.left *= exp(extinction * -integral);
    return flight;
  };
  GridCrossing::Piece piece;
  while (crossing.next(piece)) {
    const float densest = most * piece.largest;
    if (is_followed(piece, densest * (piece.end - piece.begin))) {
      const float target = chosen > 0 ? depth / chosen : infinity;
      const GridVolume::Reach reach = crossing.reach(piece, target);
      integral += reach.is_reached ? target : reach.integral;
      if (reach.is_reached) return collided(reach.distance);
      depth = std::max(0.0f, depth - chosen * reach.integral);
      continue;
    }
    float at = piece.begin;
    while (depth < densest * (piece.end - at)) {
      at = std::min(at + depth / densest, piece.end);
      const Vec2f u = numbers.next_2d();
      const float threshold = u.x * densest;
      if (threshold < chosen * piece.least) return collided(at);
      const float value = crossing.value(piece, at);
      if (threshold < chosen * value) return collided(at);
      flight.left *= left_by_look(extinction, value / densest);
      depth = exponential(u.y);
    }
    depth -= densest * (piece.end - at);
  }
  flight.left *= exp(extinction * -integral);
  return flight;
}

}  // namespace kaustik
