#include "kaustik/medium/grid_tracking.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/fast_math.h"

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

/// 1 − u is a float without rounding.
float exponential(float u) { return -approximate_log(1 - u); }

/// Of a value at a place.
struct Look {
  float place;
  const float* sample;
  const GridCrossing::Piece* piece;
  float u;  ///< uniform in [0, 1)
  /// Independent of u; its mean is the value at the place.
  float value() const { return std::clamp(*sample, piece->least, piece->largest); }
};

/// Looks that are distributed over a piece of a line with a rate of `rate`, 1/m. Each is prepared
/// while the one before is used, for what it reads takes its time.
class Looks {
 public:
  /// `depth`: rate times the way to the next look; at the end, to the next look beyond the piece.
  Looks(const GridCrossing& crossing, const GridCrossing::Piece& piece, float rate, float& depth,
        Sampler& numbers)
      : crossing_(crossing),
        piece_(piece),
        rate_(rate),
        depth_(depth),
        numbers_(numbers),
        place_(piece.begin) {
    prepare();
  }
  bool next(Look& look) {
    if (!is_prepared_) return false;
    look = prepared_;
    prepare();
    return true;
  }

 private:
  void prepare() {
    const float left = rate_ * (piece_.end - place_);
    is_prepared_ = depth_ < left;
    if (!is_prepared_) {
      depth_ -= left;
      return;
    }
    place_ = std::min(place_ + depth_ / rate_, piece_.end);
    Vec2f u = numbers_.next_independent_2d();
    depth_ = exponential(u.y);
    prepared_.place = place_;
    prepared_.piece = &piece_;
    prepared_.sample = crossing_.sample(place_, u.x);
    prepared_.u = u.x;
  }

  const GridCrossing& crossing_;
  const GridCrossing::Piece& piece_;
  float rate_;
  float& depth_;
  Sampler& numbers_;
  float place_;
  Look prepared_{};
  bool is_prepared_ = false;
};

}  // namespace

Spectrum tracked_transmittance(GridCrossing crossing, const Spectrum& extinction, Sampler numbers) {
  const float most = extinction.max_lane();
  float fewest = most;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    fewest = std::min(fewest, extinction[lane]);
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
      Looks looks(crossing, piece, unknown, to_look, numbers);
      for (Look look; looks.next(look);) {
        left *= left_by_look(extinction, (look.value() - piece.least) / unknown);
        work += cells_per_look;
        if (is_given_up()) return Spectrum();
      }
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
    Looks looks(crossing, piece, densest, depth, numbers);
    for (Look look; looks.next(look);) {
      const float value = look.value();
      if (look.u < chosen * value / densest) return collided(look.place);
      flight.left *= left_by_look(extinction, value / densest);
    }
  }
  flight.left *= exp(extinction * -integral);
  return flight;
}

}  // namespace kaustik
