#include "kaustik/vcm/lessons/scatter_learning.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/gap_split.h"
#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// Balls that there are at most; one is divided while it holds so many vertices.
constexpr size_t most_balls = 64;
constexpr size_t most_in_ball = 16;
/// A cell is divided while it has more events. What is known of all cells counts in each as so many
/// events.
constexpr size_t most_events_in_cell = 128;
constexpr double events_of_all = 32;
/// Nothing is learned from fewer.
constexpr size_t least_events = 64;
/// Share of the paths of a cell that is never guided: it bounds what paths that nothing is known of
/// may weigh, from event to event.
constexpr double least_unguided = 0.7;
/// Shares below this are not worth looking at.
constexpr double least_guide_share = 0.002;
/// A guide is worth a trial where the mean logarithm of the density of what is of use rises by so
/// much.
constexpr double least_gain = 0.15;
/// Of the iteration that finds the shares.
constexpr int steps = 8;

}  // namespace

void ScatterLearning::add(const LightScattering& event, double use, double events) {
  Event added;
  added.position = event.position;
  added.next = event.next;
  added.direction = normalize(event.next - event.position);
  added.unguided = event.pdf_unguided;
  added.weight = events * use;
  added.side = ScatterGuide::side_of(event.normal);
  added.half = int(event.number * 0x9e3779b1u >> 31);
  if (added.weight > 0 && added.unguided > 0 && std::isfinite(added.weight))
    events_.push_back(added);
}

/// Divides the events among cells, and learns each. Worth nothing if it was stopped.
class ScatterLearning::Builder {
 public:
  Builder(std::vector<Event> events, const std::stop_token& stop)
      : events_(std::move(events)), stop_(stop) {
    make_balls();
    // In the given order, so that sums are the same on every machine.
    std::stable_sort(events_.begin(), events_.end(),
                     [](const Event& a, const Event& b) { return a.side < b.side; });
    parts_.nodes.resize(ScatterGuide::side_count);
    size_t begin = 0;
    for (int side = 0; side < ScatterGuide::side_count; ++side) {
      size_t end = begin;
      while (end < events_.size() && events_[end].side == side) ++end;
      divide(uint32_t(side), begin, end);
      begin = end;
    }
    learn();
  }

  /// Mean of log(p / unguided p), by use, of events by what those of other paths taught.
  double mean_gain() const { return mean_gain_; }
  ScatterGuide::Parts take_parts() { return std::move(parts_); }

 private:
  /// Shares of the balls, and at the end of what is not guided; they sum to 1.
  using Shares = std::vector<double>;
  struct Range {
    size_t begin, end;
    int half = both;  ///< of the events, Event::half
  };
  static constexpr int both = -1;
  bool is_in(const Range& range, const Event& event) const {
    return range.half == both || range.half == event.half;
  }
  /// The events of a cell.
  struct Leaf {
    size_t begin, end;
    Shares shares;
    double gain = 0;
  };

  auto at(size_t i) { return events_.begin() + std::ptrdiff_t(i); }
  template <typename Place>
  Bounds3f bounds_of(size_t begin, size_t end, const Place& place) const {
    Bounds3f bounds;
    for (size_t i = begin; i < end; ++i) bounds.extendBy(place(events_[i]));
    return bounds;
  }
  /// Puts about half of the events, those on one side along the longest axis of their places,
  /// first; where the other half begins, `begin` if they can't be told apart.
  struct Halves {
    int axis;
    float split;
    size_t middle;
  };
  template <typename Place>
  Halves halve(size_t begin, size_t end, const Place& place) {
    const Bounds3f bounds = bounds_of(begin, end, place);
    const int axis = int(bounds.majorAxis());
    std::vector<float> places;
    for (size_t i = begin; i < end; ++i) places.push_back(place(events_[i])[axis]);
    const auto gap = split_in_gap(std::move(places), least_relative_gap * bounds.size()[axis]);
    if (!gap) return {axis, 0, begin};
    const float split = *gap;
    const auto second = std::stable_partition(
        at(begin), at(end), [&](const Event& event) { return place(event)[axis] < split; });
    return {axis, split, size_t(second - events_.begin())};
  }

  /// Around vertices that events went to, many or far apart; as many of both as can be told apart.
  void make_balls() {
    const auto next = [](const Event& event) { return event.next; };
    struct Group {
      size_t begin, end;
      Bounds3f box;
      double cost() const { return double(end - begin) * double(sqr(bounding_radius(box))); }
    };
    std::vector<Group> groups{{0, events_.size(), bounds_of(0, events_.size(), next)}};
    std::vector<Group> done;
    while (!groups.empty() && groups.size() + done.size() < most_balls) {
      const auto costliest =
          std::max_element(groups.begin(), groups.end(),
                           [](const Group& a, const Group& b) { return a.cost() < b.cost(); });
      const Group group = *costliest;
      groups.erase(costliest);
      const size_t middle = group.end - group.begin > most_in_ball
                                ? halve(group.begin, group.end, next).middle
                                : group.begin;
      if (middle == group.begin || middle == group.end) {
        done.push_back(group);
        continue;
      }
      groups.push_back({group.begin, middle, bounds_of(group.begin, middle, next)});
      groups.push_back({middle, group.end, bounds_of(middle, group.end, next)});
    }
    groups.insert(groups.end(), done.begin(), done.end());
    // Points have cones too, wide enough for floats.
    Bounds3f all = groups.front().box;
    for (const Group& group : groups) all.extendBy(group.box);
    for (const Event& event : events_) all.extendBy(event.position);
    const float least_radius = 1e-3f * bounding_radius(all);
    for (const Group& group : groups) {
      // The vertices to come lie a little farther out than those that there are.
      const float margin = 1 + 1 / float(group.end - group.begin);
      parts_.balls.push_back(
          {center(group.box), std::max(least_radius, margin * bounding_radius(group.box))});
    }
  }

  void divide(uint32_t node, size_t begin, size_t end) {
    const auto position = [](const Event& event) { return event.position; };
    if (end - begin > most_events_in_cell) {
      const Halves halves = halve(begin, end, position);
      if (halves.middle > begin && halves.middle < end) {
        const auto first = uint32_t(parts_.nodes.size());
        parts_.nodes.resize(parts_.nodes.size() + 2);
        parts_.nodes[node] = {halves.axis, halves.split, first};
        divide(first, begin, halves.middle);
        divide(first + 1, halves.middle, end);
        return;
      }
    }
    parts_.nodes[node] = {-1, 0, uint32_t(leaves_.size())};
    leaves_.push_back({begin, end, {}});
  }

  /// Densities of an event's direction by each ball, and without a guide.
  std::vector<float> densities(const Event& event) const {
    std::vector<float> result;
    for (const ScatterGuide::Ball& ball : parts_.balls)
      result.push_back(ScatterGuide::pdf(ball, event.position, event.direction));
    result.push_back(event.unguided);
    return result;
  }

  double density(size_t event, const Shares& shares) const {
    double sum = 0;
    const float* of_event = densities_.data() + event * shares.size();
    for (size_t k = 0; k < shares.size(); ++k) sum += shares[k] * double(of_event[k]);
    return sum;
  }

  /// The shares by which the events in `range` are likeliest, Σ w log p, from `shares` on: a step
  /// gives each what it has of the events (expectation maximisation).
  Shares fit(const Range& range, Shares shares) const {
    Shares parts(shares.size());
    for (int step = 0; step < steps && !stop_.stop_requested(); ++step) {
      std::fill(parts.begin(), parts.end(), 0.0);
      double sum = 0;
      for (size_t i = range.begin; i < range.end; ++i) {
        if (!is_in(range, events_[i])) continue;
        const double factor = events_[i].weight / density(i, shares);
        const float* of_event = densities_.data() + i * shares.size();
        for (size_t k = 0; k < shares.size(); ++k)
          parts[k] += factor * shares[k] * double(of_event[k]);
        sum += events_[i].weight;
      }
      if (!(sum > 0)) break;
      for (size_t k = 0; k < shares.size(); ++k) shares[k] = parts[k] / sum;
      keep_unguided(shares);
    }
    return shares;
  }
  static void keep_unguided(Shares& shares) {
    const double unguided = shares.back();
    if (unguided >= least_unguided) return;
    for (double& share : shares) share *= (1 - least_unguided) / (1 - unguided);
    shares.back() = least_unguided;
  }
  /// Leaning on what is known of all.
  Shares fit_cell(const Range& range, const Shares& of_all) const {
    Shares shares = fit(range, of_all);
    double events = 0;
    for (size_t i = range.begin; i < range.end; ++i) events += is_in(range, events_[i]) ? 1 : 0;
    for (size_t k = 0; k < shares.size(); ++k)
      shares[k] = (events * shares[k] + events_of_all * of_all[k]) / (events + events_of_all);
    return shares;
  }
  /// Σ w log(p / unguided p).
  double gain(const Range& range, const Shares& shares) const {
    double sum = 0;
    for (size_t i = range.begin; i < range.end; ++i)
      if (is_in(range, events_[i]))
        sum += events_[i].weight * std::log(density(i, shares) / double(events_[i].unguided));
    return sum;
  }

  void learn() {
    const size_t kinds = parts_.balls.size() + 1;
    densities_.resize(events_.size() * kinds);
    parallel_blocks(events_.size(), 256, [&](size_t begin, size_t end, size_t) {
      for (size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
        const std::vector<float> of_event = densities(events_[i]);
        std::copy(of_event.begin(), of_event.end(), densities_.begin() + std::ptrdiff_t(i * kinds));
      }
    });
    Shares even(kinds, 1 / double(kinds));
    keep_unguided(even);  // a half may have no events
    const Shares of_all[] = {fit({0, events_.size(), 0}, even), fit({0, events_.size(), 1}, even)};
    Shares mean(kinds);
    for (size_t k = 0; k < kinds; ++k) mean[k] = 0.5 * (of_all[0][k] + of_all[1][k]);
    Shares plain(kinds, 0.0);
    plain.back() = 1;
    if (stop_.stop_requested()) return;
    parallel_blocks(leaves_.size(), 1, [&](size_t begin, size_t end, size_t) {
      for (size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
        Leaf& leaf = leaves_[i];
        // Each half of the events tells how well the other has learned.
        for (int half = 0; half < 2; ++half)
          leaf.gain += gain({leaf.begin, leaf.end, 1 - half},
                            fit_cell({leaf.begin, leaf.end, half}, of_all[half]));
        if (leaf.begin == leaf.end)
          leaf.shares = mean;
        else
          leaf.shares = leaf.gain > 0 ? fit_cell({leaf.begin, leaf.end}, mean) : plain;
      }
    });
    if (stop_.stop_requested()) return;
    double weight = 0;
    for (const Event& event : events_) weight += event.weight;
    for (const Leaf& leaf : leaves_) {
      mean_gain_ += leaf.gain / weight;
      add_cell(leaf.shares);
    }
  }

  void add_cell(const Shares& shares) {
    ScatterGuide::Cell cell;
    cell.begin = uint32_t(parts_.shares.size());
    double guided = 0;
    for (size_t k = 0; k < parts_.balls.size(); ++k) {
      if (shares[k] < least_guide_share) continue;
      parts_.shares.push_back({uint32_t(k), float(shares[k])});
      guided += double(float(shares[k]));
    }
    cell.guided = float(guided);
    cell.end = uint32_t(parts_.shares.size());
    parts_.cells.push_back(cell);
  }

  std::vector<Event> events_;
  const std::stop_token& stop_;
  ScatterGuide::Parts parts_;
  std::vector<Leaf> leaves_;
  std::vector<float> densities_;  ///< event by event
  double mean_gain_ = 0;
};

std::shared_ptr<const ScatterGuide> ScatterLearning::learned(const std::stop_token& stop) const {
  if (events_.size() < least_events || stop.stop_requested()) return nullptr;
  Builder builder(events_, stop);
  if (stop.stop_requested() || builder.mean_gain() < least_gain) return nullptr;
  return std::make_shared<const ScatterGuide>(builder.take_parts());
}

namespace {

struct StoredEvent {
  float position[3], next[3], direction[3];
  float unguided = 0;
  double weight = 0;
  int32_t side = 0, half = 0;
};

Vec3f vector_of(const float (&stored)[3]) { return {stored[0], stored[1], stored[2]}; }

}  // namespace

void ScatterLearning::write(ByteWriter& writer) const {
  std::vector<StoredEvent> stored;
  stored.reserve(events_.size());
  for (const Event& event : events_)
    stored.push_back({.position = {event.position.x, event.position.y, event.position.z},
                      .next = {event.next.x, event.next.y, event.next.z},
                      .direction = {event.direction.x, event.direction.y, event.direction.z},
                      .unguided = event.unguided,
                      .weight = event.weight,
                      .side = event.side,
                      .half = event.half});
  writer.put_array(stored);
}

void ScatterLearning::read(ByteReader& reader) {
  events_.clear();
  for (const StoredEvent& stored : reader.get_array<StoredEvent>()) {
    if (stored.side < 0 || stored.side >= ScatterGuide::side_count)
      reader.damaged("a surface in it faces nowhere");
    events_.push_back({.position = vector_of(stored.position),
                       .next = vector_of(stored.next),
                       .direction = vector_of(stored.direction),
                       .unguided = stored.unguided,
                       .weight = stored.weight,
                       .side = stored.side,
                       .half = stored.half});
  }
}

}  // namespace kaustik
